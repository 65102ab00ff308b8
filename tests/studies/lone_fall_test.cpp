// A grain falls alone as its drag law has it, where the correction for its own flow is on.
#include "studies/lone_fall.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "solver/coupling/drag_laws.hpp"
#include "tests/studies/study_fixture.hpp"

namespace bedload {
namespace {

Scene scene_with(const std::string& more) {
  auto text = with(good_study, "diameter = [\"0.5 mm\", \"0.6 mm\"]", "diameter = \"0.5 mm\"");
  text = with(text, "density = [\"2000 kg/m3\", \"3000 kg/m3\"]", "density = \"2000 kg/m3\"");
  return unfold(parse_study(text + more, "study.toml")).front().scene;
}

double lone_fall_speed(const Scene& scene) {
  const auto speeds = lone_fall_speeds(scene);
  return (speeds[0] + speeds[1] + speeds[2] + speeds[3]) / 4;
}

/// Between bottom, lid and its own images in a box of 10 x 6 x 13 d a grain falls some percent slower than in a wide liquid.
TEST(LoneFall, IsNearTheTerminalSpeedOfTheDragLaw) {
  const Scene scene = scene_with("");
  const double wide = terminal_speed(scene.drag, scene.bed.fluid.viscosity, 2, 5e-4, 9.81);
  const double speed = lone_fall_speed(scene);
  EXPECT_LT(speed, wide);
  EXPECT_GT(speed, 0.85 * wide);
}

/// What the mesh gives back to a grain of its own flow makes it fall faster, the more the finer the cells.
TEST(LoneFall, IsFasterWhereAGrainFeelsItsOwnFlow) {
  const std::string alone = "[models]\nterms = [\"drag\", \"buoyancy\"]\n";
  const double uncorrected = lone_fall_speed(scene_with(alone));
  EXPECT_GT(uncorrected, 1.05 * lone_fall_speed(scene_with("")));
}

TEST(LoneFall, IsNotKnownOfGrainsThatDoNotFall) {
  Scene scene = scene_with("");
  scene.bed.grains.density = 900;
  EXPECT_TRUE(std::isnan(lone_fall_speed(scene)));
}

}   // namespace
}   // namespace bedload

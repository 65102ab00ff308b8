// A grain near a plane wall: what the grid reflects and what the law brings
// make the wall's whole effect.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "solver/coupler.hpp"
#include "solver/coupling/drag_laws.hpp"
#include "solver/coupling/wall_effects.hpp"
#include "tests/support/scenes.hpp"

namespace bedload::test {
namespace {

constexpr double d = 1e-4, gravity = 9.81, s = 2.65;

/// Fall past a wall with Re 0.01 under Stokes' law: speed over that of a lone
/// grain times the factor of the wall, worst over the way from 3.3 d to 1.3 d
/// towards the bottom, or the mean over two diameters along it at 1.1 d.
struct Fall {
  double across, up;   // edges of the cells [d]
  int direction;       // 2 = towards the bottom, 0 = along it
  friend void PrintTo(const Fall& f, std::ostream* out) {
    *out << "cells " << f.across << " x " << f.up << " d, falls " << (f.direction == 2 ? "towards" : "along");
  }
};

double worst_speed_over_expected(const Fall& fall, bool wall_forces) {
  const int c = fall.direction;
  const double nu = std::sqrt((s - 1) * gravity * d * d * d / (18 * 0.01));
  const double terminal = terminal_speed(DragLawName::stokes, nu, s, d, gravity);
  Scene scene = fluid_scene({16, 16, static_cast<int>(24 / fall.up)}, {fall.across * d, fall.across * d, fall.up * d},
                            channel, nu);
  (c == 2 ? scene.bed.gravity.z : scene.bed.gravity.x) = -gravity;
  scene.drag = DragLawName::stokes;
  scene.terms.self_disturbance = true, scene.terms.wall_forces = wall_forces;
  add_grains(scene, d, s, terminal);
  const Vec3 box = scene.grid.length();
  State state = state_of(scene, {{0.43 * box.x, 0.47 * box.y, (c == 2 ? 3.8 : 1.1) * d}}, false);
  Coupler coupler(scene);
  double worst = 1, sum = 0, time = 0;
  while (state.grains.position[0].z > 1.3 * d || c == 0) {
    const StepHealth health = coupler.step(state, scene.steps.fluid_interval);
    EXPECT_TRUE(health.finite && !health.lost_grain);
    const double z = state.grains.position[0].z, k = 0.5 * d / z;
    const double ratio = -state.grains.velocity[0][c] / terminal * (c == 2 ? drag_towards_wall(k) : drag_along_wall(k));
    if (c == 2 && z < 3.3 * d && std::abs(ratio - 1) > std::abs(worst - 1)) worst = ratio;
    if (c == 0 && state.clock.time > 2 * d / terminal) sum += ratio * health.dt, time += health.dt;
    if (!health.finite || state.clock.time > (c == 0 ? 4 : 40) * d / terminal) break;
  }
  return c == 2 ? worst : sum / time;
}

class NearWall : public testing::TestWithParam<Fall> {};
INSTANTIATE_TEST_SUITE_P(Settling, NearWall,
                         testing::Values(Fall{2.5, 2.5, 2}, Fall{2.5, 2.5, 0}, Fall{2, 1, 2}, Fall{2, 1, 0}));

TEST_P(NearWall, AGrainFallsAsSlowlyAsTheWallMakesIt) {
  const double speed = worst_speed_over_expected(GetParam(), true);
  RecordProperty("speed_over_expected", std::to_string(speed));
  EXPECT_NEAR(speed, 1, GetParam().direction == 2 ? 0.03 : 0.05);
  const double grid_alone = worst_speed_over_expected(GetParam(), false);
  RecordProperty("without_wall_factors", std::to_string(grid_alone));
  EXPECT_GT(std::abs(grid_alone - 1), 2 * std::abs(speed - 1));
}

/// Force along the flow on a fixed grain that touches the bottom under a lid,
/// over 1.7005 x 6 pi mu a (gdot a) of O'Neill 1968; cells 2 d wide, `up` d
/// high.
double touching_drag_over_exact(double up) {
  const double nu = 1e-4, rate = 1e-3 * nu / (d * d);   // Re_g = 0.001
  Scene scene = fluid_scene({12, 12, static_cast<int>(12 / up)}, {2 * d, 2 * d, up * d}, channel, nu);
  scene.drag = DragLawName::stokes;
  scene.terms.self_disturbance = scene.terms.wall_forces = true;
  scene.bed.grains.diameter = d;
  scene.steps.fluid_interval = 4 * d * d / nu;
  const Vec3 box = scene.grid.length();
  State state = state_of(scene, {{0.43 * box.x, 0.47 * box.y, 0.5 * d}}, true);
  state.search.lid_speed = rate * box.z;
  for (int i = 0; i < scene.grid.cells[0]; ++i)
    for (int j = 0; j < scene.grid.cells[1]; ++j)
      for (int k = 0; k < scene.grid.cells[2]; ++k)
        state.fluid.velocity.x[scene.grid.index(i, j, k)] = rate * (k + 0.5) * scene.grid.h.z;
  Coupler coupler(scene);
  for (int step = 0; step < 40; ++step) coupler.step(state, scene.steps.fluid_interval);
  const double mu = 1000 * nu, a = 0.5 * d;
  return coupler.books().on_grains.x / (1.7005 * 6 * std::numbers::pi * mu * a * rate * a);
}

TEST(TouchingGrain, FeelsTheDragOfShearAlongAWall) {
  // Cells of half a diameter at the wall are the coarsest in which the flow
  // sampled at its centre is the shear's.
  EXPECT_NEAR(touching_drag_over_exact(0.5), 1, 0.06);
  EXPECT_NEAR(touching_drag_over_exact(0.25), 1, 0.03);
}

}   // namespace
}   // namespace bedload::test

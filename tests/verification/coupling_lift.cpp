// Lift in the coupled step: a grain at rest in shear is lifted, and the fluid
// takes the reaction.
#include <gtest/gtest.h>

#include <numbers>

#include "solver/coupler.hpp"
#include "solver/coupling/lateral_forces.hpp"
#include "tests/support/scenes.hpp"

namespace bedload::test {
namespace {

constexpr double d = 1e-4, nu = 1e-4;

/// A fixed grain at height z in the flow of a lid, cells 2 x 2 x 0.5 d; the
/// flow starts as it would be without the grain.
struct Couette {
  Couette(double z, double shear_reynolds, bool walls) : rate(shear_reynolds * nu / (d * d)) {
    scene = fluid_scene({12, 12, 24}, {2 * d, 2 * d, 0.5 * d}, channel, nu);
    scene.drag = DragLawName::schiller_naumann;
    scene.terms.self_disturbance = true, scene.terms.wall_forces = walls;
    scene.bed.grains.diameter = d;
    scene.steps.fluid_interval = 0.02 / rate;
    // In the middle of a cell along x and y: there a grid does not turn a drag
    // along x into a flow along z.
    state = state_of(scene, {{5.5 * scene.grid.h.x, 5.5 * scene.grid.h.y, z}}, true);
    state.search.lid_speed = rate * scene.grid.length().z;
    for (int i = 0; i < scene.grid.cells[0]; ++i)
      for (int j = 0; j < scene.grid.cells[1]; ++j)
        for (int k = 0; k < scene.grid.cells[2]; ++k)
          state.fluid.velocity.x[scene.grid.index(i, j, k)] = rate * (k + 0.5) * scene.grid.h.z;
  }
  /// What the term shear_lift adds to the force on the grain after so many
  /// steps [N].
  double lift_after(int steps) const {
    const auto force = [&](bool lift) {
      Scene one = scene;
      one.terms.shear_lift = lift;
      State flow = state;
      Coupler coupler(one);
      for (int step = 0; step < steps; ++step) coupler.step(flow, one.steps.fluid_interval);
      return coupler.books().on_grains.z;
    };
    return force(true) - force(false);
  }
  double rate;
  Scene scene;
  State state;
};

TEST(Lift, AFixedGrainInShearIsLiftedAsSaffmanAndMeiSay) {
  const double z = 6.2 * d;   // mid-channel
  const Couette couette(z, 0.5, false);
  const Vec3 slip{couette.rate * z, 0, 0};
  const double expected = 1000 * cross(slip, saffman_mei(slip, {0, couette.rate, 0}, d, nu)).z;
  EXPECT_NEAR(couette.lift_after(40) / expected, 1, 0.05);
}

TEST(Lift, ATouchingGrainIsLiftedTowardsLeightonAndAcrivos) {
  // What the grid shows of its own reflection from the wall, upwards too, is
  // known to a few hundredths only: a quarter of the lift is missing.
  const Couette couette(0.5 * d, 0.05, true);
  const double a = 0.5 * d, expected = 9.22 * 1000 * std::pow(couette.rate * a * a, 2);
  EXPECT_NEAR(couette.lift_after(40) / expected, 1, 0.35);
}

}   // namespace
}   // namespace bedload::test

// A settled bed of free grains in still fluid stays at rest: the little motion it begins with dies away.
#include <gtest/gtest.h>

#include "solver/coupler.hpp"
#include "solver/coupling/drag_laws.hpp"
#include "solver/fluid/face_loops.hpp"
#include "solver/grains/bed_packing.hpp"
#include "tests/support/scenes.hpp"

namespace bedload::test {
namespace {

double fastest_flow(const Scene& scene, const State& state) {
  double fastest = 0;
  for (int c = 0; c < 3; ++c)
    for_each_unknown_face(scene.grid, c, [&, u = state.fluid.velocity.component(c)](std::size_t n) {
      fastest = std::max(fastest, std::abs(u[n]));
    });
  return fastest;
}

struct BedCase {
  double d, nu;   // [m], [m2/s]
  bool added_mass = false;
  Smoothing smoothing = {};
  friend void PrintTo(const BedCase& c, std::ostream* out) {
    *out << "d " << c.d << ", nu " << c.nu << (c.added_mass ? ", added mass" : "") << ", smoothing " << c.smoothing.xy;
  }
};
class FreeBed : public testing::TestWithParam<BedCase> {};
// With added mass a grain in water carries more liquid than its flat cells hold.
INSTANTIATE_TEST_SUITE_P(Sand, FreeBed,
                         testing::Values(BedCase{5e-4, 1e-5}, BedCase{5e-4, 1e-5, false, {.xy = 5e-4, .z = 4e-4}},
                                         BedCase{5e-4, 1e-5, true}, BedCase{1e-3, 1e-6, true}));

TEST_P(FreeBed, ComesToRestInStillFluid) {
  const auto [d, nu, added_mass, smoothing] = GetParam();
  const double s = 2.65;
  Scene scene = fluid_scene({4, 4, 20}, {2 * d, 2 * d, 0.5 * d}, channel, nu);
  scene.bed.gravity = {0, 0, -9.81};
  scene.smoothing = smoothing;
  scene.terms.added_mass = added_mass;
  const double terminal = terminal_speed(DragLawName::di_felice, nu, s, d, 9.81);
  add_grains(scene, d, s, terminal);
  scene.bed.grains.spread = 0.05;
  scene.bed.source = {BedSource::Kind::poured, 250, {}, 1};
  State state = state_of(scene, {}, false);
  state.grains = place_grains(scene.bed);
  BedPacking packing(scene.bed);
  bool settled = false;
  for (int i = 0; i < 5000 && !settled; ++i) settled = packing.advance(state.grains, state.contacts).settled;
  ASSERT_TRUE(settled);
  renumber_in_space(scene.bed, state.grains, state.contacts);

  Coupler coupler(scene);
  double early = 0, late = 0;
  constexpr int steps = 3000;   // only drag slows a grain that rolls on the floor
  for (int i = 0; i < steps; ++i) {
    ASSERT_TRUE(coupler.step(state, scene.steps.fluid_interval).finite);
    if (i < 250) early = std::max(early, fastest_flow(scene, state));
    if (i >= steps - 10) late = std::max(late, fastest_flow(scene, state));
  }
  EXPECT_LT(late, 1e-4 * terminal);
  EXPECT_LT(late, early);
}

TEST(FreeBed, StaysAtRestWhereDragHoldsItsGrainsFastAndContactsAreDamped) {
  // Grains that lose all in a collision, in a syrup: dashpots and drag both far stronger than inertia, and steps of less
  // than a DEM step each. The close lattice has contacts on all sides.
  const double d = 5e-4, s = 2, nu = 1e-2;
  Scene scene = fluid_scene({4, 4, 12}, {2 * d, 2 * d, 0.5 * d}, channel, nu);
  scene.bed.gravity = {0, 0, -9.81};
  add_grains(scene, d, s, 0.02);
  scene.bed.grains.restitution = 0;
  State state = state_of(scene, cubic_places({8, 8, 4}, {}, {8 * d, 8 * d, 3.97 * d}, 0.005 * d, 4), false);
  Coupler coupler(scene);
  double fastest = 0;
  for (int i = 0; i < 300; ++i) {
    const StepHealth health = coupler.step(state, scene.steps.fluid_interval);
    ASSERT_TRUE(health.finite && !health.lost_grain);
    ASSERT_LT(health.dt, 4 * scene.bed.dem_step);   // else this tests nothing
    if (i < 100) continue;
    for (const Vec3& v : state.grains.velocity) fastest = std::max(fastest, norm(v));
  }
  EXPECT_LT(fastest, 1e-3);
}

}   // namespace
}   // namespace bedload::test

// Grains that fall through fluid: one alone, a suspension, a column between bottom and top.
#include <gtest/gtest.h>

#include <cmath>

#include "solver/coupler.hpp"
#include "solver/coupling/drag_laws.hpp"
#include "tests/support/scenes.hpp"

namespace bedload {

void PrintTo(DragLawName law, std::ostream* out) { *out << name_of(law); }

}   // namespace bedload

namespace bedload::test {
namespace {

constexpr double gravity = 9.81;

/// Viscosity at which a lone grain settles with Reynolds number re [m2/s].
double viscosity_for(double re, double density_ratio, double diameter) {
  double low = 1e-12, high = 1e2;
  for (int i = 0; i < 200; ++i) {
    const double nu = std::sqrt(low * high);
    (terminal_speed(DragLawName::di_felice, nu, density_ratio, diameter, gravity) * diameter / nu > re ? low : high) =
        nu;
  }
  return low;
}

class LoneGrain : public testing::TestWithParam<DragLawName> {};
INSTANTIATE_TEST_SUITE_P(Settling, LoneGrain,
                         testing::Values(DragLawName::stokes, DragLawName::schiller_naumann, DragLawName::di_felice));

TEST_P(LoneGrain, FallsAtTheLawsOwnSpeedThroughFluidThatItHardlyStirs) {
  // Cells of 4000 d: the flow that the grain sets in motion and samples again is 3 pi 0.07 d/h = 0.02 % of its speed.
  const double d = 1e-4, h = 4000 * d, nu = 1e-6;
  Scene scene = fluid_scene({4, 4, 4}, {h, h, h}, closed_box, nu);
  scene.bed.gravity = {0, 0, -gravity};
  scene.drag = GetParam();
  const double expected = terminal_speed(GetParam(), nu, 3, d, gravity);
  add_grains(scene, d, 3, expected);
  State state = state_of(scene, {{1.7 * h, 2.1 * h, 2.2 * h}}, false);
  Coupler coupler(scene);
  while (state.clock.time < 0.05) coupler.step(state, scene.steps.fluid_interval);   // 30 relaxation times
  EXPECT_NEAR(-state.grains.velocity[0].z / expected, 1, 1e-3);
}

const Terms model_b{true, true, false, false};

struct SuspensionCase {
  double re, density_ratio;
  Terms terms{};
  friend void PrintTo(const SuspensionCase& c, std::ostream* out) {
    *out << "Re " << c.re << ", density ratio " << c.density_ratio << ", Model " << (c.terms.model_b() ? "B" : "A");
  }
};
class Suspension : public testing::TestWithParam<SuspensionCase> {};
INSTANTIATE_TEST_SUITE_P(Settling, Suspension,
                         testing::Values(SuspensionCase{0.01, 1.01}, SuspensionCase{0.01, 2.65},
                                         SuspensionCase{0.1, 1.01}, SuspensionCase{0.1, 2.65}, SuspensionCase{10, 1.01},
                                         SuspensionCase{10, 2.65}, SuspensionCase{0.1, 1.05, model_b},
                                         SuspensionCase{10, 2.65, model_b}));

TEST_P(Suspension, IsHinderedAsItsOwnLawSays) {
  // phi 0.3, no net volume flux: drag balances eps W', so U = eps U_Stokes/F(phi, U d/nu) for the superficial slip U = |v|.
  const auto [re, s, terms] = GetParam();
  const double d = 1e-3, phi = 0.3, nu = viscosity_for(re, s, d);
  const double terminal = terminal_speed(DragLawName::di_felice, nu, s, d, gravity);
  const double stokes = (s - 1) * gravity * d * d / (18 * nu);
  double low = 0, high = stokes;
  for (int i = 0; i < 100; ++i) {
    const double u = 0.5 * (low + high);
    (DiFelice{}.multiplier(1 - phi, u * d / nu) * u < (1 - phi) * stokes ? low : high) = u;
  }
  const double expected = low;

  const double h = std::cbrt(1000 * sphere_volume(d) / phi) / 6;   // 1000 grains make phi exactly 0.3; h = 2.007 d
  Scene scene = fluid_scene({6, 6, 6}, {h, h, h}, periodic_box, nu);
  scene.bed.gravity = {0, 0, -gravity};
  scene.terms = terms;
  add_grains(scene, d, s, terminal);
  State state = state_of(scene, cubic_places({10, 10, 10}, {}, scene.grid.length(), 0.08 * d, 21), false);
  Coupler coupler(scene);
  const double end = 2 * d / expected, relaxation = s * d * d / (18 * nu);
  double distance = 0, time = 0;
  while (state.clock.time < end + 20 * relaxation) {
    const StepHealth health = coupler.step(state, scene.steps.fluid_interval);
    ASSERT_TRUE(health.finite);
    if (state.clock.time < 0.5 * end + 20 * relaxation) continue;
    double mean = 0;
    for (const Vec3& v : state.grains.velocity) mean -= v.z;
    distance += mean / static_cast<double>(state.grains.size()) * health.dt, time += health.dt;
  }
  RecordProperty("speed_over_law", std::to_string(distance / time / expected));
  EXPECT_NEAR(distance / time / expected, 1, 0.02) << "U/U_t " << distance / time / terminal;
}

struct ColumnCase {
  double density_ratio;
  Terms terms{};
  friend void PrintTo(const ColumnCase& c, std::ostream* out) {
    *out << "density ratio " << c.density_ratio << ", Model " << (c.terms.model_b() ? "B" : "A");
  }
};
class Column : public testing::TestWithParam<ColumnCase> {};
INSTANTIATE_TEST_SUITE_P(Settling, Column,
                         testing::Values(ColumnCase{1.05}, ColumnCase{1.5}, ColumnCase{1.05, model_b},
                                         ColumnCase{2.65, model_b}));

TEST_P(Column, StaysBoundedBetweenBottomAndTop) {
  const auto [s, terms] = GetParam();
  const double d = 1e-3, nu = viscosity_for(1, s, d);
  const double terminal = terminal_speed(DragLawName::di_felice, nu, s, d, gravity);
  Scene scene = fluid_scene({4, 4, 10}, {2 * d, 2 * d, 2 * d}, closed_box, nu);
  scene.bed.gravity = {0, 0, -gravity};
  scene.terms = terms;
  add_grains(scene, d, s, terminal);
  State state = state_of(scene, cubic_places({6, 6, 14}, {}, scene.grid.length(), 0.1 * d, 22), false);
  Coupler coupler(scene);
  double fastest[2] = {};   // of grains and flow, in the first and in the second half of the run
  for (int i = 0; i < 1500; ++i) {
    const StepHealth health = coupler.step(state, scene.steps.fluid_interval);
    ASSERT_TRUE(health.finite && !health.lost_grain && health.converged);
    double& most = fastest[i >= 750];
    for (const Vec3& v : state.grains.velocity) most = std::max(most, norm(v));
    for (int c = 0; c < 3; ++c)
      for (std::size_t n = 0; n < scene.grid.padded_size(); ++n)
        most = std::max(most, std::abs(state.fluid.velocity.component(c)[n]));
  }
  EXPECT_LT(fastest[0], 2 * terminal);       // a lone grain's speed is the scale: nothing here may outrun it by far
  EXPECT_LE(fastest[1], 1.1 * fastest[0]);   // and nothing grows
}

}   // namespace
}   // namespace bedload::test

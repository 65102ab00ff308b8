// Energy of fluid and grains: nothing but what drives them may raise it.
#include <gtest/gtest.h>

#include "solver/coupler.hpp"
#include "solver/coupling/drag_laws.hpp"
#include "tests/support/scenes.hpp"

namespace bedload::test {
namespace {

Terms model_b() {
  Terms terms;
  terms.pressure_gradient = terms.viscous_stress = false;
  return terms;
}
Terms with_everything_implicit() {
  Terms terms;
  terms.added_mass = terms.viscous_torque = true;
  return terms;
}

struct EnergyCase {
  double density_ratio, viscosity;
  Terms terms{};
  friend void PrintTo(const EnergyCase& c, std::ostream* out) {
    *out << "density ratio " << c.density_ratio << ", viscosity " << c.viscosity << ", Model "
         << (c.terms.model_b() ? "B" : "A") << (c.terms.added_mass ? ", added mass, torque" : "");
  }
};
class Driven : public testing::TestWithParam<EnergyCase> {};
INSTANTIATE_TEST_SUITE_P(Energy, Driven,
                         testing::Values(EnergyCase{1.05, 1e-5}, EnergyCase{2.65, 1e-5},
                                         EnergyCase{2.65, 1e-5, model_b()},
                                         EnergyCase{1.01, 1e-5, with_everything_implicit()},
                                         EnergyCase{2.65, 1e-5, with_everything_implicit()},
                                         EnergyCase{2.65, 1e-3, with_everything_implicit()}));

TEST_P(Driven, SuspensionGainsNoMoreThanItsDriveGives) {
  // Grains that do not touch settle under a gradient, with and without a lid: kinetic energy against the work of what drives.
  const double d = 1e-3;
  Scene scene = fluid_scene({4, 4, 6}, {2 * d, 2 * d, 2 * d}, channel, GetParam().viscosity);
  scene.bed.gravity = {0.5, 0, -9.81};
  scene.terms = GetParam().terms;
  add_grains(scene, d, GetParam().density_ratio, 0.05);
  for (const double lid_speed : {0.0, 0.02}) {
    State state = state_of(scene, cubic_places({5, 5, 4}, {}, {8 * d, 8 * d, 12 * d}, 0.1 * d, 3), false);
    state.search.lid_speed = lid_speed, state.search.gradient = 0.3;
    Coupler coupler(scene);
    double work = 0, lost = 0;
    for (int i = 0; i < 100; ++i) {
      const StepHealth health = coupler.step(state, 0.2 * scene.steps.fluid_interval);
      ASSERT_TRUE(health.finite && !health.lost_grain);
      ASSERT_EQ(health.deepest_overlap, 0);
      EXPECT_GE(coupler.books().exchange_loss, 0);
      work += coupler.books().driving_power * health.dt;
      lost += coupler.books().exchange_loss * health.dt;
      const double energy = kinetic_energy(scene, state);
      EXPECT_LT(energy, work + 0.01 * lost) << i;
      if (lid_speed == 0) {
        EXPECT_GT(energy + lost, 0.3 * work) << i;   // viscosity takes the rest
      }
    }
    if (lid_speed == 0) RecordProperty("booked", std::to_string((kinetic_energy(scene, state) + lost) / work));
  }
}

}   // namespace
}   // namespace bedload::test

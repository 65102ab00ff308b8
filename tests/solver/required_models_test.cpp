// Which models a scene requires, against the numbers of scenes that were worked out by hand.
#include "solver/required_models.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace bedload {
namespace {

/// 20 000 grains of 1 mm and 3000 kg/m3 in water, a gap of about 10 mm below a lid.
Scene erosion_in_water() {
  Scene scene;
  scene.bed.fluid = {1000, 1e-6};
  scene.bed.grains = {
      .diameter = 1e-3, .density = 3000, .friction = 0.4, .restitution = 0.6, .poisson = 0.3, .young_modulus = 1.2e7};
  scene.bed.source = {.kind = BedSource::Kind::poured, .count = 20000};
  scene.bed.length = {0.06, 0.03, 0.02};
  scene.bed.sides = {Side::periodic, Side::periodic, Side::wall};
  scene.bed.gravity = {0, 0, -9.81};
  scene.bed.dem_step = 1e-5;
  scene.grid = {.cells = {12, 6, 4}, .h = {5e-3, 5e-3, 5e-3}, .sides = scene.bed.sides};
  scene.drive = {
      .kind = FlowRamp::Kind::lid, .quantity = FlowRamp::Quantity::shields, .levels = {0.03, 0.06, 0.12}, .dwell = 0.2};
  scene.steps.fluid_interval = 1e-4;
  scene.record.every = 0.01;
  return scene;
}

ModelChoice choice(const Scene& scene, const std::string& term) {
  const auto models = required_models(scene);
  const auto found = std::ranges::find(models, term, &ModelChoice::term);
  return found == models.end() ? ModelChoice{} : *found;
}

// theta = 0.2: tau_b = 3.924 Pa, u*^2 = 3.924e-3 m2/s2, Re* = 62.6; 3924 1/s over 10 mm is a lid at 39 m/s, Re 3.9e5.
TEST(RequiredModels, QuoteTheFlowAtTheShieldsNumberOfOnset) {
  const auto n = numbers_of(erosion_in_water());
  EXPECT_NEAR(n.friction_reynolds, 62.64, 0.01);
  EXPECT_NEAR(n.shear_reynolds, 3924, 1);
  EXPECT_NEAR(n.gap, 0.010, 1e-4);
  EXPECT_NEAR(n.flow_speed / n.gap, 3924, 1);
  EXPECT_NEAR(n.gap_reynolds, 3.9e5, 0.05e5);
  EXPECT_NEAR(n.lowest_shields, 0.03, 1e-12);
}

TEST(RequiredModels, CallALaminarSceneInWaterUnphysical) {
  EXPECT_TRUE(choice(erosion_in_water(), "turbulence").wanted);
  const auto warnings = warnings_of(erosion_in_water());
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("not physical"), std::string::npos);
}

TEST(RequiredModels, AcceptALaminarSceneInAViscousLiquid) {
  auto scene = erosion_in_water();
  scene.bed.fluid.viscosity = 1e-4;
  EXPECT_FALSE(choice(scene, "turbulence").wanted);
  EXPECT_TRUE(warnings_of(scene).empty());
}

TEST(RequiredModels, DoNotDependOnTheEndOfTheRamp) {
  auto longer = erosion_in_water();
  longer.drive.levels.push_back(2.4);
  const auto a = required_models(erosion_in_water()), b = required_models(longer);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t n = 0; n < a.size(); ++n) EXPECT_EQ(a[n].ratio, b[n].ratio) << a[n].term;
}

TEST(RequiredModels, ReportATermThatIsLeftOutButDoNotAddIt) {
  auto scene = erosion_in_water();
  scene.bed.fluid.viscosity = 1e-4;
  scene.terms.pressure_gradient = scene.terms.viscous_stress = false;
  const auto left_out = choice(scene, "pressure_gradient");
  EXPECT_TRUE(left_out.wanted);
  EXPECT_FALSE(left_out.on);
  EXPECT_EQ(warnings_of(scene).size(), 2u);
}

TEST(RequiredModels, WantThePressureGradientOnlyForLightGrains) {
  auto scene = erosion_in_water();
  scene.bed.grains.density = 6000;
  EXPECT_FALSE(choice(scene, "pressure_gradient").wanted);
}

// C_A/(s + C_A) with C_A = 1/2: 16 % of the inertia of quartz, 33 % of a grain that barely sinks.
TEST(RequiredModels, GiveTheShareOfTheAddedMass) {
  auto scene = erosion_in_water();
  scene.bed.grains.density = 2650;
  EXPECT_NEAR(choice(scene, "added_mass").ratio, 0.16, 0.005);
  scene.bed.grains.density = 1010;
  EXPECT_NEAR(choice(scene, "added_mass").ratio, 0.33, 0.005);
}

// Exposed grain in laminar shear: torque per weight and radius 6 theta.
TEST(RequiredModels, WantTheViscousTorqueInEveryLaminarOnset) {
  auto scene = erosion_in_water();
  scene.bed.fluid.viscosity = 1e-4;
  EXPECT_NEAR(choice(scene, "viscous_torque").ratio, 1.2, 1e-12);
  EXPECT_TRUE(choice(scene, "viscous_torque").wanted);
  EXPECT_FALSE(choice(scene, "viscous_torque").on);
}

TEST(RequiredModels, SayNothingOfShearWhereNothingDrivesTheFluid) {
  auto scene = erosion_in_water();
  scene.drive = {.levels = {0}, .dwell = 1};
  EXPECT_TRUE(std::isnan(numbers_of(scene).shields));
  EXPECT_EQ(choice(scene, "viscous_torque").term, "");
}

}   // namespace
}   // namespace bedload

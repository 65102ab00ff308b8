// Shields number -> lid speed or gradient -> Shields number; the steady increment solves the steady balance.
#include "solver/bed/flow_ramp.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "solver/scene.hpp"

namespace bedload {
namespace {

Scene scene_with(FlowRamp::Kind kind, FlowRamp::Quantity quantity, std::vector<double> levels, Top top = Top::lid) {
  Scene scene;
  scene.bed.fluid = {1000, 1e-5};
  scene.bed.grains.diameter = 0.5e-3;
  scene.bed.grains.density = 2000;
  scene.bed.length = {10e-3, 6e-3, 6.5e-3};
  scene.bed.gravity = {0, 0, -9.81};
  scene.bed.sides = {Side::periodic, Side::periodic, Side::wall};
  scene.bed.top = top;
  scene.drive = {kind, quantity, std::move(levels), 1};
  return scene;
}

constexpr double bed_height = 3e-3;

TEST(ImposedFlow, UnderALidGivesTheStressOfTheShieldsNumber) {
  const Scene scene = scene_with(FlowRamp::Kind::lid, FlowRamp::Quantity::shields, {0.06, 0.2});
  const ImposedFlow flow = imposed_flow(scene, 1, bed_height);
  const double stress = 1000 * 1e-5 * flow.lid_speed / 3.5e-3;
  EXPECT_NEAR(stress / ((2000 - 1000) * 9.81 * 0.5e-3), 0.2, 1e-12);
  EXPECT_DOUBLE_EQ(flow.shields, 0.2);
  EXPECT_EQ(flow.gradient, 0);
}

TEST(ImposedFlow, ReturnsToItsShieldsNumberThroughEveryQuantity) {
  for (const Top top : {Top::lid, Top::free_slip}) {
    const ImposedFlow lid =
        imposed_flow(scene_with(FlowRamp::Kind::lid, FlowRamp::Quantity::shields, {0.17}, top), 0, bed_height);
    const Scene by_speed = scene_with(FlowRamp::Kind::lid, FlowRamp::Quantity::lid_speed, {lid.lid_speed}, top);
    EXPECT_NEAR(imposed_flow(by_speed, 0, bed_height).shields, 0.17, 1e-14);

    const Scene pressure = scene_with(FlowRamp::Kind::pressure, FlowRamp::Quantity::shields, {0.17}, top);
    const double gradient = imposed_flow(pressure, 0, bed_height).gradient;
    const Scene by_gradient =
        scene_with(FlowRamp::Kind::pressure, FlowRamp::Quantity::gradient, {1000 * gradient}, top);
    EXPECT_NEAR(imposed_flow(by_gradient, 0, bed_height).shields, 0.17, 1e-14);
  }
}

TEST(ImposedFlow, OfAPressureDriveNeedsTwiceTheGradientUnderALidAtRest) {
  const auto gradient = [](Top top) {
    return imposed_flow(scene_with(FlowRamp::Kind::pressure, FlowRamp::Quantity::shields, {0.1}, top), 0, bed_height)
        .gradient;
  };
  EXPECT_DOUBLE_EQ(gradient(Top::lid), 2 * gradient(Top::free_slip));
}

TEST(ImposedFlow, RefusesABedThatFillsItsBox) {
  const Scene scene = scene_with(FlowRamp::Kind::lid, FlowRamp::Quantity::shields, {0.1});
  EXPECT_THROW(imposed_flow(scene, 0, 6.5e-3), Error);
}

TEST(SteadyIncrement, CarriesTheStressOfItsShieldsNumberIntoTheBed) {
  // nu rho_f du/dz at z_b is tau_b, whatever drives.
  const double tau_b = 0.1 * 1000 * 9.81 * 0.5e-3, dz = 1e-9;
  for (const Top top : {Top::lid, Top::free_slip})
    for (const auto kind : {FlowRamp::Kind::lid, FlowRamp::Kind::pressure}) {
      if (kind == FlowRamp::Kind::lid && top == Top::free_slip) continue;
      const Scene scene = scene_with(kind, FlowRamp::Quantity::shields, {0.1}, top);
      const ImposedFlow flow = imposed_flow(scene, 0, bed_height);
      const double slope = steady_increment(scene, flow, bed_height, bed_height + dz) / dz;
      EXPECT_NEAR(1000 * 1e-5 * slope, tau_b, 1e-6 * tau_b);
    }
}

TEST(SteadyIncrement, MeetsTheLidAndLeavesTheBedAlone) {
  const Scene moving = scene_with(FlowRamp::Kind::lid, FlowRamp::Quantity::shields, {0.1});
  const ImposedFlow flow = imposed_flow(moving, 0, bed_height);
  EXPECT_NEAR(steady_increment(moving, flow, bed_height, 6.5e-3), flow.lid_speed, 1e-12 * flow.lid_speed);
  EXPECT_EQ(steady_increment(moving, flow, bed_height, 2.9e-3), 0);

  const Scene pressed = scene_with(FlowRamp::Kind::pressure, FlowRamp::Quantity::shields, {0.1});
  EXPECT_EQ(steady_increment(pressed, imposed_flow(pressed, 0, bed_height), bed_height, 6.5e-3), 0);
}

}   // namespace
}   // namespace bedload

#include "solver/bed/turbulent_flow.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "solver/experiment.hpp"
#include "solver/fluid/wall_law.hpp"
#include "tests/support/scenes.hpp"

namespace bedload {
namespace {

using namespace test;

constexpr double depth = 0.05, viscosity = 1e-6;

Scene driven(FlowRamp::Kind kind, FlowRamp::Quantity quantity, double level) {
  Scene scene = fluid_scene({3, 3, 20}, {depth, depth, depth / 20}, channel, viscosity);
  scene.terms.turbulence = true;
  scene.bed.gravity = {0, 0, -9.81};
  if (kind == FlowRamp::Kind::pressure) scene.grid.top = scene.bed.top = Top::free_slip;
  scene.drive = {kind, quantity, {level}, 10.0};
  scene.record.every = 1;
  scene.steps.fluid_interval = 0.05;
  scene.bed.dem_step = 1e-3;
  scene.onset.method = Onset::Method::none;
  return scene;
}

TEST(WallLaw, HasASpeedForEveryStress) {
  for (double roughness : {0.0, 1e-4, 1e-3})
    for (double friction_speed : {1e-4, 1e-3, 1e-2, 1.0}) {
      const double speed = wall_speed(friction_speed, 1e-3, viscosity, roughness);
      EXPECT_NEAR(wall_stress(speed, 1e-3, viscosity, roughness) / (friction_speed * friction_speed), 1, 1e-12);
    }
}

TEST(TurbulentFlow, UnderALidIsFoundFromStressAndFromSpeed) {
  for (double shields : {0.01, 0.2, 2.0}) {
    const Scene by_stress = driven(FlowRamp::Kind::lid, FlowRamp::Quantity::shields, shields);
    const ImposedFlow flow = imposed_flow(by_stress, 0, 0);
    const Scene by_speed = driven(FlowRamp::Kind::lid, FlowRamp::Quantity::lid_speed, flow.lid_speed);
    EXPECT_NEAR(imposed_flow(by_speed, 0, 0).shields, shields, 1e-9 * shields);
  }
}

/// What a hold sets at once is the flow that the coupled step keeps: the bottom bears the Shields number asked for.
TEST(TurbulentFlow, IsTheSteadyFlowOfTheCoupledStep) {
  for (auto kind : {FlowRamp::Kind::lid, FlowRamp::Kind::pressure}) {
    const Scene scene = driven(kind, FlowRamp::Quantity::shields, 0.2);
    Experiment experiment(scene);
    State state = experiment.begin();
    experiment.step(state);
    const double top = state.fluid.velocity.x[scene.grid.index(0, 0, 19)];
    while (!Experiment::finished(state)) experiment.step(state);
    EXPECT_NEAR(state.fluid.velocity.x[scene.grid.index(0, 0, 19)], top, 0.01 * top);
    EXPECT_NEAR(state.record.holds.shields_measured.back(), 0.2, 0.01 * 0.2);
  }
}

}   // namespace
}   // namespace bedload

// The length of a coupled step, what decides it, and steps that fail.
#include "solver/coupler.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "tests/support/scenes.hpp"

namespace bedload::test {
namespace {

constexpr double d = 1e-3;

/// One grain of density ratio 2.65 in a box of 8 d, still fluid of the given viscosity, no weight.
struct LoneGrain {
  explicit LoneGrain(double viscosity, std::array<Side, 3> sides = periodic_box)
      : scene(fluid_scene({4, 4, 4}, {2 * d, 2 * d, 2 * d}, sides, viscosity)) {
    add_grains(scene, d, 2.65, 0.1);
    state = state_of(scene, {{4 * d, 4 * d, 4 * d}}, false);
  }
  StepHealth step() { return Coupler(scene).step(state, scene.steps.fluid_interval); }

  Scene scene;
  State state;
};

TEST(FluidStep, IsTenDemStepsWhereNothingLimitsIt) {
  LoneGrain grain(1e-6);
  const StepHealth health = grain.step();
  EXPECT_EQ(health.substeps, 10);
  EXPECT_EQ(health.limited_by, StepLimit::asked);
  EXPECT_DOUBLE_EQ(health.dt, 10 * grain.scene.bed.dem_step);
}

TEST(FluidStep, KeepsTheCourantNumberOfTheFluidAtOneHalf) {
  LoneGrain grain(1e-6);
  const double speed = 2 * d / grain.scene.steps.fluid_interval;   // one cell per interval
  std::fill(grain.state.fluid.velocity.x.values.begin(), grain.state.fluid.velocity.x.values.end(), speed);
  grain.state.grains.velocity[0] = {speed, 0, 0};
  grain.scene.drag = DragLawName::stokes;
  const StepHealth health = grain.step();
  EXPECT_LE(health.cfl, 0.5);
  EXPECT_LT(health.substeps, 10);
}

TEST(FluidStep, LetsAGrainTravelAFifthOfACell) {
  LoneGrain grain(1e-9);   // hardly any drag: neither collisions nor relaxation bind
  grain.state.grains.velocity[0] = {0.5 * 2 * d / grain.scene.steps.fluid_interval, 0, 0};
  const StepHealth health = grain.step();
  EXPECT_EQ(health.limited_by, StepLimit::travel);
  EXPECT_LE(health.grain_travel, 0.2 * (1 + 1e-9));
}

TEST(FluidStep, ResolvesCollisionsOnlyWhereDragIsNotWeak) {
  LoneGrain stiff(1e-4), weak(1e-7);
  for (LoneGrain* grain : {&stiff, &weak}) {
    grain->scene.steps.fluid_interval = 100 * grain->scene.bed.dem_step;
    grain->state.grains.velocity[0] = {1e-3, 0, 0};
  }
  EXPECT_EQ(stiff.step().limited_by, StepLimit::contact);
  EXPECT_EQ(weak.step().substeps, 100);
}

TEST(FluidStep, IsATenthOfTheGrainTimeUnderWeight) {
  LoneGrain grain(1e-7);
  grain.scene.bed.gravity = {0, 0, -9.81};
  grain.scene.steps.fluid_interval = 1;
  const StepHealth health = grain.step();
  EXPECT_EQ(health.limited_by, StepLimit::weight);
  EXPECT_LE(health.dt, 0.1 * std::sqrt(d / (1.65 * 9.81)));
}

TEST(FluidStep, ShortensTheDemStepBelowOne) {
  LoneGrain grain(1e-9);
  grain.state.grains.velocity[0] = {2 * d / grain.scene.bed.dem_step, 0, 0};   // one cell per DEM step
  const StepHealth health = grain.step();
  EXPECT_EQ(health.substeps, 1);
  EXPECT_NEAR(health.dt, 0.2 * grain.scene.bed.dem_step, 1e-9 * grain.scene.bed.dem_step);
}

TEST(FluidStep, OfFluidAloneKnowsNothingOfGrainsThatWereThereBefore) {
  LoneGrain with(1e-6, channel);
  with.state.search.lid_speed = 0.05;
  const double longest = with.scene.steps.fluid_interval;
  const auto without_grains = [&scene = with.scene](State state) {
    state.grains = {}, state.contacts = {};
    state.fluid.velocity.x[scene.grid.index(2, 2, 2)] += 0.01;   // beside where the grain was: work for the pressure
    return state;
  };
  Coupler used(with.scene);
  for (int again = 0; again < 2; ++again) {   // the grain comes, and is gone
    for (int n = 0; n < 3; ++n) used.step(with.state, longest);
    State alone = without_grains(with.state), fresh = alone;
    Coupler never_used(with.scene);
    for (int n = 0; n < 3; ++n) {
      const StepHealth health = used.step(alone, longest);
      if (n == 0) {
        EXPECT_GT(health.pressure_iterations, 0);
      }
      never_used.step(fresh, longest);
      EXPECT_EQ(state_digest(alone), state_digest(fresh)) << again << " " << n;
      EXPECT_EQ(used.drag_on_grains().size(), 0u);
    }
  }
}

TEST(FluidStep, OfViscousFluidAloneDecaysByBackwardEuler) {
  // A wave of shear is an eigenvector of the Laplacian on the grid, of eigenvalue -(2 - 2 cos(2 pi/n))/h^2.
  constexpr int n = 8;
  constexpr double h = 2 * d, amplitude = 1e-3;
  Scene scene = fluid_scene({4, 4, n}, {h, h, h}, periodic_box, 1e-6);
  const double viscosity = scene.bed.fluid.viscosity = 0.5 * h * h / scene.steps.fluid_interval;
  State state = state_of(scene, {}, false);
  const auto wave = [](int k) { return std::sin(2 * std::numbers::pi * k / n); };
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      for (int k = 0; k < n; ++k) state.fluid.velocity.x[scene.grid.index(i, j, k)] = amplitude * wave(k);
  const double eigenvalue = (2 - 2 * std::cos(2 * std::numbers::pi / n)) / (h * h);
  double left = amplitude;
  Coupler coupler(scene);
  for (int step = 0; step < 4; ++step) {
    const StepHealth health = coupler.step(state, scene.steps.fluid_interval);
    ASSERT_GT(viscosity * health.dt, h * h / 12);   // viscous stress is implicit
    left /= 1 + viscosity * health.dt * eigenvalue;
    for (int k = 0; k < n; ++k)
      EXPECT_NEAR(state.fluid.velocity.x[scene.grid.index(1, 2, k)], left * wave(k), 1e-12 * amplitude)
          << step << " " << k;
  }
}

TEST(FluidStep, OfFluidAloneSaysWhatDivergenceItStartsWith) {
  Scene scene = fluid_scene({4, 4, 4}, {2 * d, 2 * d, 2 * d}, channel, 1e-6);
  State state = state_of(scene, {}, false);
  state.fluid.velocity.x[scene.grid.index(2, 1, 1)] = 1e-3;
  Coupler coupler(scene);
  const StepHealth first = coupler.step(state, scene.steps.fluid_interval);
  EXPECT_DOUBLE_EQ(first.divergence_left, 1e-3 / (2 * d) * first.dt);
  EXPECT_LT(coupler.step(state, scene.steps.fluid_interval).divergence_left, 1e-6 * first.divergence_left);
}

TEST(FluidStep, OfFluidAloneLetsThroughWhatIsAskedFor) {
  Scene scene = fluid_scene({4, 4, 4}, {2 * d, 2 * d, 2 * d}, periodic_box, 1e-6);
  scene.drive.kind = FlowRamp::Kind::through_flow;
  State state = state_of(scene, {}, false);
  Coupler coupler(scene);
  for (const double asked : {0.01, 0.03, 0.02}) {
    state.search.through_flow = asked;
    coupler.step(state, scene.steps.fluid_interval);
    EXPECT_NEAR(state.fluid.velocity.z[scene.grid.index(1, 2, 3)], asked, 1e-14);
  }
}

TEST(FluidStep, OfTurbulentFluidAloneLosesTheMomentumThatItsWallsTake) {
  Scene scene = fluid_scene({4, 4, 8}, {2 * d, 2 * d, 2 * d}, channel, 1e-6);
  scene.terms.turbulence = true;
  State state = state_of(scene, {}, false);
  state.search.lid_speed = 0.5;
  Coupler coupler(scene);
  for (int n = 0; n < 3; ++n) {
    const Vec3 before = fluid_momentum(scene, state);
    const StepHealth health = coupler.step(state, scene.steps.fluid_interval);
    const Vec3 on_walls = coupler.books().on_bottom + coupler.books().on_lid;
    const Vec3 laminar = -scene.bed.fluid.density * scene.bed.fluid.viscosity * 0.5 / d * Vec3{8 * d * 8 * d, 0, 0};
    if (n == 0) {
      EXPECT_LT(on_walls.x, 1.1 * laminar.x);   // on the lid, by the law of the wall
    }
    EXPECT_NEAR((fluid_momentum(scene, state) - before).x, -health.dt * on_walls.x, 1e-12 * health.dt * norm(on_walls));
  }
}

TEST(FluidStep, OfViscousFluidAloneLosesTheMomentumThatItsWallsTake) {
  Scene scene = fluid_scene({4, 4, 8}, {2 * d, 2 * d, 2 * d}, channel, 1e-6);
  scene.bed.fluid.viscosity = 0.5 * 4 * d * d / scene.steps.fluid_interval;
  State state = state_of(scene, {}, false);
  state.search.lid_speed = 0.01;
  Coupler coupler(scene);
  for (int n = 0; n < 3; ++n) {
    const Vec3 before = fluid_momentum(scene, state);
    const StepHealth health = coupler.step(state, scene.steps.fluid_interval);
    ASSERT_GT(scene.bed.fluid.viscosity * health.dt, 4 * d * d / 12);   // viscous stress is implicit
    const Vec3 on_walls = coupler.books().on_bottom + coupler.books().on_lid;
    EXPECT_NEAR((fluid_momentum(scene, state) - before).x, -health.dt * on_walls.x, 1e-12 * health.dt * norm(on_walls));
  }
}

TEST(FluidStep, FailsWhenAGrainsCentrePassesAWall) {
  LoneGrain grain(1e-9, channel);
  grain.state.grains.position[0].z = 0.02 * d;
  grain.state.grains.velocity[0] = {0, 0, -100};
  grain.scene.bed.grains.young_modulus = 1;   // a wall too soft to stop it
  EXPECT_TRUE(grain.step().lost_grain);
}

TEST(FluidStep, FailsWhenAnyComponentIsNotANumber) {
  for (int c = 0; c < 3; ++c) {
    LoneGrain grain(1e-6);
    grain.state.fluid.velocity.component(c)[grain.scene.grid.index(0, 0, 0)] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(grain.step().finite) << c;
  }
  LoneGrain grain(1e-6);
  grain.state.grains.spin[0].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(grain.step().finite);
}

TEST(RestingGrain, FeelsNoDragSinceItsContactBearsItsWeight) {
  // A drag solve that did not know of the contact would take the grain for falling and hold it up by a/(1 + a) of its weight.
  LoneGrain grain(1e-5, channel);
  grain.scene.bed.gravity = {0, 0, -9.81};
  grain.state.grains.position[0].z = 0.5 * d;
  Coupler coupler(grain.scene);
  for (int n = 0; n < 300; ++n) ASSERT_TRUE(coupler.step(grain.state, grain.scene.steps.fluid_interval).finite);
  const double weight = 1650 * sphere_volume(d) * 9.81;
  EXPECT_NEAR(grain.state.grains.mean_contact_force[0].z, weight, 1e-3 * weight);
  EXPECT_NEAR(coupler.drag_on_grains()[0].z, 0, 1e-3 * weight);
}

}   // namespace
}   // namespace bedload::test

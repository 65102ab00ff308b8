// A step that goes badly is undone and taken again shorter, and leaves no trace but its length and its count.
#include <gtest/gtest.h>

#include "solver/experiment.hpp"
#include "solver/step_judgement.hpp"
#include "tests/support/scenes.hpp"

namespace bedload::test {
namespace {

constexpr double d = 1e-3;

/// A lone grain at rest in a thin liquid, pushed by `push` times its weight for `steps` fluid steps: no limit of the step
/// foresees how fast it will be at its end.
Scene pushed_grain(double push, int steps) {
  Scene scene = fluid_scene({4, 4, 8}, {2 * d, 2 * d, d}, channel, 1e-7);
  scene.bed.gravity = {0, 0, -9.81};
  add_grains(scene, d, 2.65, 0.1);
  scene.steps.fluid_interval = 2e-3;   // its way: push x 6.1 m/s2 x (2 ms)^2/2 = 1.2e-5 m x push, in cells of 2e-3 m
  scene.bed.source = {.kind = BedSource::Kind::file, .count = 1};
  scene.bed.source.csv = "x,y,z,diameter,density,fixed\n0.004,0.004,0.004,0.001,2650,0\n";
  scene.drive = {FlowRamp::Kind::push, FlowRamp::Quantity::push, {push}, steps * scene.steps.fluid_interval};
  scene.onset.method = Onset::Method::none;
  scene.record.every = 10 * scene.steps.fluid_interval;
  return scene;
}

TEST(StepJudgement, HasALimitForEveryMeasureThatCanEndARun) {
  EXPECT_EQ(ailment({}), "");
  EXPECT_NE(ailment({.finite = false}), "");
  EXPECT_NE(ailment({.settles = false}), "");
  EXPECT_NE(ailment({.lost_grain = true}), "");
  EXPECT_NE(ailment({.converged = false}), "");
  EXPECT_NE(ailment({.grain_travel = 0.6}), "");
  EXPECT_EQ(ailment({.grain_travel = 0.2}), "");
  EXPECT_NE(ailment({.deepest_overlap = 0.31}), "");
  EXPECT_NE(ailment({.cfl_after = 2.1}), "");
  EXPECT_NE(ailment({.divergence_left = 0.6}), "");
}

TEST(StepRetry, HalvesAStepUntilTheGrainStaysWithinHalfACell) {
  const Scene scene = pushed_grain(1000, 20);
  Experiment experiment(scene);
  State state = experiment.begin();
  const StepHealth health = experiment.step(state);
  EXPECT_EQ(ailment(health), "");
  EXPECT_GE(health.retries, 1);
  EXPECT_LE(health.grain_travel, 0.5);
  EXPECT_EQ(state.clock.retries, static_cast<std::uint64_t>(health.retries));
  EXPECT_DOUBLE_EQ(state.clock.longest_step, health.dt);   // no longer step for a while
  EXPECT_EQ(state.search.health.retries, health.retries);
  EXPECT_EQ(state.clock.step, 1u);
  EXPECT_DOUBLE_EQ(state.clock.time, health.dt);

  // The very step that a run takes which was asked for no more.
  Scene shorter = scene;
  shorter.steps.fluid_interval = health.dt;
  Experiment patient(shorter);
  State same = patient.begin();
  ASSERT_EQ(patient.step(same).retries, 0);
  EXPECT_EQ(same.grains, state.grains);
  EXPECT_TRUE(same.fluid == state.fluid);
}

TEST(StepRetry, LeavesTheStateAsItWasWhenNoRetryHelps) {
  Experiment experiment(pushed_grain(1e9, 20));
  State state = experiment.begin();
  const Grains grains = state.grains;
  const FluidState fluid = state.fluid;
  const StepHealth health = experiment.step(state);
  EXPECT_NE(ailment(health), "");
  EXPECT_EQ(health.retries, most_retries);
  EXPECT_EQ(state.grains, grains);
  EXPECT_TRUE(state.fluid == fluid);
  EXPECT_EQ(state.clock, Clock{});
  EXPECT_TRUE(state.record.samples.time.empty());
}

TEST(StepRetry, LeavesATouchingRollingWetPairInItsHoldAsItWas) {
  // A grain rolls off a fixed one, in a liquid that goes along with it: every memory of a contact is in use.
  Scene scene = pushed_grain(0.3, 1000);
  scene.steps.fluid_interval = 2e-4;
  scene.bed.fluid.viscosity = 1e-5;
  scene.bed.grains.rolling_friction = 0.05;
  scene.terms.wet_restitution = scene.terms.added_mass = scene.terms.viscous_torque = true;
  scene.bed.source.count = 2;
  scene.bed.source.csv =
      "x,y,z,diameter,density,fixed\n0.004,0.004,0.004,0.001,2650,1\n0.0043,0.0041,0.00495,0.001,2650,0\n";
  Experiment experiment(scene);
  State state = experiment.begin();
  const auto remembers = [&] {
    const ContactHistory& c = state.contacts;
    const auto alive = [](const std::vector<Vec3>& v) { return !v.empty() && norm(v.back()) > 0; };
    return c.size() == 1 && alive(c.spring) && alive(c.rolling) && !c.damping.empty() &&
           alive(state.grains.mean_contact_force) && alive(state.grains.mean_contact_torque);
  };
  for (int step = 0; step < 200 && !remembers(); ++step) ASSERT_EQ(ailment(experiment.step(state)), "");
  ASSERT_TRUE(remembers());
  ASSERT_NE(state.search.hold_begun, 0u);

  state.search.push = 1e9;
  const std::string before = state_digest(state);
  const StepHealth health = experiment.step(state);
  EXPECT_NE(ailment(health), "");
  EXPECT_EQ(health.retries, most_retries);
  EXPECT_EQ(state_digest(state), before);
}

TEST(StepRetry, GoesBackToTheStepAskedForByAndBy) {
  const Scene scene = pushed_grain(1000, 100);
  Experiment experiment(scene);
  State state = experiment.begin();
  const std::uint64_t halvings = static_cast<std::uint64_t>(experiment.step(state).retries);
  ASSERT_GE(halvings, 1u);
  double doublings = 0;
  for (double ceiling = state.clock.longest_step; ceiling < scene.steps.fluid_interval; ceiling *= 2) ++doublings;
  double steps = 1;
  for (; state.clock.longest_step > 0 && steps < 1000; ++steps) ASSERT_EQ(ailment(experiment.step(state)), "");
  EXPECT_EQ(state.clock.retries, halvings);
  EXPECT_NEAR(steps, doublings * double(steps_to_recover), doublings);
}

TEST(StepRetry, IsTheSameAfterARestartInTheMiddleOfIt) {
  const Scene scene = pushed_grain(1000, 3);
  Experiment straight(scene);
  State a = straight.begin();
  while (!Experiment::finished(a) && ailment(straight.step(a)).empty()) continue;
  State b = Experiment(scene).begin();
  while (!Experiment::finished(b)) {
    Experiment anew(scene);   // nothing is remembered but the state
    if (!ailment(anew.step(b)).empty()) break;
  }
  EXPECT_GT(a.clock.retries, 0u);
  EXPECT_EQ(state_digest(a), state_digest(b));
}

TEST(StepRetry, PutsTheHealthOfEveryHoldOnRecord) {
  Scene scene = pushed_grain(1000, 3);
  Experiment experiment(scene);
  State state = experiment.begin();
  double steps = 0, travel = 0;
  while (!Experiment::finished(state)) {
    const StepHealth health = experiment.step(state);
    ASSERT_EQ(ailment(health), "");
    ++steps;
    travel = std::max(travel, health.grain_travel);
  }
  const auto& measures = state.record.health.measures;
  ASSERT_EQ(measures.steps.size(), 1u);
  EXPECT_EQ(measures.steps[0], steps);
  EXPECT_EQ(measures.grain_travel[0], travel);
  EXPECT_EQ(measures.retries[0], static_cast<double>(state.clock.retries));
  EXPECT_GT(measures.retries[0], 0);
  EXPECT_LT(measures.shortest_step[0], measures.longest_step[0] + 1e-300);
}

}   // namespace
}   // namespace bedload::test

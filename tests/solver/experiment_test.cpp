// What a hold imposes is what it measures; what it records closes.
#include "solver/experiment.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>

#include "base/error.hpp"
#include "solver/bed/bed_surface.hpp"
#include "solver/bed/incipient_motion.hpp"
#include "solver/bed/onset_search.hpp"
#include "solver/step_judgement.hpp"
#include "tests/support/scenes.hpp"

namespace bedload {
namespace {

constexpr double d = 0.5e-3, nu = 1e-5;

/// 8 x 6 x 10 d, cells 2 x 2 x 0.5 d, soft grains of density ratio 2.
Scene bed_scene(std::uint64_t count, FlowRamp::Kind kind, std::vector<double> shields) {
  Scene scene = test::fluid_scene({4, 3, 20}, {2 * d, 2 * d, 0.5 * d}, test::channel, nu);
  scene.bed.gravity = {0, 0, -9.81};
  test::add_grains(scene, d, 2, 0.05);
  scene.bed.grains.friction = 0.4;
  scene.bed.grains.restitution = 0.6;
  scene.bed.source = {.kind = count ? BedSource::Kind::poured : BedSource::Kind::none, .count = count, .seed = 3};
  scene.drive = {kind, FlowRamp::Quantity::shields, std::move(shields), 60 * scene.steps.fluid_interval};
  scene.onset.method = Onset::Method::none;
  scene.record.every = 10 * scene.steps.fluid_interval;
  return scene;
}

State run(const Scene& scene) {
  Experiment experiment(scene);
  State state = experiment.begin();
  while (!Experiment::finished(state)) {
    EXPECT_TRUE(experiment.step(state).finite);
    if (::testing::Test::HasFailure()) break;
  }
  return state;
}

TEST(Experiment, FailsWhereGrainsAreTooSoftToMakeABed) {
  Scene scene = bed_scene(150, FlowRamp::Kind::lid, {0.1});
  scene.bed.grains.young_modulus = 50;   // a grain's own weight presses it in by a tenth of its diameter
  Experiment experiment(scene);
  State state = experiment.begin();
  std::string cause;
  for (int n = 0; n < 20'000 && cause.empty() && state.search.phase == Search::packing; ++n)
    cause = ailment(experiment.step(state));
  EXPECT_NE(cause.find("overlap"), std::string::npos) << cause;
}

TEST(Experiment, OverABareBottomMeasuresTheShieldsNumberItImposes) {
  const State state = run(bed_scene(0, FlowRamp::Kind::lid, {0.1, 0.25}));
  const auto& holds = state.record.holds;
  ASSERT_EQ(holds.hold.size(), 2u);
  EXPECT_NEAR(holds.shields_measured[0], 0.1, 1e-9);   // plane Couette flow is exact on the grid
  EXPECT_NEAR(holds.shields_measured[1], 0.25, 1e-9);
  EXPECT_LT(holds.momentum_residual[1], 1e-10);
  EXPECT_NEAR(holds.shields_lid[1], 0.25, 1e-9);
  EXPECT_LT(holds.stress_residual[1], 1e-8);
}

TEST(Experiment, SeesThatTheStressOfLidAndDriveHasNotReachedTheBedYet) {
  for (const auto kind : {FlowRamp::Kind::lid, FlowRamp::Kind::pressure}) {
    Scene scene = bed_scene(0, kind, {0.1});
    if (kind == FlowRamp::Kind::pressure) scene.bed.top = scene.grid.top = Top::free_slip;
    scene.developed = false;   // from rest; the bottom learns of it in H^2/nu = 2.5 s
    const auto holds = run(scene).record.holds;
    EXPECT_GT(holds.stress_residual.at(0), 0.1);
    EXPECT_GT(holds.shields_lid.at(0), 1.1 * holds.shields_measured.at(0));
    EXPECT_LT(holds.momentum_residual.at(0), 1e-10);   // which closes all the same
    if (kind == FlowRamp::Kind::pressure) {
      EXPECT_NEAR(holds.shields_lid.at(0), 0.1, 1e-12);
    }
  }
}

TEST(Experiment, ReadsTheFlowsFromPressureOffTheBottomWithinTheirGridError) {
  for (const Top top : {Top::lid, Top::free_slip}) {
    Scene scene = bed_scene(0, FlowRamp::Kind::pressure, {0.1});
    scene.bed.top = scene.grid.top = top;
    const State state = run(scene);
    EXPECT_NEAR(state.record.holds.shields_measured.at(0), 0.1,
                0.1 / 20);   // a parabola's wall slope, first cell of 20
    EXPECT_LT(state.record.holds.momentum_residual.at(0), 1e-10);
  }
}

TEST(Experiment, OverABedClosesItsMomentumAndFindsTheImposedShieldsNumber) {
  const State state = run(bed_scene(190, FlowRamp::Kind::lid, {0.05, 0.05, 0.05, 0.05}));
  const auto& holds = state.record.holds;
  for (const double residual : holds.momentum_residual) EXPECT_LT(residual, 1e-10);
  EXPECT_NEAR(holds.shields_measured.back(), 0.05,
              0.1 * 0.05);   // the flow inside the surface is still finding its place
  EXPECT_GT(holds.bed_height.back(), 3 * d);
  EXPECT_GT(holds.porosity.back(), 0.36);
  EXPECT_LT(holds.porosity.back(), 0.55);
}

TEST(Experiment, RecordsSamplesHoldsAndProfilesOnceEach) {
  Scene scene = bed_scene(60, FlowRamp::Kind::lid, {0.05, 0.1});
  scene.record.tracks = {0, 59};
  const State state = run(scene);
  const BedRecord& record = state.record;
  EXPECT_EQ(record.holds.hold, (std::vector<double>{0, 1}));
  EXPECT_NEAR(double(record.samples.time.size()), 12, 2);   // 2 dwells of 60 steps, every 10: steps may be cut
  EXPECT_EQ(record.tracks.time.size(), 2 * record.samples.time.size());
  EXPECT_EQ(record.profiles.hold.front(), -1);
  EXPECT_EQ(record.profiles.hold.back(), 1);
  EXPECT_EQ(record.profiles.z.size(), 3 * 40u);   // layers of d/4
  for (std::size_t n = 1; n < record.samples.time.size(); ++n)
    EXPECT_GT(record.samples.time[n], record.samples.time[n - 1]);
}

TEST(Experiment, HasNoMomentumResidualToShowWhereWallsOrFixedGrainsTakePart) {
  Scene scene = bed_scene(0, FlowRamp::Kind::lid, {0.1});
  scene.bed.sides[1] = scene.grid.sides[1] = Side::wall;
  const auto holds = run(scene).record.holds;
  EXPECT_EQ(holds.momentum_residual.at(0), -1);
  EXPECT_EQ(holds.stress_residual.at(0), -1);
}

TEST(Experiment, WithoutADriveIsOneHoldOfOneDwell) {
  const Scene scene = bed_scene(0, FlowRamp::Kind::none, {});
  const State state = run(scene);
  EXPECT_EQ(state.record.holds.hold.size(), 1u);
  EXPECT_GE(state.clock.time, scene.drive.dwell);
  EXPECT_EQ(planned_time(scene), scene.drive.dwell);
}

TEST(Experiment, OnASharedBedIsTheExperimentThatPacksItsOwn) {
  const Scene scene = bed_scene(60, FlowRamp::Kind::lid, {0.1});
  Scene bed_only = scene;
  bed_only.bed_only = true;
  const State settled = run(bed_only);
  EXPECT_TRUE(settled.record.holds.hold.empty());

  Experiment experiment(scene);
  State state = experiment.begin_on(settled);
  EXPECT_EQ(state.clock.step, settled.clock.step);   // the number of the checkpoint never goes back
  while (!Experiment::finished(state)) experiment.step(state);
  EXPECT_EQ(state_digest(state), state_digest(run(scene)));
}

TEST(Experiment, GoesOnWhenItsRampGrows) {
  const Scene shorter = bed_scene(60, FlowRamp::Kind::lid, {0.05}),
              longer = bed_scene(60, FlowRamp::Kind::lid, {0.05, 0.1});
  State state = run(shorter);
  EXPECT_FALSE(Experiment(shorter).reopen(state));
  Experiment experiment(longer);
  ASSERT_TRUE(experiment.reopen(state));
  while (!Experiment::finished(state)) experiment.step(state);
  EXPECT_EQ(state_digest(state), state_digest(run(longer)));
}

/// A bed of one search, two holds of which branch from the settled bed.
struct SearchOfABed {
  Scene scene = bed_scene(60, FlowRamp::Kind::lid, {0.02, 0.2, 2});
  State settled;
  SearchOfABed() {
    scene.onset = {.method = Onset::Method::bisect, .value = 1e-2, .bracket = 0.5, .hold = scene.drive.dwell};
    Scene bed_only = scene;
    bed_only.bed_only = true;
    settled = run(bed_only);
  }
};

TEST(Experiment, BranchesEveryOnsetHoldFromTheSettledBed) {
  const SearchOfABed bed;
  Experiment experiment(bed.scene);
  State state = experiment.begin_on(bed.settled);
  int branches = 0;
  while (!Experiment::finished(state)) {
    const bool begins = state.search.hold_begun == 0;
    experiment.step(state);
    if (!begins || state.search.purpose != std::uint64_t(HoldPurpose::onset)) continue;
    if (state.search.duration > bed.scene.onset.hold) continue;   // goes on
    ++branches;
    Scene alone = bed.scene;   // the same level, and nothing before it
    alone.drive.levels = {state.search.level};
    alone.onset.method = Onset::Method::none;
    Experiment fresh(alone);
    State expected = fresh.begin_on(bed.settled);
    fresh.step(expected);
    EXPECT_EQ(state.grains, expected.grains) << state.search.hold;
    EXPECT_EQ(state.contacts, expected.contacts);
    EXPECT_EQ(state.fluid, expected.fluid);
  }
  EXPECT_GE(branches, 2);
}

TEST(Experiment, TakesASearchUpAgainOnlyWithTheBedThatItBranchesFrom) {
  const SearchOfABed bed;
  Experiment straight(bed.scene);
  State whole = straight.begin_on(bed.settled);
  while (!Experiment::finished(whole)) straight.step(whole);

  Experiment first(bed.scene);
  State state = first.begin_on(bed.settled);
  while (state.search.purpose != std::uint64_t(HoldPurpose::onset)) first.step(state);
  Experiment second(bed.scene);
  second.branch_from(bed.settled);
  State resumed = state;
  while (!Experiment::finished(resumed)) second.step(resumed);
  EXPECT_EQ(state_digest(resumed), state_digest(whole));

  Experiment without(bed.scene);
  EXPECT_THROW(while (!Experiment::finished(state)) without.step(state), Error);
}

/// The same bed, sheared for a while before its search.
struct SearchOfAShearedBed : SearchOfABed {
  SearchOfAShearedBed() { scene.shear = {.shields = 1.5, .time = 60 * scene.steps.fluid_interval}; }
};

bool is_shear(const State& state) { return state.search.purpose == std::uint64_t(HoldPurpose::shear); }

TEST(Experiment, ShearsASettledBedAndLetsItComeToRestBeforeTheHoldsBegin) {
  const SearchOfAShearedBed bed;
  Experiment experiment(bed.scene);
  State state = experiment.begin_on(bed.settled);
  EXPECT_EQ(state.clock.time, -bed.scene.shear.time);
  int shearing = 0, resting = 0;
  while (is_shear(state)) {
    const bool packing = state.search.phase == Search::packing;
    ++(packing ? resting : shearing);
    if (packing) {
      EXPECT_EQ(state.search.lid_speed, 0);
      EXPECT_EQ(state.fluid, Experiment(bed.scene).begin().fluid);
    }
    experiment.step(state);
    if (!packing && state.search.phase == Search::holding) {
      EXPECT_NEAR(state.search.shields, 1.5, 1e-12);
      EXPECT_LE(state.clock.time, bed.scene.steps.fluid_interval);
    }
  }
  EXPECT_GE(shearing, 60);
  EXPECT_GE(resting, 1);

  // At rest, elsewhere than it was poured, and with nothing in the record but what the shear did to it.
  EXPECT_EQ(state.search.phase, Search::holding);
  EXPECT_EQ(state.clock.time, 0);
  double energy = 0;
  for (const Vec3 v : state.grains.velocity) energy += norm2(v) / 2 / (0.5 * 9.81 * d);   // per W' d, s = 2
  EXPECT_LT(energy / double(state.grains.size()), 2e-6);
  EXPECT_NE(state.grains.position, bed.settled.grains.position);
  EXPECT_TRUE(state.record.holds.hold.empty());
  EXPECT_TRUE(state.record.samples.time.empty());
  EXPECT_TRUE(std::ranges::all_of(state.record.profiles.hold, [](double hold) { return hold == -1; }));
  const auto& settled = state.record.settled;
  EXPECT_GT(settled.shear_flux, 0);   // theta = 1.5 moves a bed
  EXPECT_DOUBLE_EQ(settled.solid_fraction, 1 - bed_surface(state.grains, bed.scene.bed.length, d).porosity);
  EXPECT_DOUBLE_EQ(settled.coordination, coordination(state.contacts, state.grains.fixed));

  // And every hold that branches begins with this bed.
  const State rested = state;
  int branches = 0;
  while (!Experiment::finished(state)) {
    const bool begins = state.search.hold_begun == 0;
    experiment.step(state);
    if (!begins || state.search.purpose != std::uint64_t(HoldPurpose::onset)) continue;
    if (state.search.duration > bed.scene.onset.hold) continue;   // goes on
    ++branches;
    Scene alone = bed.scene;
    alone.drive.levels = {state.search.level};
    alone.onset.method = Onset::Method::none;
    alone.shear = {};
    Experiment fresh(alone);
    State expected = fresh.begin_on(rested);
    fresh.step(expected);
    EXPECT_EQ(state.grains, expected.grains) << state.search.hold;
  }
  EXPECT_GE(branches, 2);
  EXPECT_EQ(state.record.settled, settled);
}

TEST(Experiment, WithoutAShearRemembersThePouredBedThatItsHoldsBeginWith) {
  const Scene scene = bed_scene(60, FlowRamp::Kind::lid, {0.1});
  Scene bed_only = scene;
  bed_only.bed_only = true;
  const State poured = run(bed_only), state = run(scene);
  EXPECT_EQ(state.record.settled.shear_flux, 0);
  EXPECT_DOUBLE_EQ(state.record.settled.coordination, coordination(poured.contacts, poured.grains.fixed));
  EXPECT_GT(state.record.settled.solid_fraction, 0.3);
}

TEST(Experiment, TakesASearchOfAShearedBedUpAgainWhereverItStood) {
  const SearchOfAShearedBed bed;
  Experiment straight(bed.scene);
  State whole = straight.begin_on(bed.settled), branched;
  std::map<std::string, State> stops;   // the last of each kind
  while (!Experiment::finished(whole)) {
    const bool shear = is_shear(whole), packing = whole.search.phase == Search::packing;
    stops[packing ? "coming to rest" : shear ? "in the shear" : "in the search"] = whole;
    straight.step(whole);
    if (shear && !is_shear(whole)) branched = whole;
    if (whole.record.holds.hold.size() >= 3) break;
  }
  while (!Experiment::finished(whole)) straight.step(whole);
  ASSERT_EQ(stops.size(), 3u);
  for (auto& [where, state] : stops) {
    Experiment anew(bed.scene);
    if (!is_shear(state)) anew.branch_from(branched);
    while (!Experiment::finished(state)) anew.step(state);
    EXPECT_EQ(state_digest(state), state_digest(whole)) << where;
  }
}

TEST(Experiment, JudgesTheHoldsOfASearchAndEndsWithABracket) {
  const SearchOfABed bed;
  Experiment experiment(bed.scene);
  State state = experiment.begin_on(bed.settled);
  while (!Experiment::finished(state)) experiment.step(state);
  const auto& holds = state.record.holds;
  double moved = 10, rested = 0;
  for (std::size_t k = 0; k < holds.hold.size(); ++k) {
    EXPECT_NE(holds.verdict[k], double(HoldVerdict::none));
    EXPECT_NEAR(holds.shields_nominal[k], holds.level[k], 1e-12);
    if (holds.purpose[k] != double(HoldPurpose::onset)) continue;
    if (holds.verdict[k] == double(HoldVerdict::mobile)) moved = std::min(moved, holds.level[k]);
    if (holds.verdict[k] == double(HoldVerdict::arrested)) rested = std::max(rested, holds.level[k]);
  }
  EXPECT_GT(rested, 0);
  EXPECT_LT(rested, moved);
  EXPECT_LT(moved, 10);
}

}   // namespace
}   // namespace bedload

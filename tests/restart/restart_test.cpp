// Same scene, same bits: however often a run forgets, stops, is loaded again or is compiled anew.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <ranges>
#include <set>

#include "checkpoint/checkpoint.hpp"
#include "solver/bed/onset_search.hpp"
#include "tests/restart/digests_of_a_run.hpp"
#include "tests/restart/tiny_scenes.hpp"

namespace bedload::test {
namespace {

using Digests = std::vector<std::string>;

/// Where a run stands before a step, in words that a failure can be found by.
std::string place(const State& state) {
  const Search& search = state.search;
  const bool shear = search.purpose == std::uint64_t(HoldPurpose::shear);
  if (search.phase == Search::packing) return shear ? "coming to rest" : "packing";
  if (shear) return search.hold_begun ? "in the shear" : "before the shear";
  return (search.hold_begun ? "in hold " : "before hold ") + std::to_string(search.hold);
}

struct Restart : testing::TestWithParam<TinyScene> {
  const Scene& scene() const { return GetParam().scene; }

  /// The straight run, made once for all tests of a scene.
  const Digests& straight() const {
    static std::map<std::string, Digests> runs;
    Digests& run = runs[GetParam().name];
    if (run.empty()) run = digests_of_a_run(scene());
    return run;
  }
  void expect_straight(const Digests& run) const {
    const auto [expected, actual] = std::ranges::mismatch(straight(), run);
    EXPECT_TRUE(expected == straight().end() && actual == run.end())
        << "differs first after step " << actual - run.begin() << " of " << straight().size() << ", run has "
        << run.size();
  }
};

/// What a new process has of a run: the bytes of its checkpoint.
void reload(const Scene& scene, State& state, std::unique_ptr<Experiment>& experiment) {
  state = state_from_image(checkpoint_image(state), "checkpoint");
  experiment = std::make_unique<Experiment>(scene);
}

TEST_P(Restart, AStraightRunIsTheSameTwice) { expect_straight(digests_of_a_run(scene())); }

TEST_P(Restart, ARunThatForgetsItsScratchBeforeEveryStepEqualsTheStraightRun) {
  expect_straight(digests_of_a_run(scene(), [](State&, auto& experiment) { experiment->forget(); }));
}

TEST_P(Restart, ARunResumedFromACheckpointBeforeEveryStepEqualsTheStraightRun) {
  expect_straight(
      digests_of_a_run(scene(), [&](State& state, auto& experiment) { reload(scene(), state, experiment); }));
}

/// One interruption only, so that scratch which lives on for many steps has its chance to be wrong.
TEST_P(Restart, ARunResumedOnceEqualsTheStraightRun) {
  std::map<std::string, std::uint64_t> seen;   // steps before each place of a run: the first, one in the middle
  digests_of_a_run(scene(), [&](const State& state, auto&) { ++seen[place(state)]; });
  std::size_t interruptions = 0;
  for (const auto& [where, count] : seen) {
    for (const std::uint64_t chosen : std::set{std::uint64_t(0), count / 2, count - 1}) {
      std::uint64_t n = 0;
      ++interruptions;
      SCOPED_TRACE(where + ", step " + std::to_string(chosen) + " of " + std::to_string(count));
      expect_straight(digests_of_a_run(scene(), [&](State& state, auto& experiment) {
        if (place(state) == where && n++ == chosen) reload(scene(), state, experiment);
      }));
    }
  }
  EXPECT_GE(interruptions, 3 * scene().drive.levels.size());
}

TEST_P(Restart, AShortRampContinuedWithTheRestOfItsLevelsEqualsTheLongRamp) {
  Scene shorter = scene();
  shorter.drive.levels.resize(1);
  Experiment first(shorter);
  State state = first.begin();
  while (!Experiment::finished(state)) first.step(state);
  state = state_from_image(checkpoint_image(state), "checkpoint");
  Experiment rest(scene());
  ASSERT_TRUE(rest.reopen(state));
  while (!Experiment::finished(state)) rest.step(state);
  EXPECT_EQ(state_digest(state), straight().back());
}

INSTANTIATE_TEST_SUITE_P(TinyScenes, Restart, testing::ValuesIn(tiny_scenes()),
                         [](const auto& tiny) { return tiny.param.name; });

/// Before every step of a hold's last half some grain is between two rests, and what it has done so far must not be lost.
TEST(RestartInAHop, CountsTheHopsThatAnUninterruptedRunCounts) {
  const Scene scene = hopping().scene;
  const auto run = [&](bool killed) {
    auto experiment = std::make_unique<Experiment>(scene);
    State state = experiment->begin();
    std::size_t kills = 0;
    while (!Experiment::finished(state)) {
      const auto& since = state.hops.left_rest;
      const bool in_a_hop = std::ranges::any_of(std::views::iota(std::size_t(0), since.size()), [&](std::size_t p) {
        return !state.hops.resting[p] && since[p] >= state.search.hold_start && state.hops.way_when_fast[p] != 0;
      });
      if (killed && in_a_hop && state.clock.step % 9 == 0) ++kills, reload(scene, state, experiment);
      experiment->step(state);
    }
    EXPECT_EQ(kills > 3, killed);
    return state;
  };
  const State straight = run(false), killed = run(true);
  EXPECT_EQ(straight.record.hops, killed.record.hops);
  EXPECT_EQ(straight.record.hop_histograms, killed.record.hop_histograms);
  EXPECT_EQ(state_digest(straight), state_digest(killed));
  EXPECT_GT(straight.record.hops.hops.back(), 3);
  EXPECT_GT(straight.record.hops.rests.back(), 0);
}

template <class Field>
bool in_use(const Field& field) {
  if constexpr (requires { field.values; }) {
    return in_use(field.values);
  } else if constexpr (requires { field.size(); }) {
    return std::ranges::any_of(field, [](const auto& element) { return element != typename Field::value_type{}; });
  } else {
    return field != 0;
  }
}

/// What is zero throughout would be remembered rightly by chance.
TEST(TinyScenes, HaveEveryFieldOfTheStateInUseSomewhere) {
  std::set<std::string> idle, used;
  const auto look = [&](const State& state) {
    State::each_field(state, [&](const std::string& name, const auto& field, const char*) {
      (in_use(field) ? used : idle).insert(name);
    });
  };
  for (const TinyScene& tiny : tiny_scenes()) {
    Experiment experiment(tiny.scene);
    State state = experiment.begin();
    for (look(state); !Experiment::finished(state); look(state)) experiment.step(state);
  }
  for (const std::string& name : idle) EXPECT_TRUE(used.contains(name)) << name;
}

/// The solver of these tests, and the same sources without optimisation (in a debug build: with it).
TEST(RestartAcrossBuilds, AnOptimisedAndAPlainBuildGiveTheSameDigestsAtEveryStep) {
  Digests here, there;
  for (const TinyScene& tiny : tiny_scenes()) {
    const Digests run = digests_of_a_run(tiny.scene);
    here.insert(here.end(), run.begin(), run.end());
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(::popen(BEDLOAD_OTHER_OPTIMISATION, "r"), ::pclose);
  ASSERT_NE(pipe, nullptr);
  for (char line[80]; std::fgets(line, sizeof line, pipe.get()) != nullptr;) there.emplace_back(line, 64);
  const auto [mine, other] = std::ranges::mismatch(here, there);
  EXPECT_TRUE(mine == here.end() && other == there.end()) << "differs first at step " << mine - here.begin() << "; "
                                                          << here.size() << " steps here, " << there.size() << " there";
}

}   // namespace
}   // namespace bedload::test

// What is told of a case.
#include "studies/explain.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "checkpoint/checkpoint_series.hpp"
#include "studies/case_entry.hpp"
#include "tests/studies/study_fixture.hpp"
#include "tests/support/temporary_directory.hpp"

namespace bedload {
namespace {

/// The story of a case that has come to step 100, so many of them taken again.
std::vector<std::string> story_after(std::uint64_t retries) {
  const auto one = unfold(parse_study(good_study, "study.toml")).front();
  const TemporaryDirectory results;
  const auto directory = case_directory(results.path(), one.id);
  write_case_directory(directory, one.inputs, one.label, {});
  State state;
  state.clock.step = 100;
  state.clock.retries = retries;
  CheckpointSeries(directory, 2, [](const std::string&) {}).publish(state);
  return story_of(case_entry(one), directory);
}

TEST(Story, TellsOfStepsThatWereTakenAgain) {
  EXPECT_EQ(std::ranges::count(story_after(1), "1 step was taken again shorter"), 1);
  EXPECT_EQ(std::ranges::count(story_after(12), "12 steps were taken again shorter"), 1);
  for (const auto& line : story_after(0)) EXPECT_EQ(line.find("taken again"), line.npos) << line;
}

TEST(Story, SaysWhereTheNextRunGoesOn) {
  EXPECT_EQ(story_after(0).back(), "the next `bedload run` continues it from step 100");
}

}   // namespace
}   // namespace bedload

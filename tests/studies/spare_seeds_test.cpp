// Seeds are used a batch at a time, until their interval is as narrow as was asked for.
#include "studies/spare_seeds.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "studies/results.hpp"
#include "studies/study.hpp"
#include "tests/studies/study_fixture.hpp"
#include "tests/support/temporary_directory.hpp"

namespace bedload {
namespace {

/// Two parameter sets of twelve packings each.
Study study_of(const std::string& onset) {
  auto text = with(good_study, "seed = { count = 2 }", "seed = { count = 12 }");
  text = with(text, "density = [\"2000 kg/m3\", \"3000 kg/m3\"]", "density = \"2000 kg/m3\"");
  return parse_study(with(text, "[drive]", "[onset]\n" + onset + "\n[drive]"), "study.toml");
}

class SpareSeeds : public ::testing::Test {
 protected:
  SpareSeeds() { create_result_tables(database_); }

  /// Stores that a packing began to move between these Shields numbers.
  void finish(const Case& one, double lower, double upper) {
    database_.execute(
        "INSERT OR REPLACE INTO scenes VALUES "
        "(?,?,?,?,?,5e-4,0.05,2000,1000,2,1e-5,9.81,3.5,1e5,300,244,1,1,1,1,1,2e-4,"
        "'di_felice',1,1,1,0)",
        {one.id, one.label, one.set, one.set_label, static_cast<std::int64_t>(one.seed)});
    database_.execute(
        "INSERT OR REPLACE INTO thresholds VALUES "
        "(?,'flux',0.01,1,'bracketed',?,?,?,'bisect',NULL,NULL,0.58,4.5,NULL,NULL,NULL)",
        {one.id, (lower + upper) / 2, lower, upper});
  }
  /// The first so many seeds of the first parameter set.
  void finish_first(std::uint64_t seeds) {
    for (const Case& one : cases)
      if (one.set == cases[0].set && one.seed <= seeds) finish(one, 0.12, 0.1248);
  }

  Study study = study_of("interval = \"10 %\"\nbatch = 3");
  std::vector<Case> cases = unfold(study);

 private:
  TemporaryDirectory directory_;

 protected:
  Database database_{directory_.path() / "study.db", Database::Mode::write};
};

TEST_F(SpareSeeds, AreNoneWhereNoIntervalIsAskedFor) { EXPECT_TRUE(spare_seeds(database_, cases, SeedRule{}).empty()); }

TEST_F(SpareSeeds, AreAllBeyondTheFirstBatchAtFirst) {
  const auto spare = spare_seeds(database_, cases, study.seeds);
  EXPECT_EQ(spare.size(), 2 * 9u);
  for (const Case& one : cases) EXPECT_EQ(std::ranges::find(spare, one.id) == spare.end(), one.seed <= 3) << one.label;
}

/// Three seeds have no interval of 95 %, however alike they are; six have.
TEST_F(SpareSeeds, AreReleasedABatchAtATimeUntilTheIntervalIsNarrow) {
  finish_first(3);
  EXPECT_EQ(spare_seeds(database_, cases, study.seeds).size(), 6 + 9u);
  finish_first(6);
  EXPECT_EQ(spare_seeds(database_, cases, study.seeds).size(), 6 + 9u);
}

/// Whichever case of a batch ends first: seeds beyond a gap do not count.
TEST_F(SpareSeeds, WaitForTheWholeBatch) {
  for (const Case& one : cases)
    if (one.set == cases[0].set && (one.seed == 1 || one.seed == 3)) finish(one, 0.12, 0.1248);
  EXPECT_EQ(spare_seeds(database_, cases, study.seeds).size(), 2 * 9u);
}

TEST_F(SpareSeeds, AreUsedUpWhereTheSpreadIsWide) {
  for (const Case& one : cases) finish(one, one.seed % 2 ? 0.10 : 0.16, one.seed % 2 ? 0.104 : 0.1664);
  EXPECT_TRUE(spare_seeds(database_, cases, study.seeds).empty());
}

TEST(SeedRule, NeedsAnAxisOfSeeds) {
  const auto one_seed = with(good_study, "seed = { count = 2 }", "seed = 1");
  EXPECT_TRUE(says(complaint(with(one_seed, "[drive]", "[onset]\ninterval = \"15 %\"\n[drive]")),
                   "onset.interval: there is one packing, which has no interval"));
}

TEST(SeedRule, IsARelativeInterval) {
  const auto asked = [](const std::string& interval) {
    return complaint(with(good_study, "[drive]", "[onset]\ninterval = " + interval + "\n[drive]"));
  };
  EXPECT_EQ(asked("\"15 %\""), "");
  EXPECT_EQ(asked("0.15"), "");
  EXPECT_TRUE(says(asked("15"), "onset.interval: 15 is no interval of a threshold"));
  EXPECT_TRUE(says(asked("\"15 mm\""), "\"15 mm\" is a length, not a number without unit"));
  EXPECT_DOUBLE_EQ(*study_of("interval = \"15 %\"").seeds.interval, 0.15);
}

}   // namespace
}   // namespace bedload

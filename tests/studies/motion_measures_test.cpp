// Movers and flux laws over seeds: medians of what is known, bounds of what is not.
#include "studies/motion_measures.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "studies/database_values.hpp"
#include "studies/results.hpp"
#include "studies/threshold_curve.hpp"
#include "tests/support/temporary_directory.hpp"

namespace bedload {
namespace {

constexpr double open_end = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

TEST(OverSeeds, TakesTheMedianOfWhatIsKnown) {
  const OverSeeds of = over_seeds({{0.3, 0.3}, {0.1, 0.1}, {0.15, 0.15}});
  EXPECT_EQ(of.median, (ShieldsBounds{0.15, 0.15}));
  EXPECT_EQ(in_words(of), "0.1500 (0.1000-0.3000)");
  EXPECT_EQ(over_seeds({{0.25, 0.25}, {0.5, 0.5}}).median, (ShieldsBounds{0.375, 0.375}));
  EXPECT_EQ(in_words(over_seeds({{0.15, 0.15}})), "0.1500");
  EXPECT_EQ(in_words(over_seeds({})), "-");
}

TEST(OverSeeds, KeepsToBoundsWhereSeedsAreCensored) {
  EXPECT_EQ(in_words(over_seeds({{0, 0.06}})), "< 0.0600");
  EXPECT_EQ(in_words(over_seeds({{0.3, infinite}})), "> 0.3000");
  // one of three is open above: the middle one is known all the same
  EXPECT_EQ(in_words(over_seeds({{0.3, infinite}, {0.1, 0.1}, {0.2, 0.2}})), "0.2000 (0.1000->0.3000)");
  // the one that is open below may be smaller or larger than 0.05
  EXPECT_EQ(in_words(over_seeds({{0, 0.06}, {0.05, 0.05}, {0.2, 0.2}})), "0.0500 to 0.0600 (<0.0500-0.2000)");
}

class MotionMeasuresTest : public ::testing::Test {
 protected:
  MotionMeasuresTest() { create_result_tables(database_); }
  std::string id(const std::string& set, int seed) const { return set + "-" + std::to_string(seed); }
  void add_scene(const std::string& set, int seed, double diameter) {
    database_.execute(
        "INSERT INTO scenes VALUES "
        "(?,?,?,?,?,?,0.05,2000,1000,2,1e-5,9.81,3.5,1e5,1500,244,1,1,1,1,1,2.5e-4,'di_felice',1,1,1,0)",
        {id(set, seed), id(set, seed), set, "label-" + set, std::int64_t{seed}, diameter});
  }
  void add_threshold(const std::string& set, int seed, const std::string& criterion, double value, double shields,
                     double lower, double upper, bool decides = false) {
    database_.execute(
        "INSERT INTO thresholds VALUES (?,?,?,?,'bracketed',?,?,?,'ramp',NULL,NULL,0.58,4.5,NULL,NULL,NULL)",
        {id(set, seed), criterion, value, std::int64_t{decides}, real_or_null(shields), real_or_null(lower),
         real_or_null(upper)});
    update_threshold_curve(database_);
  }
  void add_flux_law(const std::string& set, int seed, double threshold, double error) {
    database_.execute("INSERT INTO flux_laws VALUES (?, 3, ?, ?, 1, 0.1, 4)", {id(set, seed), threshold, error});
  }

  TemporaryDirectory directory_;
  Database database_{directory_.path() / "study.db", Database::Mode::write};
};

TEST_F(MotionMeasuresTest, KnowsNothingWithoutResults) {
  EXPECT_TRUE(motion_measures(database_).empty());
  EXPECT_EQ(motion_as_table({}), "");
}

TEST_F(MotionMeasuresTest, GathersEveryMeasureOverTheSeeds) {
  for (int seed = 1; seed <= 3; ++seed) {
    add_scene("a", seed, 5e-4);
    add_threshold("a", seed, "flux", 0.01, 0.9, 0.8, 1.0, true);   // the study's own: not among these
    add_threshold("a", seed, "moved_grains", 1, 0.01 * seed, 0.005, 0.02 * seed);
    add_threshold("a", seed, "moved_fraction", 0.01, 0.05 * seed, 0.01, 0.2);
    add_threshold("a", seed, "moved_fraction", 0.1, seed == 2 ? open_end : 0.1 * seed, 0.1, seed == 2 ? open_end : 0.4);
    add_threshold("a", seed, "reference_transport", 0.002, 0.07 * seed, 0.01, 0.3);
    add_flux_law("a", seed, 0.1 + 0.01 * seed, 0.001 * seed);
  }
  const auto all = motion_measures(database_);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].label, "label-a");
  EXPECT_EQ(in_words(all[0].first_grain), "0.0200 (0.0100-0.0300)");
  EXPECT_EQ(in_words(all[0].one_percent), "0.1000 (0.0500-0.1500)");
  EXPECT_EQ(in_words(all[0].ten_percent), "0.1000 to 0.3000 (0.1000->0.3000)");
  EXPECT_EQ(in_words(all[0].reference_transport), "0.1400 (0.0700-0.2100)");
  ASSERT_TRUE(all[0].flux_law);
  EXPECT_EQ(all[0].flux_law->exponent, 3);
  EXPECT_EQ(in_words(*all[0].flux_law), "0.1200 +- 0.002 (0.1100-0.1300)");
  const auto table = motion_as_table(all);
  EXPECT_NE(table.find("first grain"), table.npos) << table;
  EXPECT_NE(table.find("3, 0.1200 +- 0.002 (0.1100-0.1300)\n"), table.npos) << table;
  const auto json = nlohmann::json::parse(curve_as_json(threshold_curve(database_), all));
  EXPECT_EQ(json[0]["motion"]["first_grain"]["median"][0].get<double>(), 0.02);
  EXPECT_TRUE(json[0]["motion"]["moved_10_percent"]["greatest"][1].is_null());
  EXPECT_EQ(json[0]["motion"]["flux_law"]["threshold_error"].get<double>(), 0.002);
}

TEST_F(MotionMeasuresTest, LeavesOutVariationsAndCasesThatLeftTheStudy) {
  for (const auto* set : {"a", "b", "c"}) {
    add_scene(set, 1, set[0] == 'c' ? 4e-4 : 5e-4);
    add_threshold(set, 1, "moved_grains", 1, 0.1, 0.05, 0.2);
  }
  EXPECT_EQ(motion_measures(database_).size(), 3u);
  EXPECT_EQ(motion_measures(database_)[0].set, "c");   // by diameter
  database_.execute("CREATE TABLE cases (case_id TEXT, in_study INTEGER)");
  database_.execute("INSERT INTO cases VALUES ('a-1', 0), ('b-1', 1), ('c-1', 1)");
  database_.execute("INSERT INTO variations VALUES ('b-1', 'mesh', 'c-1')");
  const auto all = motion_measures(database_);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].set, "c");
  EXPECT_FALSE(all[0].flux_law);
}

}   // namespace
}   // namespace bedload

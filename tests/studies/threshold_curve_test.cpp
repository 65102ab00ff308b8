// Seeds to points: fit, extremes, censoring; and the same text for the same study.
#include "studies/threshold_curve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "studies/database_values.hpp"
#include "studies/results.hpp"
#include "tests/support/temporary_directory.hpp"

namespace bedload {
namespace {

constexpr double open_end = std::numeric_limits<double>::quiet_NaN();

class ThresholdCurveTest : public ::testing::Test {
 protected:
  ThresholdCurveTest() { create_result_tables(database_); }

  void add_seed(const std::string& set, int seed, double diameter, const std::string& status, double shields,
                double lower, double upper, std::pair<double, double> stop = {open_end, open_end}) {
    const std::string id = set + "-" + std::to_string(seed);
    database_.execute(
        "INSERT INTO scenes VALUES "
        "(?,?,?,?,?,?,0.05,2000,1000,2,1e-5,9.81,3.5,1e5,1500,244,1,1,1,1,1,?,'di_felice',1,1,1,0)",
        {id, id, set, "label-" + set, std::int64_t{seed}, diameter, cell_z});
    database_.execute("INSERT INTO thresholds VALUES (?,'flux',0.01,1,?,?,?,?,'ramp',?,?,0.58,4.5,NULL,NULL,NULL)",
                      {id, status, real_or_null(shields), real_or_null(lower), real_or_null(upper),
                       real_or_null(stop.first), real_or_null(stop.second)});
    update_threshold_curve(database_);
  }
  ThresholdPoint only_point() const {
    const auto curve = threshold_curve(database_);
    EXPECT_EQ(curve.size(), 1u);
    return curve.at(0);
  }

  double cell_z = 0.25e-3;   // [m]
  TemporaryDirectory directory_;
  Database database_{directory_.path() / "study.db", Database::Mode::write};
};

TEST_F(ThresholdCurveTest, HoldsOneSeedWithinItsBracketAndNamesNoInterval) {
  add_seed("a", 1, 5e-4, "bracketed", 0.16, 0.15, 0.18);
  const ThresholdPoint point = only_point();
  EXPECT_DOUBLE_EQ(point.shields, std::sqrt(0.15 * 0.18));
  EXPECT_EQ(point.lower, 0.15);
  EXPECT_EQ(point.upper, 0.18);
  EXPECT_EQ(point.confidence, 0);
  EXPECT_TRUE(std::isnan(point.interval_lower));
  EXPECT_TRUE(std::isnan(point.shields_16));
  EXPECT_TRUE(std::isnan(point.stop));
}

/// The fit is threshold_fit's, whatever the order in which the seeds finished.
TEST_F(ThresholdCurveTest, FitsTheBracketsOfTheSeeds) {
  const std::vector<SeedBracket> brackets{{1, 0.15, 0.16}, {2, 0.19, 0.20}, {3, 0.13, 0.14}, {4, 0.16, 0.17},
                                          {5, 0.17, 0.18}, {6, 0.15, 0.16}, {7, 0.14, 0.15}};
  for (const SeedBracket& b :
       {brackets[4], brackets[0], brackets[6], brackets[1], brackets[2], brackets[5], brackets[3]})
    add_seed("a", static_cast<int>(b.seed), 5e-4, "bracketed", 0.16, b.lower, b.upper);
  const ThresholdPoint point = only_point();
  const ThresholdFit fit = fit_threshold(brackets);
  EXPECT_EQ(point.shields, fit.theta_50);
  EXPECT_EQ(point.shields_16, fit.theta_16);
  EXPECT_EQ(point.shields_84, fit.theta_84);
  EXPECT_EQ(point.interval_lower, interval_of_threshold(brackets).lower);
  EXPECT_EQ(point.interval_upper, interval_of_threshold(brackets).upper);
  EXPECT_EQ(point.confidence, 0.95);
  EXPECT_EQ(point.lower, 0.13);
  EXPECT_EQ(point.upper, 0.20);
  EXPECT_EQ(point.seeds, 7u);
  EXPECT_DOUBLE_EQ(point.reynolds, std::sqrt(fit.theta_50) * 3.5);
}

TEST_F(ThresholdCurveTest, FitsAlsoWhereMovingBedsStopAndHowFarBelow) {
  for (int seed = 1; seed <= 6; ++seed) add_seed("a", seed, 5e-4, "bracketed", 0.16, 0.16, 0.17, {0.14, 0.15});
  const ThresholdPoint point = only_point();
  EXPECT_DOUBLE_EQ(point.stop, std::sqrt(0.14 * 0.15));
  EXPECT_EQ(point.stop_interval_lower, 0.14);
  EXPECT_EQ(point.stop_interval_upper, 0.15);
  EXPECT_NEAR(point.hysteresis, 1 - std::sqrt(0.14 * 0.15 / (0.16 * 0.17)), 1e-15);
}

TEST_F(ThresholdCurveTest, OpensTheBoundWhenOneSeedIsCensored) {
  add_seed("a", 1, 5e-4, "bracketed", 0.16, 0.15, 0.18);
  add_seed("a", 2, 5e-4, "bracketed", 0.20, 0.19, 0.22);
  add_seed("a", 3, 5e-4, "censored_above", open_end, 0.44, open_end);
  const ThresholdPoint point = only_point();
  EXPECT_EQ(point.status, "bracketed");
  EXPECT_GT(point.shields, 0.18);
  EXPECT_EQ(point.lower, 0.15);
  EXPECT_TRUE(std::isnan(point.upper));
  EXPECT_EQ(point.censored_above, 1u);
}

/// Noise of a search: what moved was measured to be weaker than what rested.
TEST_F(ThresholdCurveTest, TakesBoundsInTheWrongOrderForAllThatTheRunKnows) {
  add_seed("a", 1, 5e-4, "noisy", 0.16, 0.162, 0.158);
  const ThresholdPoint point = only_point();
  EXPECT_DOUBLE_EQ(point.shields, std::sqrt(0.158 * 0.162));
  EXPECT_EQ(point.noisy, 1u);
  EXPECT_EQ(seed_bracket(3, 0.15, 0.15).lower, 0.15);
  EXPECT_GT(seed_bracket(3, 0.15, 0.15).upper, 0.15);
  EXPECT_EQ(seed_bracket(3, open_end, 0.15).lower, 0);
  EXPECT_TRUE(std::isinf(seed_bracket(3, 0.15, open_end).upper));
}

TEST_F(ThresholdCurveTest, IsOneSidedWhenEverySeedIsCensored) {
  add_seed("a", 1, 5e-4, "censored_above", open_end, 0.44, open_end);
  add_seed("b", 1, 6e-4, "censored_below", open_end, open_end, 0.06);
  const auto curve = threshold_curve(database_);
  ASSERT_EQ(curve.size(), 2u);
  EXPECT_EQ(curve[0].status, "censored_above");
  EXPECT_TRUE(std::isnan(curve[0].shields));
  EXPECT_EQ(curve[0].lower, 0.44);
  EXPECT_DOUBLE_EQ(curve[0].reynolds, std::sqrt(0.44) * 3.5);
  EXPECT_EQ(curve[1].status, "censored_below");
  EXPECT_EQ(curve[1].upper, 0.06);
}

TEST_F(ThresholdCurveTest, LeavesOutCasesThatLeftTheStudy) {
  add_seed("a", 1, 5e-4, "bracketed", 0.16, 0.15, 0.18);
  add_seed("b", 1, 6e-4, "bracketed", 0.20, 0.19, 0.22);
  database_.execute("CREATE TABLE cases (case_id TEXT, in_study INTEGER)");
  database_.execute("INSERT INTO cases VALUES ('a-1', 0), ('b-1', 1)");
  update_threshold_curve(database_);
  EXPECT_EQ(only_point().set, "b");
}

TEST_F(ThresholdCurveTest, PrintsTheSameBytesInWhateverOrderTheCasesFinished) {
  add_seed("b", 1, 6e-4, "bracketed", 0.2, 0.19, 0.22);
  add_seed("a", 2, 5e-4, "bracketed", 0.1 + 0.2, 0.13, 0.4);
  add_seed("a", 1, 5e-4, "censored_below", open_end, open_end, 0.06);
  const auto csv_of = [&] { return curve_as_csv(threshold_curve(database_)); };
  const std::string csv = csv_of();
  database_.execute("DELETE FROM scenes");
  database_.execute("DELETE FROM thresholds");
  add_seed("a", 1, 5e-4, "censored_below", open_end, open_end, 0.06);
  add_seed("a", 2, 5e-4, "bracketed", 0.1 + 0.2, 0.13, 0.4);
  add_seed("b", 1, 6e-4, "bracketed", 0.2, 0.19, 0.22);
  EXPECT_EQ(csv, csv_of());
  EXPECT_TRUE(csv.starts_with(
      "label,diameter_m,density_ratio,viscosity_m2_per_s,cell_z_d,method,criterion,criterion_value,galileo,"
      "friction_reynolds,shields,shields_16,shields_84,interval_lower,interval_upper,confidence,shields_lower,"
      "shields_upper,stop,stop_interval_lower,stop_interval_upper,hysteresis,systematic,status,seeds,bracketed,"
      "censored_below,"
      "censored_above,noisy,parameter_set\n"
      "label-a,0.0005,2,1e-05,0.5,ramp,flux,0.01,3.5,"))
      << csv;
  EXPECT_NE(csv.find(",,0.4,,,,,,bracketed,2,1,1,0,0,a\nlabel-b,"), csv.npos) << csv;
}

TEST_F(ThresholdCurveTest, WritesNumbersThatReadBackToTheSameBits) {
  add_seed("a", 1, 5e-4, "bracketed", 0.2, 0.1 + 0.2, 1.0 / 3);
  const auto json = nlohmann::json::parse(curve_as_json(threshold_curve(database_), {}));
  EXPECT_EQ(json[0]["shields_lower"].get<double>(), 0.1 + 0.2);
  EXPECT_EQ(json[0]["shields_upper"].get<double>(), 1.0 / 3);
  EXPECT_NE(curve_as_csv(threshold_curve(database_)).find(",0.30000000000000004,0.3333333333333333,"),
            std::string::npos);
}

TEST_F(ThresholdCurveTest, ShowsOneSidedBoundsToPeopleAsInequalities) {
  add_seed("a", 1, 5e-4, "censored_above", open_end, 0.44, open_end);
  EXPECT_NE(curve_as_table(threshold_curve(database_), error_budget(database_)).find("> 0.4400"), std::string::npos);
}

TEST(IntervalInWords, SaysWhichEndIsOpen) {
  ThresholdPoint p;
  p.confidence = 0.5, p.interval_lower = 0.11, p.interval_upper = 0.13;
  EXPECT_EQ(interval_in_words(p), "0.1100-0.1300 50%");
  p.interval_upper = open_end;
  EXPECT_EQ(interval_in_words(p), "> 0.1100 50%");
  std::swap(p.interval_lower, p.interval_upper);
  p.confidence = 0.95;
  EXPECT_EQ(interval_in_words(p), "< 0.1100");
  p.interval_upper = open_end;
  EXPECT_EQ(interval_in_words(p), "-");
}

TEST_F(ThresholdCurveTest, SaysWhatCountsAsOnsetOnWhichCells) {
  add_seed("a", 1, 5e-4, "bracketed", 0.16, 0.15, 0.18);
  const auto said = curve_as_table(threshold_curve(database_), error_budget(database_));
  EXPECT_NE(said.find("\nonset: flux >= 0.01 per surface grain and td, by a ramp (screening); cells 0.5 d high\n"),
            said.npos)
      << said;
  EXPECT_EQ(said.find("lower -"), said.npos) << said;
  EXPECT_EQ(said.find("noisy:"), said.npos) << said;
  cell_z = 0.5e-3;
  add_seed("b", 1, 5e-4, "bracketed", 0.16, 0.15, 0.18);
  EXPECT_NE(curve_as_table(threshold_curve(database_), error_budget(database_)).find("; cells 0.5 to 1 d high\n"),
            said.npos);
  EXPECT_EQ(nlohmann::json::parse(curve_as_json(threshold_curve(database_), {}))[1]["criterion"], "flux");
}

TEST_F(ThresholdCurveTest, SaysWhatAMissingBoundAndANoisyRampMean) {
  add_seed("a", 1, 5e-4, "noisy", 0.16, open_end, 0.18);
  const auto said = curve_as_table(threshold_curve(database_), error_budget(database_));
  EXPECT_NE(said.find("\nlower -: "), said.npos) << said;
  EXPECT_EQ(said.find("\nupper -: "), said.npos) << said;
  EXPECT_NE(said.find("\nnoisy: "), said.npos) << said;
}

}   // namespace
}   // namespace bedload

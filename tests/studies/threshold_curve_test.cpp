// Seeds to points: medians, extremes, censoring; and the same text for the same study.
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
                double lower, double upper) {
    const std::string id = set + "-" + std::to_string(seed);
    database_.execute(
        "INSERT INTO scenes VALUES "
        "(?,?,?,?,?,?,0.05,2000,1000,2,1e-5,9.81,3.5,1e5,1500,244,1,1,1,1,1,?,'di_felice',1,1,1,0)",
        {id, id, set, "label-" + set, std::int64_t{seed}, diameter, cell_z});
    database_.execute("INSERT INTO thresholds VALUES (?,'flux',0.01,1,?,?,?,?,'ramp',NULL,NULL)",
                      {id, status, real_or_null(shields), real_or_null(lower), real_or_null(upper)});
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

TEST_F(ThresholdCurveTest, TakesTheMedianSeedAndTheExtremesOfTheirBounds) {
  add_seed("a", 1, 5e-4, "bracketed", 0.16, 0.15, 0.18);
  add_seed("a", 2, 5e-4, "bracketed", 0.20, 0.19, 0.22);
  add_seed("a", 3, 5e-4, "bracketed", 0.17, 0.13, 0.19);
  const ThresholdPoint point = only_point();
  EXPECT_EQ(point.shields, 0.17);
  EXPECT_EQ(point.lower, 0.13);
  EXPECT_EQ(point.upper, 0.22);
  EXPECT_EQ(point.status, "bracketed");
  EXPECT_EQ(point.seeds, 3u);
  EXPECT_DOUBLE_EQ(point.reynolds, std::sqrt(0.17) * 3.5);
}

TEST_F(ThresholdCurveTest, AveragesTheTwoMiddleSeedsOfAnEvenNumber) {
  add_seed("a", 1, 5e-4, "bracketed", 0.16, 0.15, 0.18);
  add_seed("a", 2, 5e-4, "bracketed", 0.20, 0.19, 0.22);
  EXPECT_DOUBLE_EQ(only_point().shields, 0.18);
}

TEST_F(ThresholdCurveTest, KeepsAMedianButOpensTheBoundWhenOneSeedIsCensored) {
  add_seed("a", 1, 5e-4, "bracketed", 0.16, 0.15, 0.18);
  add_seed("a", 2, 5e-4, "bracketed", 0.20, 0.19, 0.22);
  add_seed("a", 3, 5e-4, "censored_above", open_end, 0.44, open_end);
  const ThresholdPoint point = only_point();
  EXPECT_EQ(point.shields, 0.20);
  EXPECT_EQ(point.lower, 0.15);
  EXPECT_TRUE(std::isnan(point.upper));
  EXPECT_EQ(point.censored_above, 1u);
}

TEST_F(ThresholdCurveTest, IsOneSidedWhenTheMedianSeedIsCensored) {
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
  const std::string csv = curve_as_csv(threshold_curve(database_));
  EXPECT_EQ(csv,
            "label,diameter_m,density_ratio,viscosity_m2_per_s,cell_z_d,criterion,criterion_value,galileo,friction_"
            "reynolds,shields,shields_lower,shields_upper,"
            "status,seeds,bracketed,censored_below,censored_above,noisy,parameter_set\n"
            "label-a,0.0005,2,1e-05,0.5,flux,0.01,3.5,2.2135943621178655,,,0.4,censored_below,2,1,1,0,0,a\n"
            "label-b,0.0006,2,1e-05,0.4166666666666667,flux,0.01,3.5,1.5652475842498528,0.2,0.19,0.22,bracketed,1,1,0,"
            "0,0,b\n");
}

TEST_F(ThresholdCurveTest, WritesNumbersThatReadBackToTheSameBits) {
  add_seed("a", 1, 5e-4, "bracketed", 0.1 + 0.2, 0.1, 1.0 / 3);
  const auto json = nlohmann::json::parse(curve_as_json(threshold_curve(database_)));
  EXPECT_EQ(json[0]["shields"].get<double>(), 0.1 + 0.2);
  EXPECT_EQ(json[0]["shields_upper"].get<double>(), 1.0 / 3);
  EXPECT_NE(curve_as_csv(threshold_curve(database_)).find(",0.30000000000000004,0.1,0.3333333333333333,"),
            std::string::npos);
}

TEST_F(ThresholdCurveTest, ShowsOneSidedBoundsToPeopleAsInequalities) {
  add_seed("a", 1, 5e-4, "censored_above", open_end, 0.44, open_end);
  EXPECT_NE(curve_as_table(threshold_curve(database_)).find("> 0.4400"), std::string::npos);
}

TEST_F(ThresholdCurveTest, SaysWhatCountsAsOnsetOnWhichCells) {
  add_seed("a", 1, 5e-4, "bracketed", 0.16, 0.15, 0.18);
  const auto said = curve_as_table(threshold_curve(database_));
  EXPECT_NE(said.find("\nonset: flux >= 0.01 per surface grain and td, by a ramp (screening); cells 0.5 d high\n"),
            said.npos)
      << said;
  EXPECT_EQ(said.find("lower -"), said.npos) << said;
  EXPECT_EQ(said.find("noisy:"), said.npos) << said;
  cell_z = 0.5e-3;
  add_seed("b", 1, 5e-4, "bracketed", 0.16, 0.15, 0.18);
  EXPECT_NE(curve_as_table(threshold_curve(database_)).find("; cells 0.5 to 1 d high\n"), said.npos);
  EXPECT_EQ(nlohmann::json::parse(curve_as_json(threshold_curve(database_)))[1]["criterion"], "flux");
}

TEST_F(ThresholdCurveTest, SaysWhatAMissingBoundAndANoisyRampMean) {
  add_seed("a", 1, 5e-4, "noisy", 0.16, open_end, 0.18);
  const auto said = curve_as_table(threshold_curve(database_));
  EXPECT_NE(said.find("\nlower -: "), said.npos) << said;
  EXPECT_EQ(said.find("\nupper -: "), said.npos) << said;
  EXPECT_NE(said.find("\nnoisy: "), said.npos) << said;
}

}   // namespace
}   // namespace bedload

// Pairs of runs, one thing changed, as the systematic error of a campaign.
#include "studies/error_budget.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "studies/database_values.hpp"
#include "studies/results.hpp"
#include "studies/study.hpp"
#include "studies/threshold_curve.hpp"
#include "tests/studies/study_fixture.hpp"
#include "tests/support/temporary_directory.hpp"

namespace bedload {
namespace {

Study searched(const std::string& budget) {
  return parse_study(with(with(good_study, "count = 2", "count = 5"), "[drive]",
                          "[onset]\nmethod = \"bisect\"\n" + budget + "\n[drive]"),
                     "study.toml");
}

TEST(ErrorBudget, AddsToTheFirstCaseOneForEachPair) {
  const auto plain = unfold(searched("")), all = unfold(searched("budget = \"auto\""));
  ASSERT_EQ(all.size(), plain.size() + 4 * 3) << "three of the five packings, four pairs each";
  const Case& first = all.front();
  std::map<std::string, const Case*> pairs;
  for (const Case& one : all) {
    if (one.base_id.empty()) continue;
    EXPECT_LE(one.seed, 3u);
    const auto base = std::ranges::find(all, one.base_id, &Case::id);
    ASSERT_NE(base, all.end());
    EXPECT_EQ(base->seed, one.seed);
    EXPECT_EQ(base->set, first.set);
    if (one.seed != 1) continue;
    EXPECT_EQ(one.base_id, first.id);
    EXPECT_EQ(one.seed, first.seed);
    EXPECT_NE(one.set, first.set);
    pairs[one.variation] = &one;
  }
  ASSERT_EQ(pairs.size(), 4u);
  EXPECT_DOUBLE_EQ(pairs["bracket"]->scene.onset.bracket, 0.25 * first.scene.onset.bracket);
  EXPECT_DOUBLE_EQ(pairs["hold"]->scene.onset.hold, 3 * first.scene.onset.hold);
  EXPECT_EQ(pairs["mesh"]->scene.grid.cells[2] * 2, first.scene.grid.cells[2]);
  EXPECT_EQ(pairs["mesh"]->scene.grid.cells[0], first.scene.grid.cells[0]);
  EXPECT_DOUBLE_EQ(pairs["area"]->scene.bed.length.x, 2 * first.scene.bed.length.x);
  EXPECT_DOUBLE_EQ(pairs["area"]->scene.bed.length.y, 2 * first.scene.bed.length.y);
  EXPECT_EQ(pairs["area"]->scene.bed.source.count, 4 * first.scene.bed.source.count);
  for (const char* same : {"bracket", "hold", "mesh"}) EXPECT_EQ(pairs[same]->bed_id, first.bed_id) << same;
  EXPECT_EQ(pairs["mesh"]->label, "d0.5mm-rho2000-mesh-s1");
}

/// A pair of a packing that may never be run would be none.
TEST(ErrorBudget, TakesNoMorePackingsThanTheFirstBatchHas) {
  const auto all = unfold(searched("budget = [\"mesh\"]\ninterval = \"15 %\"\nbatch = 2"));
  EXPECT_EQ(std::ranges::count(all, "mesh", &Case::variation), 2);
}

TEST(ErrorBudget, IsNotOfARamp) {
  EXPECT_TRUE(says(complaint(with(good_study, "[drive]", "[onset]\nbudget = [\"mesh\"]\n[drive]")),
                   "onset.budget: a ramp is a screening and has no error budget"));
}

TEST(ErrorBudget, IsNotOfATrade) {
  auto text = with(good_study, "diameter = [\"0.5 mm\", \"0.6 mm\"]", "diameter = \"0.5 mm\"");
  text = with(text, "density = [\"2000 kg/m3\", \"3000 kg/m3\"]", "density = \"2000 kg/m3\"");
  text = with(text, "[drive]", "[onset]\nmethod = \"bisect\"\nbudget = \"auto\"\n[drive]");
  EXPECT_EQ(complaint(text), "");
  EXPECT_TRUE(says(complaint(text + "[[trade]]\nbox.cell.z = \"1 d\"\n"), "onset.budget: this study has [[trade]]"));
}

class BudgetOfResults : public ::testing::Test {
 protected:
  BudgetOfResults() {
    create_result_tables(database);
    store_variations(database, cases);
  }
  const Case& named(const std::string& variation) const {
    return *std::ranges::find(cases, variation, &Case::variation);
  }
  const Case& of_seed(const std::string& variation, double seed) const {
    return *std::ranges::find_if(cases, [&](const Case& one) {
      return one.variation == variation && one.seed == static_cast<std::uint64_t>(seed);
    });
  }
  void finish(const Case& one, double lower, double upper) {
    database.execute(
        "INSERT INTO scenes VALUES (?,?,?,?,?,5e-4,0.05,2000,1000,2,1e-5,9.81,3.5,1e5,300,244,1,1,1,1,1,2e-4,"
        "'di_felice',1,1,1,0)",
        {one.id, one.label, one.set, one.set_label, static_cast<std::int64_t>(one.seed)});
    const double found = std::sqrt(lower * upper);
    database.execute(
        "INSERT INTO thresholds VALUES (?,'flux',0.01,1,'bracketed',?,?,?,'bisect',NULL,NULL,0.58,4.5,NULL,NULL,NULL)",
        {one.id, real_or_null(found), real_or_null(lower), real_or_null(upper)});
    update_threshold_curve(database);
  }
  ThresholdPoint only_point() const {
    const auto curve = threshold_curve(database);
    EXPECT_EQ(curve.size(), 1u);
    return curve.at(0);
  }

  std::vector<Case> cases = unfold(searched("budget = \"auto\""));

 private:
  TemporaryDirectory directory_;

 protected:
  Database database{directory_.path() / "study.db", Database::Mode::write};
};

TEST_F(BudgetOfResults, SaysThatTheMeshIsNotTested) {
  finish(cases.front(), 0.12, 0.1248);
  EXPECT_TRUE(std::isnan(only_point().systematic));
  EXPECT_EQ(budget_in_words(error_budget(database)), "mesh not tested");
  finish(named("hold"), 0.12, 0.1248);
  EXPECT_TRUE(std::isnan(only_point().systematic));
  EXPECT_TRUE(says(budget_in_words(error_budget(database)), "; mesh not tested (1 packing of d0.5mm-rho2000"));
}

/// A threshold lies anywhere in its bracket; with one packing that is all that is known.
TEST_F(BudgetOfResults, IsTheDifferencesOfThePairsOrWhatTheyWouldHaveToExceed) {
  finish(cases.front(), 0.100, 0.104);
  finish(named("mesh"), 0.120, 0.1248);
  finish(named("hold"), 0.101, 0.10504);
  const double two_deviations = 2 * std::log(1.04) / (2 * std::sqrt(3.0)) * std::sqrt(2.0);   // of both ends
  const auto budget = error_budget(database);
  ASSERT_EQ(budget.size(), 2u);
  EXPECT_EQ(budget[0].source, "hold");
  EXPECT_NEAR(budget[0].theta.mean, 0.01, 1e-12);
  EXPECT_NEAR(budget[0].theta.high, 1.01 * std::exp(two_deviations) - 1, 1e-12);
  EXPECT_EQ(budget[1].source, "mesh");
  EXPECT_NEAR(budget[1].theta.mean, 0.2, 1e-12);
  EXPECT_NEAR(only_point().systematic, std::hypot(0.2, budget[0].theta.worst()), 1e-12);
  const auto stored = database.query("SELECT source, packings, difference, difference_upper, size FROM error_sources");
  ASSERT_EQ(stored.rows.size(), 2u);
  EXPECT_EQ(text_in(stored.rows[0][0]), "hold");
  EXPECT_EQ(std::get<std::int64_t>(stored.rows[0][1]), 1);
  EXPECT_NEAR(number_in(stored.rows[0][3]), 1.01 * std::exp(two_deviations) - 1, 1e-12);
  EXPECT_NEAR(number_in(stored.rows[0][4]), budget[0].theta.worst(), 1e-12) << "not seen: the bound";
  EXPECT_NEAR(number_in(stored.rows[1][4]), 0.2, 1e-12);
  EXPECT_EQ(budget_in_words(budget),
            "hold x 3 < 4.3 %, mesh x 2 +20 %; together 20 % (1 packing of d0.5mm-rho2000: how far it scatters is not "
            "known)");
}

TEST_F(BudgetOfResults, KnowsNothingOfACensoredPair) {
  finish(cases.front(), 0.100, 0.104);
  finish(named("mesh"), 0.120, std::nan(""));
  EXPECT_TRUE(std::isnan(only_point().systematic));
  EXPECT_TRUE(says(budget_in_words(error_budget(database)), "mesh x 2 unknown (one of each pair is censored)"));
}

/// Two packings that are changed by +20 % and -20 % have not been changed, as far as one knows; and what they say of chance holds for the
/// other sources too.
TEST_F(BudgetOfResults, KnowsNoDifferenceBetterThanThePackingsAgreeOnIt) {
  for (const double seed : {1.0, 2.0}) finish(of_seed("", seed), 0.100, 0.104);
  finish(of_seed("mesh", 1), 0.120, 0.1248), finish(of_seed("mesh", 2), 0.100 / 1.2, 0.104 / 1.2);
  finish(of_seed("hold", 1), 0.110, 0.1144);
  const auto budget = error_budget(database);
  ASSERT_EQ(budget.size(), 2u);
  EXPECT_EQ(budget[1].packings, 2u);
  EXPECT_NEAR(budget[1].theta.mean, 0, 1e-12);
  // differences of +-ln 1.2: of one side half their variance, 2 (ln 1.2)^2, with one degree of freedom
  const double deviation = std::log(1.2), t = 12.706;
  EXPECT_NEAR(budget[1].theta.high, std::exp(t * deviation) - 1, 1e-9);
  EXPECT_NEAR(budget[0].theta.high, 1.1 * std::exp(t * deviation * std::sqrt(2.0)) - 1, 1e-9);
  EXPECT_FALSE(budget[0].theta.seen());
  EXPECT_TRUE(says(budget_in_words(budget), "(2 packings of d0.5mm-rho2000)"));
}

}   // namespace
}   // namespace bedload

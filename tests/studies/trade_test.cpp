// What settings change and cost, from pairs of cases on the same packings; and the choice by a wanted accuracy.
#include "studies/trade.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "scheduler/ledger.hpp"
#include "solver/state.hpp"
#include "studies/accuracy.hpp"
#include "studies/case_entry.hpp"
#include "studies/database_values.hpp"
#include "studies/error_budget.hpp"
#include "studies/plan.hpp"
#include "studies/results.hpp"
#include "studies/threshold_curve.hpp"
#include "tests/studies/study_fixture.hpp"
#include "tests/support/temporary_directory.hpp"

namespace bedload {
namespace {

std::string one_scene() {
  auto text = with(good_study, "diameter = [\"0.5 mm\", \"0.6 mm\"]", "diameter = \"0.5 mm\"");
  return with(text, "density = [\"2000 kg/m3\", \"3000 kg/m3\"]", "density = \"2000 kg/m3\"");
}
const std::string two_trades =
    "[[trade]]\nbox.cell.z = \"1 d\"\n[[trade]]\nname = \"short\"\ndrive.dwell = \"10 td\"\n";
Study trade_study() { return parse_study(one_scene() + two_trades, "study.toml"); }

TEST(TradeStudy, AddsToEveryPackingACaseForEachTradeOnTheSameBed) {
  const auto cases = unfold(trade_study());
  ASSERT_EQ(cases.size(), 6u);
  EXPECT_EQ(cases[2].label, "screening-hz1d-s1");
  EXPECT_EQ(cases[5].label, "screening-short-s2");
  for (std::size_t n = 2; n < 6; ++n) {
    EXPECT_EQ(cases[n].base_id, cases[n % 2].id);
    EXPECT_EQ(cases[n].bed_id, cases[n % 2].bed_id);
    EXPECT_EQ(cases[n].seed, cases[n % 2].seed);
  }
  EXPECT_EQ(cases[2].scene.grid.cells[2] * 2, cases[0].scene.grid.cells[2]);
}

/// Packing takes steps of its own, so that a trade of DEM steps is made on the same beds.
TEST(TradeStudy, SharesItsBedsWithOtherStepsToo) {
  const auto cases = unfold(parse_study(
      one_scene() + "[[trade]]\nname = \"0.45\"\nsteps.dem = \"8e-5 s\"\nsteps.beyond_limit = true\n", "study.toml"));
  ASSERT_EQ(cases.size(), 4u);
  EXPECT_EQ(cases[2].bed_id, cases[0].bed_id);
  EXPECT_EQ(cases[2].scene.bed.dem_step, 8e-5);
  EXPECT_NE(cases[2].scene.bed.dem_step, cases[0].scene.bed.dem_step);
}

TEST(TradeStudy, RefusesWhatIsNoTrade) {
  EXPECT_TRUE(says(complaint(good_study + two_trades), "grains.diameter: a trade is made around one scene"));
  EXPECT_TRUE(
      says(complaint(one_scene() + "[[trade]]\nrun.cores = 2\n"), "trade: run.cores is nothing that results hang on"));
  EXPECT_TRUE(says(complaint(one_scene() + "[[trade]]\nname = \"x\"\n"), "trade: nothing is changed"));
  EXPECT_TRUE(says(complaint(one_scene() + "[[trade]]\nbox.cell.y = \"1 d\"\n"), "box.cell.y"));
  EXPECT_TRUE(says(complaint(one_scene() + "[[trade]]\nsteps.dem = \"8e-5 s\"\n"), "Rayleigh times"));
}

/// A setting called like another, or like a pair of an error budget, would be taken for it.
TEST(TradeStudy, RefusesNamesThatMeanSomethingElse) {
  for (const char* name : {"finest", "mesh", "twice"}) {
    const std::string setting = std::string("[[trade]]\nname = \"") + name + "\"\n";
    EXPECT_TRUE(says(complaint(one_scene() + setting + "box.cell.z = \"1 d\"\n" +
                               (name == std::string("twice") ? setting + "drive.dwell = \"10 td\"\n" : "")),
                     std::string("trade: ") + name + " is called so already"))
        << name;
  }
  // lists of terms are named by their initials
  EXPECT_TRUE(says(complaint(one_scene() + "[[trade]]\nmodels.terms = [\"drag\", \"shear_lift\"]\n" +
                             "[[trade]]\nmodels.terms = [\"drag\", \"self_disturbance\"]\n"),
                   "is called so already"));
}

class MeasuredTrade : public ::testing::Test {
 protected:
  MeasuredTrade() {
    create_result_tables(database);
    enrol_all();
  }
  void enrol_all() {
    Ledger ledger(database, directory_.path());
    std::vector<CaseEntry> entries;
    for (const Case& one : cases) entries.push_back(case_entry(one));
    ledger.enrol(entries);
    store_variations(database, cases);
  }
  void finish(const Case& one, double lower, double upper, double flux, double height, double core_seconds) {
    database.execute(
        "INSERT INTO scenes VALUES (?,?,?,?,?,5e-4,0.05,2000,1000,2,1e-5,9.81,3.5,1e5,300,244,1,1,1,1,1,2e-4,"
        "'di_felice',1,1,1,0)",
        {one.id, one.label, one.set, one.set_label, static_cast<std::int64_t>(one.seed)});
    database.execute(
        "INSERT INTO thresholds VALUES (?,'flux',0.01,1,'bracketed',?,?,?,'ramp',NULL,NULL,0.58,4.5,NULL,NULL,NULL)",
        {one.id, std::sqrt(lower * upper), lower, upper});
    for (int hold = 0; hold < 2; ++hold)
      database.execute(
          "INSERT INTO ramp_points VALUES "
          "(?,?,0,1,?,?,NULL,NULL,NULL,0,0,0,0,?,?,0,0,0.1,0,?,0.003,NULL,0,0.0005,0.4,5,5,0,'ramp','none')",
          {one.id, std::int64_t{hold}, 0.1 + 0.1 * hold, 0.1 + 0.1 * hold, flux * hold, 0.1 * flux, height * 5e-4});
    database.execute("INSERT INTO attempts VALUES (?,1,'h',1,'t',NULL,'finished','',NULL,NULL,?,'v','c')",
                     {one.id, core_seconds});
    update_threshold_curve(database);
  }
  /// Two packings whose thresholds lie 20 % apart; the coarse mesh moves each by 10 %, short holds by nothing.
  void finish_all() {
    finish(cases[0], 0.100, 0.104, 0.2, 4.0, 100), finish(cases[1], 0.120, 0.1248, 0.3, 4.2, 120);
    finish(cases[2], 0.110, 0.1144, 0.4, 4.0, 50), finish(cases[3], 0.132, 0.13728, 0.6, 4.2, 60);
    finish(cases[4], 0.100, 0.104, 0.2, 3.9, 20), finish(cases[5], 0.120, 0.1248, 0.3, 4.1, 24);
  }

  Study study = trade_study();
  std::vector<Case> cases = unfold(study);

 private:
  TemporaryDirectory directory_;

 protected:
  Database database{directory_.path() / "study.db", Database::Mode::write};
};

TEST_F(MeasuredTrade, ComparesEveryPackingWithItself) {
  finish_all();
  const Trade trade = measured_trade(database, study, cases);
  ASSERT_EQ(trade.settings.size(), 3u);
  const TradeSetting &finest = trade.settings[0], &mesh = trade.settings[1], &brief = trade.settings[2];
  EXPECT_EQ(finest.name, "finest");
  EXPECT_DOUBLE_EQ(finest.core_seconds, 110);
  EXPECT_EQ(finest.theta.worst(), 0);
  EXPECT_NEAR(mesh.theta.mean, 0.1, 1e-12);
  EXPECT_TRUE(mesh.theta.seen());
  // each end of a pair: half a bracket of 4 % over sqrt(3); two ends, two packings, two standard errors
  const double bracket = std::log(1.04) / (2 * std::sqrt(3.0));
  EXPECT_NEAR(mesh.theta.low, 1.1 * std::exp(-2 * bracket) - 1, 1e-12);
  EXPECT_NEAR(mesh.theta.high, 1.1 * std::exp(2 * bracket) - 1, 1e-12);
  EXPECT_NEAR(mesh.flux.mean, 1, 1e-12);
  EXPECT_NEAR(mesh.height.mean, 0, 1e-12);
  EXPECT_NEAR(brief.theta.mean, 0, 1e-12);
  EXPECT_FALSE(brief.theta.seen());
  EXPECT_NEAR(brief.height.mean, -0.1, 1e-12);
  EXPECT_DOUBLE_EQ(brief.core_seconds, 22);
  EXPECT_DOUBLE_EQ(trade.density_ratio, 2);
}

/// Four places in a cell of the one mesh against the same four of the other: mean of the logarithms, Student's t of three degrees of freedom.
TEST_F(MeasuredTrade, KnowsHowWellALoneFallIsKnown) {
  finish_all();
  Trade trade = measured_trade(database, study, cases);
  EXPECT_TRUE(trade_as_table(trade).find("fall\n") == std::string::npos) << "costs time: only where asked for";
  add_lone_falls(trade, cases);
  EXPECT_FALSE(trade_as_table(trade).find("fall\n") == std::string::npos);
  const TradeSetting &finest = trade.settings[0], &mesh = trade.settings[1], &brief = trade.settings[2];
  EXPECT_EQ(brief.fall_speeds, finest.fall_speeds) << "the same mesh and steps";
  EXPECT_EQ(brief.fall.worst(), 0);
  std::array<double, 4> logs;
  for (std::size_t n = 0; n < 4; ++n) logs[n] = std::log(mesh.fall_speeds[n] / finest.fall_speeds[n]);
  const double mean = (logs[0] + logs[1] + logs[2] + logs[3]) / 4;
  double squares = 0;
  for (const double l : logs) squares += (l - mean) * (l - mean);
  EXPECT_NE(mean, 0);
  EXPECT_NEAR(mesh.fall.mean, std::expm1(mean), 1e-12);
  EXPECT_NEAR(mesh.fall.high, std::expm1(mean + 3.182 * std::sqrt(squares / 3 / 4)), 1e-12);
}

TEST_F(MeasuredTrade, MarksWhatNoneBeatsInCostAndError) {
  finish_all();
  const Trade trade = measured_trade(database, study, cases);
  EXPECT_TRUE(trade.settings[0].frontier);
  EXPECT_FALSE(trade.settings[1].frontier) << "dearer and worse than short holds";
  EXPECT_TRUE(trade.settings[2].frontier);
  EXPECT_NE(trade_as_table(trade).find("* short"), std::string::npos) << trade_as_table(trade);
}

/// Two packings alone say hardly anything of how far they scatter: Student's t of one degree is 12.7.
TEST_F(MeasuredTrade, KnowsNoDifferenceBetterThanPackingsAgreeOnIt) {
  finish_all();
  database.execute(
      "UPDATE thresholds SET shields = shields*1.2, shields_lower = shields_lower*1.2, shields_upper = "
      "shields_upper*1.2 WHERE case_id = ?",
      {cases[3].id});
  const TradeSetting mesh = measured_trade(database, study, cases).settings[1];
  const double standard_error = std::log(1.2) / 2;   // of the mean of two that lie ln 1.2 apart, one degree of freedom
  EXPECT_NEAR(mesh.theta.mean, 1.1 * std::sqrt(1.2) - 1, 1e-12);
  EXPECT_NEAR(std::log(mesh.theta.high / mesh.theta.mean + 1 / mesh.theta.mean),
              std::log(1 + 1 / mesh.theta.mean) + 12.706 * standard_error, 1e-9);
  EXPECT_FALSE(mesh.theta.seen());
}

/// Beds that a setting pours for itself differ from packing to packing; what begins on the same beds is known better.
TEST_F(MeasuredTrade, LetsOtherBedsBlurNothingThatBeginsOnTheSame) {
  study = parse_study(one_scene() + two_trades + "[[trade]]\nname = \"rough\"\ngrains.friction = 0.8\n", "study.toml");
  cases = unfold(study);
  ASSERT_NE(cases[6].bed_id, cases[0].bed_id);
  enrol_all();
  finish_all();
  finish(cases[6], 0.100, 0.104, 0.2, 3.0, 20), finish(cases[7], 0.120, 0.1248, 0.3, 4.9, 24);   // -1 d, +0.7 d
  const Trade trade = measured_trade(database, study, cases);
  EXPECT_TRUE(trade.settings[2].height.seen());
  EXPECT_NEAR(trade.settings[2].height.low, -0.1, 1e-9);
  EXPECT_FALSE(trade.settings[3].height.seen());
  EXPECT_NEAR(trade.settings[3].height.high, -0.15 + 12.706 * 0.85, 1e-9);   // -1 and 0.7: their mean, its error
}

/// Two packings of one setting may agree by chance: other beds are never taken to scatter less than the same ones.
TEST_F(MeasuredTrade, TakesNoAgreementOfOtherBedsByChanceForKnowledge) {
  study = parse_study(one_scene() + two_trades + "[[trade]]\nname = \"rough\"\ngrains.friction = 0.8\n", "study.toml");
  cases = unfold(study);
  enrol_all();
  finish_all();
  finish(cases[6], 0.102, 0.10608, 0.2, 4.0, 20), finish(cases[7], 0.1224, 0.127296, 0.3, 4.2, 24);   // both +2 %
  EXPECT_LT(measured_trade(database, study, cases).settings[3].theta.worst(), 0.06);
  database.execute("UPDATE thresholds SET shields = shields*1.5 WHERE case_id = ?", {cases[3].id});
  EXPECT_GT(measured_trade(database, study, cases).settings[3].theta.worst(), 0.5);
}

/// What moves a hundred times more in one packing alone says nothing of a setting that halves the flux in both.
TEST_F(MeasuredTrade, LetsNoOutburstOfOneSettingBlurTheFluxOfAnother) {
  finish_all();
  database.execute("UPDATE ramp_points SET event_flux = event_flux/4 WHERE case_id IN (?, ?)",
                   {cases[2].id, cases[3].id});   // twice the finest's, now half of it
  database.execute("UPDATE ramp_points SET event_flux = event_flux*100 WHERE case_id = ?", {cases[4].id});
  const Trade trade = measured_trade(database, study, cases);
  EXPECT_NEAR(trade.settings[1].flux.mean, -0.5, 1e-12);
  EXPECT_GT(trade.settings[2].flux.mean, 1);
  EXPECT_EQ(trade_as_table(trade).find("e+"), std::string::npos) << trade_as_table(trade);
}

TEST(SymmetricDifference, IsARatioAgainAndSeenWhereItWas) {
  const auto ratio_of = [](double base, double other, double half) {
    const double s = symmetric_difference(base, 0, other, 0).difference;
    return relative_of_symmetric({s, s - half, s + half});
  };
  EXPECT_NEAR(ratio_of(2, 3, 0).mean, 0.5, 1e-15);
  EXPECT_NEAR(ratio_of(2, 0, 0).mean, -1, 1e-15);
  for (const double other : {0.0, 0.1, 1.9, 2.1, 30.0})
    for (const double half : {0.01, 0.1, 1.0}) {
      const double s = symmetric_difference(2, 0, other, 0).difference;
      EXPECT_EQ(ratio_of(2, other, half).seen(), std::abs(s) > half) << other << ' ' << half;
    }
  // small errors pass on linearly: 2 +- 0.02 and 3 +- 0.03 are a ratio of 1.5 +- 0.0212
  const auto small = symmetric_difference(2, 0.02, 3, 0.03);
  const auto ratio =
      relative_of_symmetric({small.difference, small.difference - small.error, small.difference + small.error});
  EXPECT_NEAR((ratio.high - ratio.low) / 2, 1.5 * std::hypot(0.01, 0.01), 1e-3);
}

/// Two changes, three packings; the packings shift both alike (the base's own scatter), which is no scatter of the changes.
TEST(Scatter, IsWhatIsLeftWithoutTheMeansOfChangesAndPackings) {
  const auto row = [](double a, double b, double c) { return Differences{{a, 0, "1"}, {b, 0, "2"}, {c, 0, "3"}}; };
  EXPECT_NEAR(scatter_of({row(1, 3, 8), row(2, 4, 9)}).deviation, 0, 1e-12);
  // residuals +-0.5, 0, -+0.5: the sum of their squares is 1, with (2 - 1)(3 - 1) degrees
  const Scatter two = scatter_of({row(1.5, 3, 7.5), row(0.5, 3, 8.5)});
  EXPECT_EQ(two.freedom, 2);
  EXPECT_NEAR(two.deviation, std::sqrt(0.5), 1e-12);
  // one alone: differences 0, 1, 2 have the variance 1, half of which is that of one side
  const Scatter one = scatter_of({row(0, 1, 2)});
  EXPECT_EQ(one.freedom, 2);
  EXPECT_NEAR(one.deviation, std::sqrt(0.5), 1e-12);
  // what lacks a packing, or changes nothing, says nothing of it
  EXPECT_EQ(scatter_of({row(0, 1, 2), {{5, 0, "1"}}, row(0, 0, 0)}).deviation, one.deviation);
  EXPECT_EQ(scatter_of({{{1, 0, "1"}}}).freedom, 0);
}

TEST(Scatter, OfOnePackingIsNotKnown) {
  const PairedDifference lone = paired({{0.3, 0.01, "1"}}, scatter_of({{{0.3, 0.01, "1"}}}));
  EXPECT_EQ(lone.mean, 0.3);
  EXPECT_FALSE(lone.known());
  EXPECT_FALSE(lone.seen());
  EXPECT_TRUE(std::isnan(lone.worst()));
}

/// Of the textbooks' tables.
TEST(Scatter, WeighsFewDegreesByStudent) {
  for (const auto& [freedom, t] :
       {std::pair{1, 12.706}, {2, 4.303}, {10, 2.228}, {11, 2.201}, {20, 2.086}, {120, 1.980}})
    EXPECT_NEAR(student_95(freedom), t, 0.002) << freedom;
}

TEST_F(MeasuredTrade, LeavesOutWhatHasNotRun) {
  finish(cases[0], 0.100, 0.104, 0.2, 4.0, 100);
  finish(cases[4], 0.100, 0.104, 0.2, 4.0, 20);
  const Trade trade = measured_trade(database, study, cases);
  EXPECT_EQ(trade.settings[1].packings, 0u);
  EXPECT_FALSE(trade.settings[1].frontier);
  EXPECT_NE(trade_as_table(trade).find("hz1d    no result"), std::string::npos) << trade_as_table(trade);
}

TEST_F(MeasuredTrade, NeedsTheFinest) {
  EXPECT_THROW(measured_trade(database, study, cases), Error);
  EXPECT_THROW(measured_trade(database, parse_study(one_scene(), "study.toml"), cases), Error);
}

/// A study that asks for an accuracy, and the trade that it finds.
class Accuracy : public MeasuredTrade {
 protected:
  Accuracy() {
    finish_all();
    json = trade_as_json(measured_trade(database, study, cases));
  }
  std::string words(const std::string& text) {
    const Study asked = parse_study(text, "other.toml");
    Problems problems("other.toml");
    const auto chosen = chosen_accuracy(
        asked, [this](const std::filesystem::path&) { return json; }, problems);
    problems.throw_if_any();
    return chosen->in_words();
  }
  std::vector<Case> unfolded(const std::string& text) const {
    return unfold(parse_study(text, "other.toml"), [this](const std::filesystem::path&) { return json; });
  }
  static std::string asking(const std::string& target) {
    return with(with(one_scene(), "dwell = \"25 td\"", ""), "[drive]",
                "[models]\naccuracy = { target = \"" + target + "\", from = \"trade.json\" }\n[drive]");
  }
  std::string json;
};

TEST_F(Accuracy, TakesTheCheapestSettingThatIsGoodEnough) {
  const auto good = unfolded(asking("5 %"));
  EXPECT_DOUBLE_EQ(good[0].scene.drive.dwell, 10 / 25. * cases[0].scene.drive.dwell);
  EXPECT_EQ(good[0].scene.grid.cells[2], cases[0].scene.grid.cells[2]);
  EXPECT_DOUBLE_EQ(good[0].pace, 22 / predicted_cost(cases[4].scene).core_seconds);
  EXPECT_DOUBLE_EQ(predicted_cost(good[0]).core_seconds, 22);
}

TEST_F(Accuracy, TakesTheFinestWhereNoneIs) {
  const auto best = unfolded(asking("1 %"));
  EXPECT_EQ(best[0].scene.drive.dwell, cases[0].scene.drive.dwell);
}

TEST_F(Accuracy, IsNoPartOfIdentity) {
  EXPECT_EQ(unfolded(asking("5 %"))[0].id, unfolded(with(one_scene(), "25 td", "10 td"))[0].id);
}

std::string why(const std::function<void()>& act) {
  try {
    act();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST_F(Accuracy, RefusesASceneFarFromTheTrades) {
  EXPECT_TRUE(says(why([&] { unfolded(with(asking("5 %"), "1.0e-5 m2/s", "4.0e-5 m2/s")); }), "the Galileo number"));
  EXPECT_TRUE(says(why([&] { unfolded(with(asking("5 %"), "2000 kg/m3", "8000 kg/m3")); }), "factor 3"));
  EXPECT_TRUE(says(why([&] { unfolded(with(asking("5 %"), "from = 0.06", "from = 0.9")); }), "every Shields number"));
}

/// The trade's json with the cheap setting on another rung.
class AccuracyOfRungs : public Accuracy {
 protected:
  void short_holds_on(const std::string& rung) {
    auto trade = nlohmann::json::parse(json);
    trade["finest"]["models.fluid"] = "\"auto\"";
    trade["settings"][2]["changes"]["models.fluid"] = "\"" + rung + "\"";
    json = trade.dump();
  }
};

TEST_F(AccuracyOfRungs, TakesAColumnWhereItCanBeTheMeanOfTheFlow) {
  short_holds_on("column");
  EXPECT_EQ(unfolded(asking("5 %"))[0].scene.fluid, FluidRung::column);
  EXPECT_EQ(unfolded(with(asking("5 %"), "[models]", "[models]\nfluid = \"auto\""))[0].scene.fluid, FluidRung::column);
  EXPECT_TRUE(says(words(asking("5 %")), "a column, as x and y are periodic and the bed is level"));
  EXPECT_EQ(unfolded(asking("1 %"))[0].scene.fluid, FluidRung::box) << "not good enough";
}

TEST_F(AccuracyOfRungs, TakesTheBoxBesideWallsAndOnSlopes) {
  short_holds_on("column");
  for (const char* uneven :
       {"[box]\ny = \"wall\"", "[box]\nslope = \"3 deg\"", "[box]\nslope = [\"0 deg\", \"3 deg\"]"}) {
    const auto text = with(asking("5 %"), "[box]", uneven);
    for (const auto& one : unfolded(text)) EXPECT_EQ(one.scene.fluid, FluidRung::box) << uneven;
    EXPECT_TRUE(says(words(text), "short (models.fluid = column) costs less and is passed over: box.")) << words(text);
  }
}

TEST_F(AccuracyOfRungs, NeverTakesAProfileByItself) {
  short_holds_on("profile");
  EXPECT_EQ(unfolded(asking("5 %"))[0].scene.fluid, FluidRung::box);
  EXPECT_TRUE(says(words(asking("5 %")), "an imposed profile does not answer to grains"));
  EXPECT_EQ(unfolded(with(asking("5 %"), "[models]", "[models]\nfluid = \"profile\""))[0].scene.fluid,
            FluidRung::profile);
}

TEST_F(AccuracyOfRungs, WantsTheBoxAsMeasure) {
  auto trade = nlohmann::json::parse(json);
  trade["finest"]["models.fluid"] = "\"column\"";
  json = trade.dump();
  EXPECT_TRUE(says(why([&] { unfolded(asking("5 %")); }), "its finest is a column: nothing measures it against a box"));
  EXPECT_EQ(unfolded(with(asking("5 %"), "[models]", "[models]\nfluid = \"column\""))[0].scene.fluid,
            FluidRung::column);
}

/// A setting that is good in one packing and finds nothing in the other is not good; nor is one that is another scene.
TEST_F(Accuracy, TakesNothingThatFailedInAPackingOrIsAnotherScene) {
  auto trade = nlohmann::json::parse(json);
  trade["settings"][2]["thresholds"] = 1;
  json = trade.dump();
  EXPECT_EQ(unfolded(asking("5 %"))[0].scene.drive.dwell, cases[0].scene.drive.dwell);
  trade["settings"][2]["thresholds"] = 2, trade["settings"][2]["changes"]["bed.count"] = "900";
  json = trade.dump();
  EXPECT_EQ(unfolded(asking("5 %"))[0].scene.drive.dwell, cases[0].scene.drive.dwell);
}

/// What decides is how far off it may be, not how far it seems to be.
TEST_F(Accuracy, ReckonsWithTheFartherBound) {
  auto trade = nlohmann::json::parse(json);
  trade["settings"][2]["theta"] = {{"difference", 0.04}, {"low", 0.01}, {"high", 0.07}, {"seen", true}};
  json = trade.dump();
  EXPECT_EQ(unfolded(asking("5 %"))[0].scene.drive.dwell, cases[0].scene.drive.dwell);
  EXPECT_NE(unfolded(asking("8 %"))[0].scene.drive.dwell, cases[0].scene.drive.dwell);
}

TEST_F(Accuracy, TakesStepsInSecondsForGrainsOfOneSizeAlone) {
  auto trade = nlohmann::json::parse(json);
  trade["settings"][2]["changes"]["steps.dem"] = "\"1e-5 s\"";
  json = trade.dump();
  EXPECT_NO_THROW(unfolded(asking("5 %")));
  const auto other = with(asking("5 %"), "diameter = \"0.5 mm\"", "diameter = \"0.6 mm\"");
  EXPECT_TRUE(says(why([&] { unfolded(other); }), "steps.dem = 1e-5 s is a value for grains of 0.5 mm"));
}

/// Pairs of an error budget are made of what accuracy has chosen.
TEST_F(Accuracy, StandsBesideAnErrorBudget) {
  const auto all = unfolded(
      with(with(asking("5 %"), "[models]", "[onset]\nmethod = \"bisect\"\nbudget = [\"mesh\", \"area\"]\n[models]"),
           "from = 0.06", "from = 0.06"));
  const auto mesh = std::ranges::find(all, "mesh", &Case::variation),
             area = std::ranges::find(all, "area", &Case::variation);
  ASSERT_NE(mesh, all.end());
  EXPECT_EQ(2 * mesh->scene.grid.cells[2], all[0].scene.grid.cells[2]);
  ASSERT_NE(area, all.end());
  EXPECT_EQ(area->scene.bed.source.count, 4 * all[0].scene.bed.source.count);
  EXPECT_DOUBLE_EQ(area->scene.bed.length.x, 2 * all[0].scene.bed.length.x);
}

TEST_F(Accuracy, SaysThatATradeIsOfAnotherPhysicsVersion) {
  EXPECT_FALSE(says(words(asking("5 %")), "physics_version"));
  auto trade = nlohmann::json::parse(json);
  trade["physics_version"] = physics_version - 1;
  json = trade.dump();
  EXPECT_TRUE(says(words(asking("5 %")), fmt::format("It was measured under physics_version {}; this bedload's is {}",
                                                     physics_version - 1, physics_version)));
}

TEST_F(Accuracy, ReadsNoTradeOfAnotherFormat) {
  auto trade = nlohmann::json::parse(json);
  trade["format"] = 1;
  json = trade.dump();
  EXPECT_TRUE(says(why([&] { unfolded(asking("5 %")); }), "has format 1; this bedload reads 3"));
}

TEST_F(Accuracy, RefusesAValueBesideItsOwn) {
  EXPECT_TRUE(says(why([&] { unfolded(with(asking("5 %"), "kind = \"lid\"", "kind = \"lid\"\ndwell = \"30 td\"")); }),
                   "drive.dwell: 30 td stands beside models.accuracy, which chooses it"));
  json = "{}";
  EXPECT_TRUE(says(why([&] { unfolded(asking("5 %")); }), "is not a trade"));
}

}   // namespace
}   // namespace bedload

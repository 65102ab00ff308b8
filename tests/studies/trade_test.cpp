// What settings change and cost, from pairs of cases on the same packings; and the choice by a wanted accuracy.
#include "studies/trade.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "scheduler/ledger.hpp"
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
  EXPECT_EQ(finest.theta.size(), 0);
  EXPECT_NEAR(mesh.theta.mean, 0.1, 1e-12);
  EXPECT_TRUE(mesh.theta.seen());
  // each end of a pair: half a bracket of 4 % over sqrt(3); two ends, two packings, two standard errors
  const double bracket = std::log(1.04) / (2 * std::sqrt(3.0));
  EXPECT_NEAR(mesh.theta.uncertainty, 1.1 * 2 * std::sqrt(2.0) * bracket / std::sqrt(2.0), 1e-12);
  EXPECT_EQ(brief.fall_speed, finest.fall_speed) << "the same mesh and steps";
  EXPECT_NE(mesh.fall_speed, finest.fall_speed);
  EXPECT_NEAR(mesh.flux.mean, 1, 1e-12);
  EXPECT_NEAR(mesh.height.mean, 0, 1e-12);
  EXPECT_NEAR(brief.theta.mean, 0, 1e-12);
  EXPECT_FALSE(brief.theta.seen());
  EXPECT_NEAR(brief.height.mean, -0.1, 1e-12);
  EXPECT_DOUBLE_EQ(brief.core_seconds, 22);
  EXPECT_DOUBLE_EQ(trade.density_ratio, 2);
}

TEST_F(MeasuredTrade, MarksWhatNoneBeatsInCostAndError) {
  finish_all();
  const Trade trade = measured_trade(database, study, cases);
  EXPECT_TRUE(trade.settings[0].frontier);
  EXPECT_FALSE(trade.settings[1].frontier) << "dearer and worse than short holds";
  EXPECT_TRUE(trade.settings[2].frontier);
  EXPECT_NE(trade_as_table(trade).find("* short"), std::string::npos) << trade_as_table(trade);
}

/// The deviation from packing to packing is that of all settings: of two packings alone it is hardly known.
TEST_F(MeasuredTrade, KnowsNoDifferenceBetterThanPackingsAgreeOnIt) {
  finish_all();
  database.execute(
      "UPDATE thresholds SET shields = shields*1.2, shields_lower = shields_lower*1.2, shields_upper = "
      "shields_upper*1.2 WHERE case_id = ?",
      {cases[3].id});
  const TradeSetting mesh = measured_trade(database, study, cases).settings[1];
  const double pooled = std::log(1.2) / 2 * std::sqrt(2.0) / std::sqrt(2.0);   // two squares of half of it, two degrees
  const double bracket = std::log(1.04) / std::sqrt(6.0);
  EXPECT_NEAR(mesh.theta.mean, 1.1 * std::sqrt(1.2) - 1, 1e-12);
  EXPECT_NEAR(mesh.theta.uncertainty, 1.1 * std::sqrt(1.2) * 2 * std::hypot(pooled, bracket) / std::sqrt(2.0), 1e-12);
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
  EXPECT_LT(trade.settings[2].height.uncertainty, 1e-9);
  EXPECT_FALSE(trade.settings[3].height.seen());
  EXPECT_NEAR(trade.settings[3].height.uncertainty, 1.7, 1e-9);   // 2 * (1.7/sqrt(2))/sqrt(2)
}

/// Two packings of one setting may agree by chance: other beds are never taken to scatter less than the same ones.
TEST_F(MeasuredTrade, TakesNoAgreementOfOtherBedsByChanceForKnowledge) {
  study = parse_study(one_scene() + two_trades + "[[trade]]\nname = \"rough\"\ngrains.friction = 0.8\n", "study.toml");
  cases = unfold(study);
  enrol_all();
  finish_all();
  finish(cases[6], 0.102, 0.10608, 0.2, 4.0, 20), finish(cases[7], 0.1224, 0.127296, 0.3, 4.2, 24);   // both +2 %
  EXPECT_LT(measured_trade(database, study, cases).settings[3].theta.uncertainty, 0.04);
  database.execute("UPDATE thresholds SET shields = shields*1.5 WHERE case_id = ?", {cases[3].id});
  EXPECT_GT(measured_trade(database, study, cases).settings[3].theta.uncertainty, 0.2);
}

/// What moves a hundred times more in one packing alone says nothing of a setting that halves the flux in both.
TEST_F(MeasuredTrade, LetsNoOutburstOfOneSettingBlurTheFluxOfAnother) {
  finish_all();
  database.execute("UPDATE ramp_points SET event_flux = event_flux/4 WHERE case_id IN (?, ?)",
                   {cases[2].id, cases[3].id});   // twice the finest's, now half of it
  database.execute("UPDATE ramp_points SET event_flux = event_flux*100 WHERE case_id = ?", {cases[4].id});
  const Trade trade = measured_trade(database, study, cases);
  EXPECT_NEAR(trade.settings[1].flux.mean, -0.5, 1e-12);
  EXPECT_LT(trade.settings[1].flux.uncertainty, 2);
  EXPECT_GT(trade.settings[2].flux.mean, 1);
  EXPECT_EQ(trade_as_table(trade).find("e+"), std::string::npos) << trade_as_table(trade);
}

TEST(SymmetricDifference, IsARatioAgainAndSeenWhereItWas) {
  const auto ratio_of = [](double base, double other, double uncertainty) {
    return relative_of_symmetric({symmetric_difference(base, 0, other, 0).difference, uncertainty});
  };
  EXPECT_NEAR(ratio_of(2, 3, 0).mean, 0.5, 1e-15);
  EXPECT_NEAR(ratio_of(2, 0, 0).mean, -1, 1e-15);
  for (const double other : {0.0, 0.1, 1.9, 2.1, 30.0})
    for (const double uncertainty : {0.01, 0.1, 1.0}) {
      const double s = symmetric_difference(2, 0, other, 0).difference;
      EXPECT_EQ(ratio_of(2, other, uncertainty).seen(), std::abs(s) > uncertainty) << other << ' ' << uncertainty;
    }
  // small errors pass on linearly: 2 +- 0.02 and 3 +- 0.03 are a ratio of 1.5 +- 0.0212
  const auto small = symmetric_difference(2, 0.02, 3, 0.03);
  EXPECT_NEAR(relative_of_symmetric({small.difference, small.error}).uncertainty, 1.5 * std::hypot(0.01, 0.01), 1e-3);
}

TEST_F(MeasuredTrade, LeavesOutWhatHasNotRun) {
  finish(cases[0], 0.100, 0.104, 0.2, 4.0, 100);
  finish(cases[4], 0.100, 0.104, 0.2, 4.0, 20);
  const Trade trade = measured_trade(database, study, cases);
  EXPECT_EQ(trade.settings[1].packings, 0u);
  EXPECT_FALSE(trade.settings[1].frontier);
  EXPECT_NE(trade_as_table(trade).find("hz1d    not run yet"), std::string::npos) << trade_as_table(trade);
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
  std::string words(const std::string& text) {
    const Study asked = parse_study(text, "other.toml");
    Problems problems("other.toml");
    const auto chosen = chosen_accuracy(
        asked, [this](const std::filesystem::path&) { return json; }, problems);
    problems.throw_if_any();
    return chosen->in_words();
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
  EXPECT_TRUE(says(why([&] { unfolded(asking("5 %")); }), "is a column: nothing measures it against a box"));
  EXPECT_EQ(unfolded(with(asking("5 %"), "[models]", "[models]\nfluid = \"column\""))[0].scene.fluid,
            FluidRung::column);
}

TEST_F(Accuracy, RefusesAValueBesideItsOwn) {
  EXPECT_TRUE(says(why([&] { unfolded(with(asking("5 %"), "kind = \"lid\"", "kind = \"lid\"\ndwell = \"30 td\"")); }),
                   "drive.dwell: 30 td stands beside models.accuracy, which chooses it"));
  json = "{}";
  EXPECT_TRUE(says(why([&] { unfolded(asking("5 %")); }), "is not a trade"));
}

}   // namespace
}   // namespace bedload

// A final state becomes rows: all of them, once, and the numbers derived from them.
#include "studies/results.hpp"
#include "solver/bed/onset_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>

#include "scheduler/ledger.hpp"
#include "solver/bed/incipient_motion.hpp"
#include "solver/coupling/drag_laws.hpp"
#include "studies/database_values.hpp"
#include "studies/threshold_curve.hpp"
#include "tests/support/temporary_directory.hpp"

namespace bedload {
namespace {

Scene small_scene() {
  Scene scene;
  scene.bed.fluid = {1000, 1e-5};
  scene.bed.grains.diameter = 0.5e-3;
  scene.bed.grains.density = 2000;
  scene.bed.gravity = {0, 0, -9.81};
  scene.bed.length = {10e-3, 6e-3, 6.5e-3};
  scene.bed.sides = {Side::periodic, Side::periodic, Side::wall};
  scene.grid = {.cells = {10, 6, 26}, .h = {1e-3, 1e-3, 0.25e-3}, .sides = scene.bed.sides};
  scene.drive = {FlowRamp::Kind::lid, FlowRamp::Quantity::shields, {0.1, 0.2, 0.3}, 1};
  return scene;
}

/// With a bed, and cells too high for it.
Scene coarse_scene() {
  Scene scene = small_scene();
  scene.bed.source = {.kind = BedSource::Kind::poured, .count = 300, .csv = {}};
  scene.grid.h.z = 1.25e-3, scene.grid.cells[2] = 5;   // 2.5 d
  return scene;
}

/// Two still holds, then motion at theta 0.3 that the fourth confirms.
State finished_state() {
  State state;
  state.grains.resize(3);
  for (int k = 0; k < 4; ++k) {
    auto& h = state.record.holds;
    for (auto* column : {&h.start, &h.end, &h.shields_nominal, &h.lid_speed, &h.gradient, &h.flux_standard_error,
                         &h.moving_fraction, &h.moved_grains, &h.bed_height, &h.bed_top, &h.slope,
                         &h.bearing_coordination, &h.roughness, &h.porosity, &h.coordination})
      column->push_back(k);
    for (auto* column : {&h.purpose, &h.level, &h.verdict}) column->push_back(0);   // of a ramp
    h.hold.push_back(k);
    h.shields_measured.push_back(0.1 * (k + 1));
    h.flux.push_back(k < 2 ? 1e-4 : 0.1);
    h.momentum_residual.push_back(k == 0 ? -1 : 1e-9);
    h.shields_lid.push_back(k == 0 ? 0 : 0.1 * (k + 1) * (1 + 0.008 * k));   // further off from hold to hold
    h.stress_residual.push_back(k == 0 ? -1 : 0.008 * k);
  }
  state.record.settled = {.solid_fraction = 0.58, .coordination = 4.5, .shear_flux = 2e-3};
  auto& s = state.record.samples;
  for (int n = 1; n <= 10; ++n) {   // 3 + 0.2 n [s]: 60 moving grains of 244.46 die away within 0.5 s
    for (auto* column : {&s.shields_nominal, &s.shields_measured, &s.flux, &s.moved_grains, &s.bed_height, &s.roughness,
                         &s.coordination, &s.moving_speed, &s.deepest_overlap, &s.momentum_residual})
      column->push_back(n);
    s.time.push_back(3 + 0.2 * n);
    s.hold.push_back(3);
    const double mean =
        (std::exp(-0.2 * (n - 1) / 0.5) - std::exp(-0.2 * n / 0.5)) / (0.2 / 0.5);   // since the one before
    s.moving_fraction.push_back(60 * mean / surface_grains(small_scene()));
  }
  state.clock.retries = 3;
  state.record.health.hold = {0};
  double measure = 100;
  BedRecord::Health::Measures::each(state.record.health.measures,
                                    [&](auto&&, auto& column, auto&&) { column = {measure++}; });
  state.record.hops = {{3}, {0.5}, {12}, {10}, {8}, {1e-3}, {2e-4}, {0.1}, {0.02}, {1}, {0.3}, {0}};
  auto& bins = state.record.hop_histograms;
  for (std::size_t bin = 0; bin < Spread::bins; ++bin) {   // lengths in [2, 4) d, durations beyond the last bin
    bins.hold.push_back(3);
    bins.lower.push_back(Spread::lower_edge(bin));
    bins.by_length.push_back(bin == 7 ? 8 : 0), bins.by_duration.push_back(bin == 15 ? 8 : 0);
    bins.rests.push_back(bin == 8);
  }
  auto& p = state.record.profiles;
  p = {{-1, -1}, {1e-4, 2e-4}, {0.4, 0.5}, {0, 0}, {0, 0}, {0, 0}};
  for (const double hold : {1, 2, 3})   // above the upper face two thirds of the weight and a third of the shear
    for (const double z : {1e-4, 2e-4, 3e-4}) {
      p.hold.push_back(hold), p.z.push_back(z), p.porosity.push_back(z > 2.5e-4 ? 0.6 : 0.8);
      p.grain_velocity.push_back(z > 2.5e-4 ? 4 : z > 1.5e-4 ? 3 : 0);
      p.fluid_velocity.push_back(0), p.granular_temperature.push_back(0);
    }
  state.record.tracks = {{0.1}, {7}, {1}, {2}, {3}, {4}, {5}, {6}, {7}, {8}, {9}};
  return state;
}

class ResultsTest : public ::testing::Test {
 protected:
  ResultsTest() { create_result_tables(database_); }
  void store() {
    store_results(database_, {"id1", "d0.5mm-s1", "set1", "d0.5mm", 1}, small_scene(), finished_state(),
                  {"0.1", "g++", "-O2", "hdf5", "host"});
  }
  double number(const std::string& sql) const { return number_in(database_.query(sql).rows.at(0).at(0)); }

  TemporaryDirectory directory_;
  Database database_{directory_.path() / "study.db", Database::Mode::write};
};

TEST_F(ResultsTest, AreTheSameRowsHoweverOftenTheyAreStored) {
  store();
  const auto before = database_.query("SELECT * FROM ramp_points").rows;
  store();
  EXPECT_EQ(database_.query("SELECT * FROM ramp_points").rows, before);
  EXPECT_EQ(number("SELECT count(*) FROM scenes"), 1);
  EXPECT_EQ(number("SELECT count(*) FROM bed_statistics"), 2 + 9);
  EXPECT_EQ(number("SELECT count(*) FROM tracks WHERE grain = 7 AND vz_m_per_s = 6"), 1);
}

TEST_F(ResultsTest, TurnTheShieldsNumberIntoShearVelocityAndReynoldsNumber) {
  store();
  const double tau = 0.2 * 1000 * 9.81 * 0.5e-3, u = std::sqrt(tau / 1000);   // u* = sqrt(tau_b/rho_f)
  EXPECT_NEAR(number("SELECT shear_velocity_m_per_s FROM ramp_points WHERE hold = 1"), u, 1e-12);
  EXPECT_NEAR(number("SELECT friction_reynolds FROM ramp_points WHERE hold = 1"), u * 0.5e-3 / 1e-5, 1e-9);
}

TEST_F(ResultsTest, TurnEventsIntoTheVolumeFluxOfGrains) {
  // All N_s surface grains at speed v make v/(d/2) events per second each, and carry q = (N_s/A) V_p v.
  store();
  const double d = 0.5e-3, event_flux = 0.1;
  const double td = grain_time(d, 2, 9.81, terminal_speed(DragLawName::di_felice, 1e-5, 2, d, 9.81));
  const double v = event_flux * d / 2 / td, q = 0.8 / (std::numbers::pi / 4 * d * d) * sphere_volume(d) * v;
  EXPECT_NEAR(number("SELECT transport FROM ramp_points WHERE hold = 2"), q / std::sqrt(9.81 * d * d * d), 1e-12);
}

TEST_F(ResultsTest, HoldTheThresholdOfEveryCriterionAndMarkTheOneThatDecides) {
  store();
  EXPECT_EQ(number("SELECT count(*) FROM thresholds WHERE criterion = 'flux'"), 2);
  EXPECT_EQ(number("SELECT count(*) FROM thresholds WHERE decides AND value = 0.01 AND status = 'bracketed'"), 1);
  EXPECT_EQ(number("SELECT shields_upper FROM thresholds WHERE decides"), 0.1 * 3);
  EXPECT_EQ(threshold_curve(database_).size(), 1u);
}

TEST_F(ResultsTest, HoldTheBedOfEveryThresholdAndItsHistory) {
  store();
  for (const char* sql : {"SELECT count(*) FROM thresholds WHERE bed_solid_fraction = 0.58 AND bed_coordination = 4.5",
                          "SELECT count(*) FROM thresholds WHERE shear_shields IS NULL AND shear_s IS NULL AND "
                          "shear_flux IS NULL"})
    EXPECT_EQ(number(sql), number("SELECT count(*) FROM thresholds")) << sql;
  Scene sheared = small_scene();
  sheared.shear = {.shields = 0.05, .time = 3};
  store_results(database_, {"id2", "d0.5mm-s2", "set1", "d0.5mm", 2}, sheared, finished_state(), {});
  EXPECT_EQ(number("SELECT count(*) FROM thresholds WHERE case_id = 'id2' AND shear_shields = 0.05 AND shear_s = 3 AND "
                   "shear_flux = 2e-3"),
            number("SELECT count(*) FROM thresholds WHERE case_id = 'id2'"));
}

TEST_F(ResultsTest, HoldTheShieldsNumbersAtWhichGrainsHadMoved) {
  // Holds of 0, 1, 2 and 3 moved grains at theta 0.1 to 0.4, of N_s = 0.8 x 20 x 12/(pi/4) = 244.5.
  store();
  EXPECT_EQ(number("SELECT shields_lower FROM thresholds WHERE criterion = 'moved_grains'"), 0.1 * 1);
  EXPECT_EQ(number("SELECT shields_upper FROM thresholds WHERE criterion = 'moved_grains'"), 0.1 * 2);
  EXPECT_EQ(number("SELECT shields_upper FROM thresholds WHERE criterion = 'moved_fraction' AND value = 0.01"),
            0.1 * 4);
  EXPECT_EQ(number("SELECT count(*) FROM thresholds WHERE criterion = 'moved_fraction' AND value = 0.1 AND status = "
                   "'censored_above' AND shields IS NULL AND shields_lower = 0.4"),
            1);
}

TEST_F(ResultsTest, CountMovedGrainsOnTheStairsOfASearchToo) {
  State state = finished_state();   // stairs at 0.1 and 0.2, holds from the settled bed at 0.3 and, going on, 0.4
  state.record.holds.purpose = {1, 1, 2, 2};
  ASSERT_EQ(HoldPurpose(1), HoldPurpose::staircase);
  ASSERT_EQ(HoldPurpose(2), HoldPurpose::onset);
  state.record.holds.level = {0.1, 0.2, 0.3, 0.3};
  Scene scene = small_scene();
  scene.onset.method = Onset::Method::bisect;
  store_results(database_, {"id2", "d0.5mm-s2", "set1", "d0.5mm", 2}, scene, state, {});
  const auto of = [&](const std::string& what) { return number("SELECT " + what + " AND case_id = 'id2'"); };
  EXPECT_EQ(of("shields_lower FROM thresholds WHERE criterion = 'moved_grains'"), 0.1 * 1);
  EXPECT_EQ(of("shields_upper FROM thresholds WHERE criterion = 'moved_grains'"), 0.1 * 2);
  EXPECT_EQ(of("count(*) FROM thresholds WHERE criterion = 'moved_fraction' AND value = 0.01 AND status = "
               "'censored_above' AND shields_lower = 0.1 * 3"),
            1)
      << "three grains of 244 moved in what went on alone";
}

TEST_F(ResultsTest, HoldTheShieldsNumberOfTheReferenceTransport) {
  store();
  const auto w = [&](int hold) {
    return number("SELECT transport / (shields * sqrt(shields)) FROM ramp_points WHERE hold = " + std::to_string(hold));
  };
  ASSERT_LT(w(1), 0.002);
  ASSERT_GT(w(2), 0.002);
  const double from = std::log(std::max(w(1), 2e-5)), part = (std::log(0.002) - from) / (std::log(w(2)) - from);
  EXPECT_NEAR(number("SELECT shields FROM thresholds WHERE criterion = 'reference_transport'"), 0.2 + 0.1 * part, 1e-9);
}

TEST_F(ResultsTest, HoldTheDecayOfTheMovingGrains) {
  store();
  EXPECT_NEAR(number("SELECT decay_time_s FROM motion_decay WHERE hold = 3"), 0.5, 1e-6);
  EXPECT_NEAR(number("SELECT first FROM motion_decay"), 60, 1e-4);
  EXPECT_EQ(number("SELECT moved_grains FROM samples WHERE time_s > 4.9"), 10);
}

TEST_F(ResultsTest, LeaveAMomentumResidualThatIsNotKnownEmpty) {
  store();
  EXPECT_EQ(number("SELECT count(*) FROM ramp_points WHERE momentum_residual IS NULL"), 1);
}

TEST_F(ResultsTest, FlagHoldsInWhichTheStressOnTheBedIsNotThatFromAbove) {
  store();
  EXPECT_EQ(
      number("SELECT count(*) FROM ramp_points WHERE hold = 0 AND shields_lid IS NULL AND stress_residual IS NULL "
             "AND steady IS NULL"),
      1);   // where one of them is not known
  EXPECT_EQ(number("SELECT steady FROM ramp_points WHERE hold = 1"), 1);
  EXPECT_EQ(number("SELECT count(*) FROM ramp_points WHERE NOT steady"), 2);
  EXPECT_NEAR(number("SELECT shields_lid / shields FROM ramp_points WHERE hold = 3"), 1.024, 1e-12);
  EXPECT_EQ(unsteady_holds(database_),
            "2 of 3 holds are not steady: the stress on the bed differs from that of lid and drive by up to 2.4 %");
}

TEST_F(ResultsTest, HaveNothingToSayOfHoldsThatAreSteadyOrWhoseStressIsNotKnown) {
  EXPECT_EQ(unsteady_holds(database_), "");   // no case yet
  State state = finished_state();
  for (double& residual : state.record.holds.stress_residual) residual = std::min(residual, 0.009);
  store_results(database_, {"id", "d0.5mm-s1", "set1", "d0.5mm", 1}, small_scene(), state, {});
  EXPECT_EQ(unsteady_holds(database_), "");
}

TEST_F(ResultsTest, HoldTheLevelOfReboundsOfHoldsThatMove) {
  store();
  EXPECT_EQ(number("SELECT count(*) FROM ramp_points WHERE rebound_level_m IS NULL"), 2);   // holds 0 and 1 are still
  EXPECT_NEAR(number("SELECT rebound_level_m FROM ramp_points WHERE hold = 3"), 1.5e-4, 1e-12);   // not 2.5e-4
}

TEST_F(ResultsTest, HoldHopsRestsAndTheRatesOfEntrainmentAndDeposition) {
  store();
  const double area = 10e-3 * 6e-3, d = 0.5e-3;
  EXPECT_EQ(number("SELECT count(*) FROM grain_motion WHERE hold = 3"), 1);
  EXPECT_NEAR(number("SELECT entrainment_per_m2_s FROM grain_motion"), 12 / (area * 0.5), 1e-9);
  EXPECT_NEAR(number("SELECT deposition_per_m2_s FROM grain_motion"), 10 / (area * 0.5), 1e-9);
  EXPECT_EQ(number("SELECT hop_length_m FROM grain_motion WHERE hops = 8"), 1e-3);
  EXPECT_NEAR(number("SELECT hop_length_median_m FROM grain_motion"), d * 2 * std::sqrt(2.0), 1e-12);
  EXPECT_EQ(number("SELECT count(*) FROM grain_motion WHERE hop_duration_median_s IS NULL"), 1);   // in the last bin
  EXPECT_EQ(number("SELECT count(*) FROM grain_motion WHERE rests = 1 AND rest_time_deviation_s IS NULL"), 1);
  EXPECT_EQ(number("SELECT sum(hops_by_length) FROM hop_histograms WHERE lower = 2"), 8);
}

TEST_F(ResultsTest, SayHowWellTheStepsOfEveryHoldWent) {
  store();
  EXPECT_EQ(number("SELECT retries FROM scenes"), 3);
  EXPECT_EQ(number("SELECT steps FROM step_health WHERE hold = 0"), 100);
  EXPECT_EQ(number("SELECT retries FROM step_health"), 103);
  EXPECT_EQ(number("SELECT deepest_overlap FROM step_health"), 105);
  EXPECT_EQ(number("SELECT divergence_left FROM step_health"), 108);
  EXPECT_EQ(number("SELECT limited_by_weight FROM step_health"), 119);
}

TEST_F(ResultsTest, NameMeasuresOfStepsAsTheCheckpointDoes) {
  std::vector<std::string> names{"case_id", "hold"};
  const HoldHealth measures;
  HoldHealth::each(measures, [&](std::string_view name, double, std::string_view unit) {
    names.push_back(std::string(name) + (unit == "s" ? "_s" : ""));
  });
  EXPECT_EQ(database_.query("SELECT * FROM step_health").columns, names);
}

TEST_F(ResultsTest, SayHowTheHoldUnderWayWent) {
  State state = finished_state();
  state.search.phase = Search::holding;
  state.search.hold = 1;
  state.search.health.steps = 12;
  state.search.health.divergence_left = 0.25;
  for (int again = 0; again < 2; ++again) store_health(database_, "id1", state);
  EXPECT_EQ(number("SELECT count(*) FROM step_health"), 2);
  EXPECT_EQ(number("SELECT steps FROM step_health WHERE hold = 1 AND divergence_left = 0.25"), 12);
}

TEST_F(ResultsTest, NameTheFinalStateByItsDigest) {
  store();
  const auto rows = database_.query("SELECT state_digest FROM provenance").rows;
  EXPECT_EQ(text_in(rows.at(0).at(0)), state_digest(finished_state()));
}

TEST_F(ResultsTest, OfferTheTransportCurveAsAView) {
  store();
  EXPECT_EQ(number("SELECT count(*) FROM transport_curve WHERE label = 'd0.5mm-s1' AND event_flux > 0.01"), 2);
}

TEST_F(ResultsTest, SayWhichTermsASceneHasAndWhereItIsOutOfRange) {
  for (int again = 0; again < 2; ++again) store_models(database_, "id1", coarse_scene());
  EXPECT_EQ(number("SELECT count(*) FROM models WHERE term = 'drag' AND is_on"), 1);
  EXPECT_EQ(number("SELECT count(*) FROM warnings WHERE text LIKE 'cells 2.5 d high%'"), 1);
}

std::vector<std::string> documented_queries() {
  std::ifstream file(std::filesystem::path(BEDLOAD_SOURCE_DIR) / "docs/database.md");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  std::vector<std::string> queries;
  const std::string fence = "```sql\n";
  for (std::size_t at = text.find(fence); at != std::string::npos; at = text.find(fence, at + 1)) {
    const std::size_t from = at + fence.size();
    queries.push_back(text.substr(from, text.find("```", from) - from));
  }
  return queries;
}

TEST_F(ResultsTest, AnswerTheQuestionsOfTheDocumentation) {
  Ledger ledger(database_, directory_.path());
  CaseEntry entry;
  entry.id = "id1";
  entry.label = "d0.5mm-s1";
  entry.parameters = "{}";
  ledger.enrol({entry});
  store();
  store_models(database_, "id1", coarse_scene());
  const auto queries = documented_queries();
  EXPECT_EQ(queries.size(), 9u);
  for (const std::string& sql : queries) {
    const bool of_pairs = sql.find("error_sources") != std::string::npos;   // one case has none
    EXPECT_EQ(database_.query(sql).rows.empty(), of_pairs) << sql;
  }
}

}   // namespace
}   // namespace bedload

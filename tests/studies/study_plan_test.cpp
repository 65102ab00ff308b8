// What a run would do: new, kept, extended, dropped.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "checkpoint/checkpoint_series.hpp"
#include "studies/case_entry.hpp"
#include "studies/plan.hpp"
#include "studies/study_directory.hpp"
#include "tests/studies/study_fixture.hpp"
#include "tests/support/temporary_directory.hpp"

namespace bedload {
namespace {

std::vector<Case> cases_of(const std::string& text) { return unfold(parse_study(text, "study.toml")); }

/// A final state after so many holds without motion.
State finished_after(std::size_t holds) {
  State state;
  state.clock.step = 100;
  state.search.phase = Search::finished;
  state.search.hold = holds - 1;
  auto& h = state.record.holds;
  for (auto* column : {&h.hold, &h.start, &h.end, &h.shields_nominal, &h.shields_measured, &h.lid_speed, &h.gradient,
                       &h.flux, &h.flux_standard_error, &h.moving_fraction, &h.bed_height, &h.roughness, &h.porosity,
                       &h.coordination, &h.momentum_residual})
    column->assign(holds, 0.0);
  return state;
}

class StudyPlan : public testing::Test {
 protected:
  /// Directories of a study whose cases are all finished, and its rows.
  std::vector<CaseEntry> finish(const std::string& text, std::size_t holds) {
    std::vector<CaseEntry> entries;
    for (const auto& one : cases_of(text)) {
      const auto directory = case_directory(results(), one.id);
      write_case_directory(directory, one.inputs, one.label, {});
      CheckpointSeries(directory, 2, [](const std::string&) {}).publish(finished_after(holds));
      entries.push_back(case_entry(one));
    }
    return entries;
  }
  Plan plan(const std::string& text, const std::vector<CaseEntry>& known) const {
    return make_plan(cases_of(text), known, results());
  }
  const std::filesystem::path& results() const { return directory_.path(); }

 private:
  TemporaryDirectory directory_;
};

TEST_F(StudyPlan, HasOnlyNewCasesAtFirstAndABedForEach) {
  const auto first = plan(good_study, {});
  EXPECT_EQ(first.cases.size(), 8u);
  EXPECT_EQ(first.beds.size(), 8u);
  for (const auto& c : first.cases) EXPECT_EQ(c.fate, Fate::fresh);
}

TEST_F(StudyPlan, KeepsWhatIsDone) {
  const auto known = finish(good_study, 12);
  for (const auto& c : plan(good_study, known).cases) {
    EXPECT_EQ(c.fate, Fate::kept);
    EXPECT_TRUE(c.done);
    EXPECT_FALSE(c.results_change);
  }
}

TEST_F(StudyPlan, ExtendsWhatALongerRampGoesOnWith) {
  const auto known = finish(good_study, 12);
  for (const auto& c : plan(with(good_study, "steps = 12", "steps = 13"), known).cases) {
    EXPECT_EQ(c.fate, Fate::extended);
    EXPECT_FALSE(c.done);
  }
}

TEST_F(StudyPlan, OnlyRecomputesResultsOfAShorterRampOrAnotherCriterion) {
  const auto known = finish(good_study, 12);
  for (const auto& changed :
       {with(good_study, "steps = 12", "steps = 6"), with(good_study, "[drive]", "[onset]\nvalue = 0.02\n[drive]")}) {
    for (const auto& c : plan(changed, known).cases) {
      EXPECT_EQ(c.fate, Fate::kept);
      EXPECT_TRUE(c.done && c.results_change);
    }
  }
}

TEST_F(StudyPlan, DropsWhatLeftTheStudyFile) {
  const auto known = finish(good_study, 12);
  const auto fewer = plan(with(good_study, "[\"0.5 mm\", \"0.6 mm\"]", "\"0.5 mm\""), known);
  EXPECT_EQ(fewer.cases.size(), 4u);
  EXPECT_EQ(fewer.dropped.size(), 4u);
  EXPECT_TRUE(fewer.other_physics.empty());
}

TEST_F(StudyPlan, TellsResultsOfAnotherPhysicsVersion) {
  auto known = finish(good_study, 12);
  auto parameters = nlohmann::json::parse(known[0].parameters);
  parameters["physics_version"] = physics_version - 1;
  known[0].parameters = parameters.dump();
  known[0].id[0] = known[0].id[0] == 'x' ? 'y' : 'x';   // the version is in the id
  const auto other = plan(good_study, known);
  ASSERT_EQ(other.other_physics.size(), 1u);
  EXPECT_EQ(other.other_physics[0].label, known[0].label);
}

}   // namespace
}   // namespace bedload

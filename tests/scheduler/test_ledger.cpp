// The ledger: enrolment, what it keeps, and what its views say.
#include <gtest/gtest.h>

#include "scheduler/ledger.hpp"
#include "tests/support/temporary_directory.hpp"

namespace bedload {
namespace {

CaseEntry entry(const std::string& id, const std::string& bed = {}) {
  CaseEntry e;
  e.id = id;
  e.label = "label of " + id;
  e.directory = "cases/" + id;
  e.bed = bed;
  e.parameters = R"({"grains.diameter": 0.0005})";
  e.columns = {{"diameter_m", 5e-4}, {"seed", std::int64_t{1}}, {"drag", std::string("stokes")}};
  return e;
}

class LedgerOfAStudy : public testing::Test {
 protected:
  InMemoryDirectory directory_;
  Database database_{directory_.path() / "study.db", Database::Mode::write};
  Ledger ledger_{database_, directory_.path()};
};

TEST_F(LedgerOfAStudy, KeepsItsOrderAndItsParameters) {
  CaseEntry bed = entry("b");
  bed.is_bed = true;
  ledger_.enrol({bed, entry("z", "b"), entry("a", "b")});
  const auto cases = ledger_.cases();
  ASSERT_EQ(cases.size(), 3u);
  EXPECT_TRUE(cases[0].is_bed);
  EXPECT_EQ(cases[1].id, "z");
  EXPECT_EQ(cases[1].bed, "b");
  EXPECT_EQ(cases[2].label, "label of a");
  EXPECT_EQ(ledger_.directory_of(cases[2]), directory_.path() / "cases/a");
  const Rows rows = database_.query("SELECT diameter_m, seed, drag FROM cases WHERE case_id = 'z'");
  EXPECT_EQ(rows.rows[0], (std::vector<Value>{5e-4, std::int64_t{1}, std::string("stokes")}));
}

TEST_F(LedgerOfAStudy, KeepsDroppedCasesOutsideTheStudyAndTakesThemBack) {
  ledger_.enrol({entry("a"), entry("b")});
  ledger_.set_state("a", CaseState::done);
  ledger_.enrol({entry("b"), entry("c")});
  ASSERT_EQ(ledger_.cases().size(), 2u);
  const auto all = read_cases(database_);
  ASSERT_EQ(all.size(), 3u);
  EXPECT_FALSE(all[0].in_study);
  EXPECT_EQ(all[0].state, CaseState::done);
  ledger_.enrol({entry("a")});
  EXPECT_EQ(ledger_.cases().at(0).state, CaseState::done);
}

TEST_F(LedgerOfAStudy, EnrolsAllOrNone) {
  CaseEntry bad = entry("b");
  bad.columns.emplace_back("seed", std::string("not a number"));   // a STRICT table refuses it
  EXPECT_THROW(ledger_.enrol({entry("a"), bad}), Error);
  EXPECT_TRUE(ledger_.cases().empty());
}

TEST_F(LedgerOfAStudy, TellsFailuresProgressAndCost) {
  ledger_.enrol({entry("a"), entry("b")});
  Attempt one;
  one.number = 1;
  one.cause = Cause::killed;
  one.core_seconds = 1800;
  Attempt two = one;
  two.number = 2;
  two.cause = Cause::numerical;
  two.step = 77;
  two.core_seconds = 3600;
  ledger_.record_attempts("a", {one, two});
  ledger_.record_attempts("a", {one, two});   // idempotent
  ledger_.set_state("a", CaseState::failed, "overlap");
  Database reader(directory_.path() / "study.db", Database::Mode::query);
  const Rows failures = reader.query("SELECT label, message, cause, step, attempts, log FROM failures");
  ASSERT_EQ(failures.rows.size(), 1u);
  EXPECT_EQ(failures.rows[0],
            (std::vector<Value>{std::string("label of a"), std::string("overlap"), std::string("numerical"),
                                std::int64_t{77}, std::int64_t{2}, std::string("cases/a/log.2")}));
  EXPECT_EQ(reader.query("SELECT state, count FROM progress ORDER BY state").rows,
            (std::vector<std::vector<Value>>{{std::string("failed"), std::int64_t{1}},
                                             {std::string("pending"), std::int64_t{1}}}));
  EXPECT_EQ(reader.query("SELECT attempts, core_h, core_h_of_unplanned_ends FROM cost WHERE case_id = 'a'").rows[0],
            (std::vector<Value>{std::int64_t{2}, 1.5, 1.5}));
  EXPECT_EQ(read_cases(reader).size(), 2u) << "a query may read the cases";
}

TEST_F(LedgerOfAStudy, ReadsNoCasesFromADatabaseWithoutThem) {
  const Database empty(directory_.path() / "other.db", Database::Mode::write);
  EXPECT_TRUE(read_cases(empty).empty());
}

}   // namespace
}   // namespace bedload

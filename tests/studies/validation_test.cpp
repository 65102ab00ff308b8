// The ladder's verdicts, its study files, and that climbing it gives the same numbers whoever climbs.
#include "studies/validation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/durable_file.hpp"
#include "base/error.hpp"
#include "studies/validation_files.hpp"
#include "studies/verification_document.hpp"

namespace bedload {
namespace {

ValidationRow row(double reference, double ours, Band band) {
  return {.name = "speed [m/s]", .reference = reference, .source = "Newton", .ours = ours, .band = band};
}

TEST(ValidationRow, IsInBandOnBothSidesOfItsReference) {
  EXPECT_TRUE(row(-2, -2.019, Band::within(0.01)).in_band());
  EXPECT_TRUE(row(-2, -1.981, Band::within(0.01)).in_band());
  EXPECT_FALSE(row(-2, -2.021, Band::within(0.01)).in_band());
  EXPECT_FALSE(row(-2, -1.979, Band::within(0.01)).in_band());
  EXPECT_TRUE(row(0, 0.09, Band::within_absolute(0.1)).in_band());
  EXPECT_FALSE(row(0, -0.11, Band::within_absolute(0.1)).in_band());
}

TEST(ValidationRow, MayBeBoundedOnOneSide) {
  EXPECT_TRUE(row(5, 1, Band::at_most()).in_band());
  EXPECT_TRUE(row(5, 5.1, Band::at_most(0.03)).in_band());
  EXPECT_FALSE(row(5, 5.2, Band::at_most(0.03)).in_band());
  EXPECT_TRUE(row(5, 50, Band::at_least()).in_band());
  EXPECT_FALSE(row(5, 4.9, Band::at_least(0.01)).in_band());
}

TEST(ValidationRow, IsOutOfBandWhereNothingWasMeasured) {
  EXPECT_FALSE(row(1, std::nan(""), Band::within(1)).in_band());
  EXPECT_FALSE(row(1, INFINITY, Band::at_least()).in_band());
  EXPECT_FALSE(row(0, 0, Band::within(0.1)).in_band()) << "a fraction of nothing";
}

TEST(ValidationRow, ShowsDeviationAndBandAlike) {
  EXPECT_EQ(shown_deviation(row(2, 2.01, Band::within(0.01))), "+0.5 %");
  EXPECT_EQ(shown_band(row(2, 2.01, Band::within(0.01))), "1 %");
  EXPECT_EQ(shown_deviation(row(2, 1.95, Band::within_absolute(0.1))), "-0.05");
  EXPECT_EQ(shown_band(row(2, 1.95, Band::within_absolute(0.1))), "0.1");
  EXPECT_EQ(shown_band(row(2, 2, Band::at_most(0.03))), "at most +3 %");
  EXPECT_EQ(shown_deviation(row(2, std::nan(""), Band::within(1))), "none");
}

TEST(ValidationRow, ThatIsANoteDecidesNothing) {
  const Findings one{.rows = {row(1, 1, Band::within(0.1)), ValidationRow::note("time [s]", "CPU", 3)}, .figures = {}};
  EXPECT_EQ(one.deciding(), 1u);
  EXPECT_EQ(one.in_band(), 1u);
  EXPECT_EQ(shown_band(one.rows[1]), "none");
  EXPECT_EQ(shown_verdict(one.rows[1]), "note");
  RungResult rung{.group = "contact", .study = "a", .what = "b", .findings = one, .failure = ""};
  EXPECT_TRUE(rung.passed());
  rung.findings.rows.erase(rung.findings.rows.begin());
  EXPECT_FALSE(rung.passed()) << "notes alone";
}

TEST(ValidationStudies, AreEmbeddedByteByByte) {
  ASSERT_FALSE(validation_files().empty());
  for (const auto& file : validation_files()) {
    const std::filesystem::path source = std::filesystem::path(BEDLOAD_SOURCE_DIR) / "studies/validation" / file.name;
    EXPECT_EQ(file.text, read_text(source)) << file.name;
  }
}

TEST(ValidationStudies, UnfoldAndHaveQuickCasesWhereTheySaySo) {
  std::set<std::string> names;
  for (const auto& group : validation_groups())
    for (const auto& rung : group.rungs()) {
      EXPECT_TRUE(names.insert(std::string(rung.study)).second) << rung.study << " stands twice on the ladder";
      EXPECT_TRUE(rung.study.starts_with(group.name)) << rung.study;
      EXPECT_FALSE(rung.what.empty()) << rung.study;
      const auto all = cases_of(rung, false).size(), quick = cases_of(rung, true).size();
      EXPECT_GT(all, 0u) << rung.study;
      EXPECT_EQ(quick > 0, bool(rung.quick)) << rung.study;
    }
}

TEST(ValidationGroups, AreAllOrThoseNamedInTheOrderOfTheLadder) {
  EXPECT_EQ(groups_named({}).size(), validation_groups().size());
  const auto two = groups_named({"onset", "contact"});
  ASSERT_EQ(two.size(), 2u);
  EXPECT_EQ(two[0].name, "contact");
  try {
    groups_named({"contct"});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind, ErrorKind::usage);
    EXPECT_NE(error.hint.find("did you mean contact?"), std::string::npos);
    EXPECT_NE(error.hint.find("contact, "), std::string::npos);
  }
}

std::vector<Rung> some_rungs() {
  auto rungs = contact_rungs();
  std::erase_if(rungs, [](const Rung& rung) {
    return rung.study != "contact-hertz" && rung.study != "contact-foerster-glass" && rung.study != "contact-free-fall";
  });
  return rungs;
}
const std::vector<ValidationGroup> part_of_the_ladder{{"contact", "collisions", some_rungs}};

TEST(Climb, GivesTheSameNumbersOnOneCoreAsOnThree) {
  const auto one = climb(part_of_the_ladder, {.cores = 1}), three = climb(part_of_the_ladder, {.cores = 3});
  ASSERT_EQ(one.size(), 3u);
  ASSERT_EQ(three.size(), 3u);
  for (std::size_t n = 0; n < one.size(); ++n) {
    EXPECT_TRUE(one[n].passed()) << one[n].study << " " << one[n].failure;
    ASSERT_EQ(one[n].findings.rows.size(), three[n].findings.rows.size());
    for (std::size_t r = 0; r < one[n].findings.rows.size(); ++r)
      EXPECT_EQ(one[n].findings.rows[r].ours, three[n].findings.rows[r].ours) << one[n].findings.rows[r].name;
  }
}

// atan(Psi1 (5 - 2 beta0)/(7 e)) at 0.25 with e = 0.87 +- 0.02, beta0 = 0.43 +- 0.06: 9.65 +- 0.35 deg, by hand.
TEST(Foerster, RowsSayTheUncertaintyOfWhatWasMeasured) {
  const auto acetate = [] {
    auto rungs = contact_rungs();
    std::erase_if(rungs, [](const Rung& rung) { return rung.study != "contact-foerster-acetate"; });
    return rungs;
  };
  const auto rungs = climb({{"contact", "collisions", acetate}}, {.cores = 1});
  ASSERT_EQ(rungs.size(), 1u);
  const auto& first = rungs[0].findings.rows.at(0);
  EXPECT_NEAR(first.reference, 9.65, 0.005) << first.name;
  EXPECT_NE(first.source.find("+-0.35 deg"), std::string::npos) << first.source;
}

std::vector<Rung> a_rung_without_a_study() { return {{"contact-nothing", "nothing", nullptr, every_case}}; }
std::vector<Rung> a_rung_that_sees_nothing() {
  return {{"contact-free-fall", "a fall", [](const auto&) { return Findings{}; }, every_case}};
}

TEST(Climb, FailsARungWithoutStudyOrRows) {
  const auto missing = climb({{"contact", "collisions", a_rung_without_a_study}}, {.cores = 1});
  ASSERT_EQ(missing.size(), 1u);
  EXPECT_NE(missing[0].failure.find("contact-nothing.toml"), std::string::npos);
  EXPECT_FALSE(missing[0].passed());
  const auto blind = climb({{"contact", "collisions", a_rung_that_sees_nothing}}, {.cores = 1});
  ASSERT_EQ(blind.size(), 1u);
  EXPECT_TRUE(blind[0].failure.empty());
  EXPECT_FALSE(blind[0].passed());
}

TEST(VerificationDocument, HoldsTheMeshesSideBySideAfterTheirGroup) {
  RungResult fine{.group = "settling", .study = "settling-table-5", .what = "a fall", .findings = {}, .failure = ""};
  fine.findings.falls = {{.cell = 5, .corrected = true, .against_law = 0.001, .ripple = 0.002},
                         {.cell = 5, .against_law = 0.05, .against_stokes = -0.2, .seconds_of_500_steps = 1.5}};
  RungResult coarse = fine, last = fine;
  coarse.study = "settling-table-25", coarse.findings.falls = {{.cell = 25, .against_law = 0.01}};
  last.group = "bed", last.study = "bed-packed", last.findings.falls.clear();
  const auto files = verification_document({fine, coarse, last}, "bedload validate");
  const auto& text = files[0].text;
  const auto table = text.find("| 25 | raw | +1.00 %");
  ASSERT_NE(table, std::string::npos) << text;
  EXPECT_LT(text.find("### settling-table-25"), table);
  EXPECT_LT(table, text.find("| 5 | raw | +5.00 % | -20.00 % | 0.00 % | 1.50 |"));
  EXPECT_LT(text.find("| 5 | raw |"), text.find("| 5 | corrected | +0.10 %"));
  EXPECT_LT(text.find("| 5 | corrected |"), text.find("## bed"));
  EXPECT_EQ(files[1].path, "verification/settling-meshes.svg");
  EXPECT_EQ(verification_document({last}, "bedload validate").size(), 1u) << "no figure without falls";
}

TEST(VerificationDocument, HoldsEveryRowAndItsFigures) {
  const auto files = verification_document(climb(part_of_the_ladder, {.cores = 2}), "bedload validate contact");
  ASSERT_EQ(files.size(), 2u);
  EXPECT_EQ(files[0].path, "verification.md");
  EXPECT_EQ(files[1].path, "verification/contact-foerster-glass.svg");
  EXPECT_NE(files[0].text.find("![contact-foerster-glass](verification/contact-foerster-glass.svg)"),
            std::string::npos);
  EXPECT_NE(files[0].text.find("Written by `bedload validate contact`"), std::string::npos);
  EXPECT_NE(files[0].text.find("one without is in the unit of the row"), std::string::npos);
  EXPECT_NE(files[0].text.find("| duration of a collision at 0.05 m/s [us] |"), std::string::npos);
  EXPECT_NE(files[0].text.find("(../studies/validation/contact-hertz.toml)"), std::string::npos);
  EXPECT_EQ(files[0].text.find("**no**"), std::string::npos);
  EXPECT_TRUE(files[1].text.starts_with("<svg"));
}

}   // namespace
}   // namespace bedload

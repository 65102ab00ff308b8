// case.toml: what is written is read back as the same case.
#include "studies/case_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "studies/case_identity.hpp"
#include "studies/study_file.hpp"
#include "tests/studies/study_fixture.hpp"
#include "tests/support/temporary_directory.hpp"

namespace bedload {
namespace {

void expect_same_after_writing(const CaseInputs& inputs) {
  TemporaryDirectory directory;
  write_case_directory(directory.path(), inputs, "label", {});
  const auto back = read_case_directory(directory.path());
  EXPECT_EQ(back.label, "label");
  EXPECT_EQ(canonical_inputs(back.inputs), canonical_inputs(inputs));
  EXPECT_EQ(case_id(back.inputs), case_id(inputs));
  auto expected = inputs;
  if (expected.has("bed.file")) expected.values["bed.file"] = std::string("inputs/bed.csv");
  EXPECT_TRUE(back.inputs == expected);
}

TEST(CaseFile, ReadsBackToTheSameCase) {
  for (const auto& one : unfold(parse_study(good_study, "study.toml"))) expect_same_after_writing(one.inputs);
}

TEST(CaseFile, ReadsBackToTheSameBed) {
  for (const auto& one : unfold(parse_study(good_study, "study.toml"))) {
    const auto bed = bed_inputs(one.inputs);
    EXPECT_EQ(case_id(bed), one.bed_id);
    expect_same_after_writing(bed);
  }
}

TEST(CaseFile, KeepsEveryKindOfSetting) {
  const auto text = with(with(good_study, "shields = { from = 0.06, ratio = 1.2, steps = 12 }",
                              "gradient = { from = \"3 Pa/m\", step = \"0.7 Pa/m\", steps = 5 }"),
                         "kind = \"lid\"", "kind = \"pressure\"") +
                    "\n[models]\nterms = [\"drag\", \"buoyancy\"]\ndrag = \"stokes\"\n[onset]\nmethod = "
                    "\"none\"\n[record]\ntracks = [0, 7]\n";
  const auto sloped = with(text, "[drive]", "top = \"free-slip\"\nslope = \"2 deg\"\n[drive]");
  for (const auto& one : unfold(parse_study(sloped, "study.toml"))) expect_same_after_writing(one.inputs);
}

TEST(CaseFile, KeepsAnEmptyListOfTerms) {
  const auto cases = unfold(parse_study(std::string(good_study) + "\n[models]\nterms = []\n", "study.toml"));
  for (const auto& one : cases) expect_same_after_writing(one.inputs);
}

TEST(CaseFile, CarriesATableOfGrains) {
  TemporaryDirectory directory;
  std::ofstream(directory.path() / "two.csv")
      << "x,y,z,diameter,density,fixed\n1e-3,1e-3,1e-3,5e-4,2000,1\n2e-3,1e-3,2e-3,5e-4,2000,0\n";
  const auto text = with(with(good_study, "count = 300\nseed = { count = 2 }", "source = \"file\"\nfile = \"two.csv\""),
                         "[\"0.5 mm\", \"0.6 mm\"]", "\"0.5 mm\"");
  const auto cases = unfold(parse_study(text, (directory.path() / "study.toml").string()));
  ASSERT_EQ(cases.size(), 2u);
  EXPECT_TRUE(cases[0].bed_id.empty());
  expect_same_after_writing(cases[0].inputs);
}

}   // namespace
}   // namespace bedload

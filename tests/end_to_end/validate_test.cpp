// `bedload validate` as a user runs it: from any directory, leaving nothing behind.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>

#include <nlohmann/json.hpp>

#include "tests/end_to_end/bedload_program.hpp"
#include "tests/support/temporary_directory.hpp"

namespace bedload {
namespace {

TEST(ValidateCommand, ClimbsAGroupInMemoryAndEndsWell) {
  const TemporaryDirectory directory;
  const auto outcome = bedload(directory.path(), {"validate", "contact", "--quick", "--json", "--cores", "2"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_TRUE(json.at("pass"));
  EXPECT_TRUE(json.at("quick"));
  for (const char* key : {"version", "commit", "date"}) EXPECT_FALSE(json.at(key).get<std::string>().empty()) << key;
  ASSERT_GE(json.at("rungs").size(), 10u);
  for (const auto& rung : json.at("rungs"))
    for (const auto& row : rung.at("rows"))
      EXPECT_TRUE(row.at("pass") == true && !row.at("unit").empty()) << row.dump();
  for (const auto& left : std::filesystem::directory_iterator(directory.path()))
    EXPECT_EQ(left.path().filename().string()[0], '.') << "only this test's own .out and .err: " << left.path();
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(ValidateCommand, PrintsTablesThatFitAPageAndTheSumBelowThem) {
  const TemporaryDirectory directory;
  const auto outcome = bedload(directory.path(), {"validate", "contact", "--quick", "--cores", "2"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const auto& line : lines_of(outcome.out)) EXPECT_LE(line.size(), 120u) << line;
  EXPECT_NE(outcome.out.find("contact-hertz: two equal elastic spheres meet head-on\n"), std::string::npos);
  EXPECT_NE(outcome.out.find("[1] Hertz 1882\n"), std::string::npos);
  EXPECT_TRUE(regex_search(outcome.out, std::regex("([0-9]+) of \\1 rows in band; [^\n]*core seconds\n$")));
}

TEST(ValidateCommand, PrintsCsvInNumbersWithGroupAndUnit) {
  const TemporaryDirectory directory;
  const auto outcome = bedload(directory.path(), {"validate", "contact", "--quick", "--cores", "2", "--csv"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const auto lines = lines_of(outcome.out);
  ASSERT_GT(lines.size(), 10u);
  EXPECT_EQ(lines[0],
            "group,study,row,unit,reference,source,against,ours,deviation,relative,band_below,band_above,pass");
  const std::regex row(
      "contact,contact-[a-z-]+,(\"[^\"]*\"|[^,\"]*),[a-z0-9/-]+,[-+.e0-9]+,(\"[^\"]*\"|[^,\"]*),"
      "(code|experiment),[-+.e0-9]+,[-+.e0-9]+,(true|false),[-+.e0-9]*,[-+.e0-9]*,true");
  for (std::size_t n = 1; n < lines.size(); ++n)
    EXPECT_TRUE(lines[n].ends_with(",") || std::regex_match(lines[n], row)) << lines[n];   // notes end with a comma
}

TEST(ValidateCommand, ExplainsItsBands) {
  const TemporaryDirectory directory;
  const auto outcome = bedload(directory.path(), {"validate", "--help"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.out.find("one without is in the unit of the row"), std::string::npos) << outcome.out;
}

TEST(ValidateCommand, RefusesAnUnknownGroupWithTheList) {
  const TemporaryDirectory directory;
  const auto outcome = bedload(directory.path(), {"validate", "contct"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("the groups are contact"), std::string::npos) << outcome.err;
}

TEST(ValidateCommand, ListsItsStudiesWithoutRunningThem) {
  const TemporaryDirectory directory;
  const auto outcome = bedload(directory.path(), {"validate", "onset", "--list"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.out.find("onset-pocket-triangular"), std::string::npos) << outcome.out;
}

TEST(ValidateCommand, ListsTheScenesOfTheExtremesToo) {
  const TemporaryDirectory directory;
  const auto all = bedload(directory.path(), {"validate", "--list"});
  EXPECT_EQ(all.code, 0);
  const auto extremes = bedload(directory.path(), {"validate", "extremes", "--list"});
  EXPECT_EQ(extremes.code, 0) << extremes.err;
  for (const auto* out : {&all.out, &extremes.out})
    EXPECT_NE(out->find("bed of solid fraction 0.64 that touches the lid"), std::string::npos) << *out;
  EXPECT_NE(all.out.find("onset-pocket-triangular"), std::string::npos);
  EXPECT_EQ(extremes.out.find("onset-pocket-triangular"), std::string::npos);
}

TEST(ValidateCommand, SaysHowAStudyOfAGroupIsRun) {
  const TemporaryDirectory directory;
  const auto outcome = bedload(directory.path(), {"validate", "contact-hertz"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("contact-hertz is a study of the group contact"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("bedload run studies/validation/contact-hertz.toml"), std::string::npos) << outcome.err;
}

/// Waits until it has reported a run on stderr, sends SIGINT.
Outcome interrupted(const std::filesystem::path& directory, std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), {"--cores", "2"});
  Process process(directory, arguments);
  for (int tenths = 0; tenths < 300 && contents(directory / ".err").find('\n') == std::string::npos; ++tenths)
    ::usleep(100'000);
  ::kill(process.pid(), SIGINT);
  return process.wait();
}

TEST(ValidateCommand, PrintsTheRowsThatAreDoneWhenInterrupted) {
  const TemporaryDirectory one, other;
  const auto ladder = interrupted(one.path(), {"validate", "contact"});
  EXPECT_EQ(ladder.code, 75) << ladder.err;
  EXPECT_NE(ladder.out.find("contact-"), std::string::npos) << ladder.out;
  EXPECT_TRUE(regex_search(ladder.out, std::regex("stopped after [1-9][0-9]* of [0-9]+ studies"))) << ladder.out;
  const auto extremes = interrupted(other.path(), {"validate", "extremes", "--write", "docs"});
  EXPECT_EQ(extremes.code, 75) << extremes.err;
  EXPECT_NE(extremes.out.find("finished"), std::string::npos) << extremes.out;
  EXPECT_TRUE(regex_search(extremes.out, std::regex("stopped after [1-9][0-9]* of [0-9]+ scenes"))) << extremes.out;
  EXPECT_FALSE(std::filesystem::exists(other.path() / "docs/extremes.md")) << "of a part";
}

TEST(ValidateCommand, RefusesAFolderItCannotWriteToBeforeItRunsAnything) {
  const TemporaryDirectory directory;
  std::ofstream(directory.path() / "file");
  const std::vector<std::vector<std::string>> ladder_and_extremes{{}, {"extremes"}};
  for (const auto& group : ladder_and_extremes)
    for (const char* folder : {"/proc/nope", "/proc", "file/in"}) {
      std::vector<std::string> arguments{"validate", "--quick", "--cores", "2", "--write", folder};
      arguments.insert(arguments.begin() + 1, group.begin(), group.end());
      const auto outcome = bedload(directory.path(), arguments);
      EXPECT_EQ(outcome.code, 74) << outcome.err;
      EXPECT_TRUE(outcome.out.empty());
      EXPECT_TRUE(outcome.err.starts_with("error: ")) << "something was run: " << outcome.err;
    }
}

TEST(ValidateCommand, DoesNotReplaceTheDocumentByTheRowsOfOneGroup) {
  const TemporaryDirectory directory;
  const auto outcome = bedload(directory.path(), {"validate", "onset", "--quick", "--write", "docs"});
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_NE(outcome.err.find("hint: "), std::string::npos) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(directory.path() / "docs"));
}

}   // namespace
}   // namespace bedload

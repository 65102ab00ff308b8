// What the program refuses: exit code, message, and nothing written.
#include <gtest/gtest.h>

#include <regex>

#include "base/durable_file.hpp"
#include "tests/end_to_end/bedload_program.hpp"
#include "tests/end_to_end/tiny_study.hpp"
#include "tests/support/temporary_directory.hpp"

namespace bedload {
namespace {

testing::AssertionResult says(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "\"" << part << "\" is not in: " << text;
}

class BadInput : public testing::Test {
 protected:
  Outcome run(const std::string& study, const std::vector<std::string>& more = {}) {
    std::ofstream(here() / "tiny.toml") << study;
    std::vector<std::string> arguments{"run", "tiny.toml"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return bedload(here(), arguments);
  }
  /// Refused with that code and message; no result directory.
  void expect_refused(const std::string& study, int code, const std::string& message) {
    const auto outcome = run(study);
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_TRUE(says(outcome.err, message));
    EXPECT_TRUE(says(outcome.err, "hint: "));
    EXPECT_TRUE(outcome.out.empty());
    EXPECT_FALSE(std::filesystem::exists(here() / "tiny"));
  }
  const std::filesystem::path& here() const { return directory_.path(); }

 private:
  TemporaryDirectory directory_;
};

TEST_F(BadInput, UnknownKey) {
  expect_refused(
      with(tiny_study, "viscosity", "viskosity"), 65,
      "tiny.toml:6:1: error: fluid.viskosity is not a key of a study file\nhint: did you mean fluid.viscosity?");
}
TEST_F(BadInput, MissingUnit) {
  expect_refused(with(tiny_study, "\"1.0e-5 m2/s\"", "\"1.0e-5\""), 65,
                 "tiny.toml:6:13: error: fluid.viscosity: \"1.0e-5\" has no unit");
}
TEST_F(BadInput, WrongDimension) {
  expect_refused(with(tiny_study, "\"0.5 mm\"", "\"0.5 ms\""), 65,
                 "tiny.toml:9:13: error: grains.diameter[1]: \"0.5 ms\" is a time, not a length");
}
TEST_F(BadInput, ZeroDiameter) {
  expect_refused(with(tiny_study, "\"0.5 mm\"", "\"0 mm\""), 65,
                 "tiny.toml:9:13: error: grains.diameter[1]: '0 mm' must be greater than zero");
}
TEST_F(BadInput, NegativeDiameter) {
  expect_refused(with(tiny_study, "\"0.5 mm\"", "\"-1 mm\""), 65, "tiny.toml:9:13: error: grains.diameter[1]");
}
TEST_F(BadInput, GrainsThatDoNotFitTheBox) {
  expect_refused(with(tiny_study, "count = 300", "count = 3000"), 65, "do not fit the box");
}
TEST_F(BadInput, CellLargerThanTheBox) {
  expect_refused(with(tiny_study, "xy = \"2 d\"", "xy = \"7 d\""), 65, "larger than the box");
}
TEST_F(BadInput, AxisOnAKeyThatIsNotPhysics) {
  expect_refused(with(tiny_study, "\"1 s\"", "[\"1 s\", \"2 s\"]"), 65,
                 "run.checkpoint.every: a list is an axis, and this key is not physics");
}
TEST_F(BadInput, DemStepAboveThreeTenthsOfARayleighTime) {
  expect_refused(tiny_study + "[steps]\ndem = \"0.1 ms\"\n", 65, "Rayleigh times of the smallest grain");
}
TEST_F(BadInput, KeyOfALaterVersion) {
  struct Later {
    const char *table, *line, *message;
  };
  for (const auto& [table, line, message] : {
           Later{"", "executor = \"slurm\"", "run.executor: \"slurm\" is not in this version"},
           Later{"", "ranks = 2", "run.ranks: 2 ranks per case are not in this version"},
           Later{"", "wall_limit = \"1 h\"", "run.wall_limit is not in this version (a wall time limit per attempt)"},
       })
    expect_refused(tiny_study + table + line + "\n", 65, message);
}
TEST_F(BadInput, TermsThatContradictEachOther) {
  expect_refused(tiny_study + "[models]\nterms = [\"drag\", \"wet_restitution\", \"lubrication\"]\n", 65,
                 "tiny.toml:29:9: error: models.terms: wet_restitution and lubrication are both the film");
  expect_refused(tiny_study + "[models]\nterms = [\"drag\", \"pressure_gradient\"]\n", 65, "both or neither");
}
TEST_F(BadInput, TermWithoutWhatItNeeds) {
  expect_refused(tiny_study + "[models]\nterms = [\"shear_lift\"]\n", 65, "drag is left out\nhint: add \"drag\"");
  expect_refused(with(tiny_study, "width = \"6 d\"", "width = \"6 d\"\nroughness = \"1 mm\""), 65, "box.roughness");
}
TEST_F(BadInput, TermNamedTwice) {
  expect_refused(tiny_study + "[models]\nterms = [\"drag\", \"drag\"]\n", 65,
                 "tiny.toml:29:18: error: models.terms[2]: \"drag\" stands twice in this list\nhint: remove one");
}
TEST_F(BadInput, UnknownTermOrLaw) {
  expect_refused(tiny_study + "[models]\nterms = [\"drag\", \"shear_lft\"]\n", 65,
                 "models.terms[2]: \"shear_lft\" is not known\nhint: did you mean \"shear_lift\"?");
  expect_refused(tiny_study + "[models]\ndrag = \"koch_hil\"\n", 65, "did you mean \"koch_hill\"?");
}
TEST_F(BadInput, DragLawOutOfItsRangeWhereThatIsForbidden) {
  const auto stokes = tiny_study + "[models]\ndrag = \"stokes\"\n";
  expect_refused(stokes + "strict = true\n", 65, "tiny.toml:29:8: error: models.drag: ");
  std::ofstream(here() / "tiny.toml") << stokes;
  const auto plan = bedload(here(), {"plan", "tiny.toml"});
  EXPECT_EQ(plan.code, 0) << plan.err;
  EXPECT_TRUE(says(plan.out, "stokes is made for Re up to 0.1"));
}

TEST_F(BadInput, SpreadThatLeavesNoSmallestGrain) {
  expect_refused(with(tiny_study, "[bed]", "spread = 0.9\n\n[bed]"), 65,
                 "tiny.toml:12:10: error: grains.spread: 0.9 lets the smallest grain vanish");
}
TEST_F(BadInput, RampWithoutEnd) {
  expect_refused(with(tiny_study, "steps = 4", "steps = 100000000"), 65,
                 "tiny.toml:23:46: error: drive.shields.steps: 100000000 levels are too many");
}

TEST_F(BadInput, OverlappingGrainsInTheTable) {
  std::ofstream(here() / "bed.csv")
      << "x,y,z,diameter,density,fixed\n1e-3,1e-3,1e-3,5e-4,2000,0\n1.3e-3,1e-3,1e-3,5e-4,2000,0\n";
  expect_refused(with(with(tiny_study, "count = 300", "source = \"file\"\nfile = \"bed.csv\""),
                      "[\"0.5 mm\", \"0.6 mm\"]", "\"0.5 mm\""),
                 65, "error: bed.file: rows 2 and 3: the grains overlap by 0.0002 m, 40 % of a diameter");
}
TEST_F(BadInput, TwoGrainsAtOnePlaceInTheTable) {
  std::ofstream(here() / "bed.csv")
      << "x,y,z,diameter,density,fixed\n1e-3,1e-3,1e-3,5e-4,2000,0\n1e-3,1e-3,1e-3,5e-4,2000,0\n";
  expect_refused(with(with(tiny_study, "count = 300", "source = \"file\"\nfile = \"bed.csv\""),
                      "[\"0.5 mm\", \"0.6 mm\"]", "\"0.5 mm\""),
                 65, "error: bed.file: rows 2 and 3: two grains at one place");
}

TEST_F(BadInput, UnwritableDirectory) {
  const auto outcome = run(tiny_study, {"--out", "/proc/bedload"});
  EXPECT_EQ(outcome.code, 74) << outcome.err;
  EXPECT_TRUE(says(outcome.err, "/proc/bedload"));
}

TEST_F(BadInput, ResultDirectoryThatIsAFile) {
  std::ofstream(here() / "tiny") << "mine";
  EXPECT_EQ(run(tiny_study).code, 74);
  EXPECT_EQ(contents(here() / "tiny"), "mine");
}

TEST_F(BadInput, ResultDirectoryThatHoldsSomethingElse) {
  std::filesystem::create_directory(here() / "tiny");
  std::ofstream(here() / "tiny" / "thesis.tex") << "mine";
  EXPECT_EQ(run(tiny_study).code, 65);
  EXPECT_FALSE(std::filesystem::exists(here() / "tiny" / "lock"));
}

TEST_F(BadInput, MissingStudy) {
  const auto outcome = bedload(here(), {"run", "nowhere.toml"});
  EXPECT_EQ(outcome.code, 66);
  EXPECT_TRUE(says(outcome.err, "nowhere.toml"));
}

TEST_F(BadInput, UnknownCommandAndOptionAndLaterCommand) {
  EXPECT_EQ(bedload(here(), {"rum", "tiny.toml"}).code, 2);
  EXPECT_EQ(bedload(here(), {"run", "tiny.toml", "--fast"}).code, 2);
  EXPECT_EQ(bedload(here(), {}).code, 2);
}

TEST_F(BadInput, TradeOfAStudyThatVariesNothing) {
  std::ofstream(here() / "tiny.toml") << tiny_study;
  const auto refused = bedload(here(), {"trade", "tiny.toml"});
  EXPECT_EQ(refused.code, 65) << refused.err;
  EXPECT_TRUE(says(refused.err, "tiny.toml has no [[trade]]"));
  EXPECT_FALSE(std::filesystem::exists(here() / "tiny")) << "refused before anything runs";
}

TEST_F(BadInput, CommandOfALaterVersion) {
  std::ofstream(here() / "tiny.toml") << tiny_study;
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"prune"}, {"doctor"}, {"plan", "--probe"}}) {
    auto arguments = words;
    arguments.push_back("tiny.toml");
    const auto later = bedload(here(), arguments);
    EXPECT_EQ(later.code, 69) << later.err;
    const auto name = words.size() == 1 ? words[0] : words[0] + " " + words[1];
    EXPECT_TRUE(says(later.err, "error: `bedload " + name + "` is not in this version"));
  }
}

TEST_F(BadInput, MistakesOnTheCommandLineComeWithAHint) {
  const auto misspelt = bedload(here(), {"rum", "tiny.toml"});
  EXPECT_TRUE(says(misspelt.err, "error: `bedload rum` is not a command\nhint: did you mean `bedload run`?"));
  const auto option = bedload(here(), {"run", "tiny.toml", "--fast"});
  EXPECT_TRUE(says(option.err, "error: "));
  EXPECT_TRUE(says(option.err, "--fast"));
  EXPECT_TRUE(says(option.err, "hint: `bedload run --help`"));
  EXPECT_TRUE(says(bedload(here(), {"RUN", "tiny.toml"}).err, "hint: did you mean `bedload run`?"));
  const auto cores = bedload(here(), {"run", "tiny.toml", "--cores", "0"});
  EXPECT_EQ(cores.code, 2);
  EXPECT_TRUE(says(cores.err, "error: --cores: 0 is not a number of workers"));
}

TEST_F(BadInput, NoCaseToExplainWhereThereAreSeveral) {
  std::ofstream(here() / "tiny.toml") << tiny_study;
  const auto refused = bedload(here(), {"explain", "tiny.toml"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_EQ(refused.out, "");
  EXPECT_TRUE(says(refused.err,
                   "error: tiny.toml has 4 cases, and none is named\n"
                   "hint: bedload explain tiny.toml CASE; cases are d0.5mm-rho2000-s1, d0.5mm-rho3000-s1, "
                   "d0.6mm-rho2000-s1, d0.6mm-rho3000-s1; a glob such as"));
}

TEST_F(BadInput, NewStudyWhoseNameCannotBeADirectory) {
  for (const char* name : {"my study", "a/b", ".toml", "", ".hidden", "a\"b"}) {
    const auto outcome = bedload(here(), {"new", name});
    EXPECT_EQ(outcome.code, 2) << name;
    EXPECT_TRUE(says(outcome.err, "cannot be the name of a study")) << name;
  }
  EXPECT_EQ(bedload(here(), {"new", "shields.toml"}).code, 0);
  EXPECT_EQ(bedload(here(), {"plan", "shields.toml"}).code, 0);
}

TEST_F(BadInput, StudyLockedByALiveProcess) {
  ASSERT_EQ(run(tiny_study, {"--prepare"}).code, 0);
  const auto before = contents(here() / "tiny" / "study.toml");
  const auto lock = FileLock::try_lock(here() / "tiny" / "lock");
  ASSERT_TRUE(lock);
  const auto outcome = run(with(tiny_study, "ratio = 1.5", "ratio = 1.6"));
  EXPECT_EQ(outcome.code, 73);
  const std::regex holder("in use by pid " + std::to_string(::getpid()) + R"( on host \S+, for \d+ s)");
  EXPECT_TRUE(std::regex_search(outcome.err, holder)) << outcome.err;
  EXPECT_EQ(contents(here() / "tiny" / "study.toml"), before);
}

TEST_F(BadInput, DatabaseOfANewerVersion) {
  ASSERT_EQ(run(tiny_study, {"--prepare"}).code, 0);
  for (const char* end : {"-wal", "-shm"}) std::filesystem::remove((here() / "tiny" / "study.db").string() + end);
  // PRAGMA user_version stands at byte 60 of an SQLite file, big-endian.
  std::fstream file(here() / "tiny" / "study.db", std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(60).write("\0\0\3\347", 4);
  file.close();
  const auto before = contents(here() / "tiny" / "study.db");
  const auto outcome = run(tiny_study);
  EXPECT_EQ(outcome.code, 76) << outcome.err;
  EXPECT_TRUE(says(outcome.err, "of a newer bedload"));
  EXPECT_EQ(contents(here() / "tiny" / "study.db"), before);
}

TEST_F(BadInput, QueryThatWrites) {
  ASSERT_EQ(run(tiny_study, {"--prepare"}).code, 0);
  EXPECT_EQ(bedload(here(), {"query", "tiny.toml", "DELETE FROM cases"}).code, 2);
  const auto outcome =
      bedload(here(), {"query", "tiny.toml", "SELECT count(*) AS n FROM cases WHERE kind = 'case'", "--csv"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.out, "n\n4\n");
}

TEST_F(BadInput, StudyWhoseCasesWouldAllBeDropped) {
  ASSERT_EQ(run(tiny_study, {"--prepare"}).code, 0);
  const auto changed = with(tiny_study, "dwell = \"5 td\"", "dwell = \"6 td\"");
  const auto outcome = run(changed, {"--prepare"});
  EXPECT_EQ(outcome.code, 65);
  EXPECT_TRUE(says(outcome.err, "--replace"));
  EXPECT_EQ(run(changed, {"--prepare", "--replace"}).code, 0);
}

}   // namespace
}   // namespace bedload

// The life of a study: run, run again, changed, extended, moved, rebuilt.
#include <gtest/gtest.h>

#include <sys/resource.h>

#include <algorithm>
#include <regex>

#include "base/durable_file.hpp"
#include "scheduler/attempt.hpp"
#include "tests/end_to_end/bedload_program.hpp"
#include "tests/end_to_end/tiny_study.hpp"
#include "tests/support/temporary_directory.hpp"

namespace bedload {
namespace {

namespace fs = std::filesystem;

/// One case that takes a second.
const std::string small_study =
    with(with(with(with(with(with(tiny_study, "[\"0.5 mm\", \"0.6 mm\"]", "\"0.5 mm\""),
                             "[\"2000 kg/m3\", \"3000 kg/m3\"]", "[\"3000 kg/m3\"]"),
                        "count = 300", "count = 100"),
                   "length = \"10 d\"", "length = \"6 d\""),
              "shields = { from = 0.1, ratio = 1.5, steps = 4 }", "shields = { from = 0.01, ratio = 1.1, steps = 2 }"),
         "dwell = \"5 td\"", "dwell = \"1 td\"");

class StudyLife : public testing::Test {
 protected:
  Outcome run(const std::string& study, std::vector<std::string> more = {}) {
    std::ofstream(here() / "tiny.toml") << study;
    more.insert(more.begin(), {"run", "tiny.toml", "--cores", "2"});
    return bedload(here(), more);
  }
  int attempts(const std::string& label) const {
    int n = 0;
    while (fs::exists(here() / "tiny" / "by-label" / label / ("attempt." + std::to_string(n + 1) + ".json"))) ++n;
    return n;
  }
  std::string digest(const std::string& label) const {
    return bedload(here(), {"inspect", "tiny/by-label/" + label, "--digest"}).out;
  }
  std::string csv() const { return bedload(here(), {"curve", "tiny.toml", "--csv"}).out; }
  const fs::path& here() const { return directory_.path(); }

 private:
  TemporaryDirectory directory_;
};

TEST_F(StudyLife, RunsNothingWhenFinishedAndOnlyWhatIsNew) {
  ASSERT_EQ(run(small_study).code, 0);
  EXPECT_EQ(attempts("rho3000-s1"), 1);
  const auto first = csv();
  ASSERT_EQ(run(small_study).code, 0);
  EXPECT_EQ(attempts("rho3000-s1"), 1);
  EXPECT_EQ(csv(), first);

  ASSERT_EQ(run(with(small_study, "[\"3000 kg/m3\"]", "[\"3000 kg/m3\", \"2500 kg/m3\"]")).code, 0);
  EXPECT_EQ(attempts("rho3000-s1"), 1);
  EXPECT_EQ(attempts("rho2500-s1"), 1);
  EXPECT_EQ(std::ranges::count(csv(), '\n'), 3);   // heading and two sets

  ASSERT_EQ(run(with(small_study, "[\"3000 kg/m3\"]", "[\"2500 kg/m3\"]")).code, 0);   // one is dropped
  EXPECT_EQ(std::ranges::count(csv(), '\n'), 2);
}

TEST_F(StudyLife, ContinuesTheFinalCheckpointWhenTheRampGrowsLonger) {
  ASSERT_EQ(run(small_study).code, 0);
  const auto plan = [&] { return bedload(here(), {"plan", "tiny.toml", "--csv"}).out; };
  const auto longer = with(small_study, "steps = 2", "steps = 4");
  std::ofstream(here() / "tiny.toml") << longer;
  EXPECT_NE(plan().find("extended"), std::string::npos) << plan();
  ASSERT_EQ(run(longer).code, 0);
  EXPECT_EQ(attempts("rho3000-s1"), 2);
  const auto continued = digest("rho3000-s1");
  fs::rename(here() / "tiny", here() / "earlier");
  ASSERT_EQ(run(longer).code, 0);
  EXPECT_EQ(attempts("rho3000-s1"), 1);
  EXPECT_EQ(digest("rho3000-s1"), continued);
}

TEST_F(StudyLife, RecomputesResultsWithoutRunningWhenTheCriterionChanges) {
  ASSERT_EQ(run(small_study).code, 0);
  const std::vector<std::string> query{"query", "tiny.toml", "SELECT value FROM thresholds WHERE decides", "--csv"};
  EXPECT_EQ(bedload(here(), query).out, "value\n0.01\n");
  ASSERT_EQ(run(small_study + "[onset]\nvalue = 0.5\n").code, 0);
  EXPECT_EQ(bedload(here(), query).out, "value\n0.5\n");
  EXPECT_EQ(attempts("rho3000-s1"), 1);
}

TEST_F(StudyLife, RebuildsTheDatabaseFromTheDirectories) {
  ASSERT_EQ(run(small_study).code, 0);
  const auto before = csv();
  ASSERT_EQ(run(small_study, {"--rescan"}).code, 0);
  EXPECT_EQ(csv(), before);
  EXPECT_EQ(attempts("rho3000-s1"), 1);
}

TEST_F(StudyLife, GoesOnAfterTheResultDirectoryWasMoved) {
  ASSERT_EQ(run(small_study).code, 0);
  const auto before = csv();
  fs::create_directory(here() / "elsewhere");
  fs::rename(here() / "tiny", here() / "elsewhere" / "moved");
  EXPECT_EQ(bedload(here(), {"curve", "elsewhere/moved", "--csv"}).out, before);
  EXPECT_EQ(bedload(here(), {"run", "elsewhere/moved"}).code, 0);
  EXPECT_EQ(bedload(here(), {"status", "elsewhere/moved"}).code, 0);
}

TEST_F(StudyLife, StopsAtCtrlCWithACheckpointAndGoesOnToTheSameBits) {
  const auto slow = with(small_study, "dwell = \"1 td\"", "dwell = \"30 td\"");
  std::ofstream(here() / "tiny.toml") << slow;
  Process first(here(), {"run", "tiny.toml", "--cores", "2"});
  const auto log = here() / "tiny" / "by-label" / "rho3000-s1" / "status.json";
  for (int n = 0; n < 1000 && !fs::exists(log); ++n) ::usleep(10'000);
  ::kill(first.pid(), SIGINT);
  const auto stopped = first.wait();
  EXPECT_EQ(stopped.code, 75) << stopped.err;
  EXPECT_NE(stopped.err.find("stopping"), std::string::npos) << stopped.err;
  ASSERT_EQ(run(slow).code, 0);
  EXPECT_EQ(attempts("rho3000-s1"), 2);
  const auto resumed = digest("rho3000-s1");
  fs::rename(here() / "tiny", here() / "earlier");
  ASSERT_EQ(run(slow).code, 0);
  EXPECT_EQ(digest("rho3000-s1"), resumed);
}

TEST_F(StudyLife, AdoptsWorkersThatOutlivedAKilledScheduler) {
  const auto slow = with(small_study, "dwell = \"1 td\"", "dwell = \"30 td\"");
  std::ofstream(here() / "tiny.toml") << slow;
  {
    Process killed(here(), {"run", "tiny.toml", "--cores", "2"});
    const auto heartbeat = here() / "tiny" / "by-label" / "rho3000-s1" / "status.json";
    for (int n = 0; n < 1000 && !fs::exists(heartbeat); ++n) ::usleep(10'000);
  }   // SIGKILL
  const auto second = run(slow);
  EXPECT_EQ(second.code, 0) << second.err;
  EXPECT_NE(second.err.find("rho3000-s1: at work already, pid "), std::string::npos) << second.err;
  EXPECT_EQ(attempts("rho3000-s1"), 1);
}

TEST_F(StudyLife, TriesAFailedCaseAgainOnlyWhenAsked) {
  ASSERT_EQ(run(small_study, {"--prepare"}).code, 0);
  const auto directory = here() / "tiny" / "by-label" / "rho3000-s1";
  close_attempt(directory, open_attempt(directory), Cause::numerical, "made up");
  const auto failed = run(small_study);
  EXPECT_EQ(failed.code, 1) << failed.err;
  EXPECT_EQ(attempts("rho3000-s1"), 1);
  EXPECT_NE(bedload(here(), {"explain", "tiny.toml", "rho3000-s1"}).out.find("it failed (numerical: made up)"),
            std::string::npos);
  EXPECT_EQ(bedload(here(), {"retry", "tiny.toml"}).code, 0);
  const auto again = run(small_study);
  EXPECT_EQ(again.code, 0) << again.err;
}

TEST_F(StudyLife, KeepsHowTheStepsOfAFailedCaseWent) {
  const auto study = with(small_study, "count = 100", "source = \"none\"");
  ASSERT_EQ(run(study, {"--prepare"}).code, 0);
  const auto directory = here() / "tiny" / "by-label" / "rho3000";
  ASSERT_EQ(bedload(here(), {"case", "tiny/by-label/rho3000", "--until", "1 ms"}).code, 0);
  close_attempt(directory, open_attempt(directory), Cause::numerical, "made up");
  EXPECT_EQ(run(study).code, 1);
  const auto sql = "SELECT state, hold, steps > 0 AS stepped FROM step_health JOIN cases USING (case_id)";
  EXPECT_EQ(bedload(here(), {"query", "tiny.toml", sql, "--csv"}).out, "state,hold,stepped\nfailed,0,1\n");
}

TEST_F(StudyLife, RunsAPreparedCaseByHand) {
  ASSERT_EQ(run(with(small_study, "count = 100", "source = \"none\""), {"--prepare"}).code, 0);
  const auto label = "tiny/by-label/rho3000";
  const auto until = bedload(here(), {"case", label, "--until", "1 ms"});
  EXPECT_EQ(until.code, 0) << until.err;
  EXPECT_NE(until.out.find("run it again to go on"), std::string::npos) << until.out;
  EXPECT_NE(until.out.find("model seconds per hour"), std::string::npos);
  EXPECT_EQ(bedload(here(), {"case", label}).code, 0);
  EXPECT_EQ(bedload(here(), {"case", label}).out, "finished already\n");
  EXPECT_EQ(bedload(here(), {"case", "nowhere"}).code, 66);
}

TEST_F(StudyLife, StartsFromTheTemplateOfNew) {
  ASSERT_EQ(bedload(here(), {"new", "shields"}).code, 0);
  const auto plan = bedload(here(), {"plan", "shields.toml"});
  EXPECT_EQ(plan.code, 0) << plan.err;
  EXPECT_NE(plan.out.find("4 cases (4 new"), std::string::npos) << plan.out;
  EXPECT_NE(plan.out.find("a ramp ends two holds after onset"), std::string::npos) << plan.out;
  EXPECT_FALSE(fs::exists(here() / "shields"));
  EXPECT_EQ(bedload(here(), {"new", "shields"}).code, 2);
}

TEST_F(StudyLife, CountsOneAsOne) {
  const auto one = run(small_study, {"--prepare"});
  EXPECT_NE(one.err.find("1 case prepared in "), std::string::npos) << one.err;
  EXPECT_NE(bedload(here(), {"plan", "tiny.toml"})
                .out.find("tiny: 1 case (0 new, 1 kept, 0 extended; 0 done), 0 dropped, "
                          "1 bed; "),
            std::string::npos);
}

TEST_F(StudyLife, ExplainsACase) {
  ASSERT_EQ(run(small_study).code, 0);
  const auto explained = bedload(here(), {"explain", "tiny.toml", "rho3000-s1"});
  EXPECT_EQ(explained.code, 0);
  for (const auto* part : {"it is done and is reused", "attempt 1", "viscous_torque", "Galileo number", "DEM step"})
    EXPECT_NE(explained.out.find(part), std::string::npos) << part << "\n" << explained.out;
  EXPECT_EQ(bedload(here(), {"explain", "tiny.toml", "rho9"}).code, 66);
}

TEST_F(StudyLife, ExplainsTheOnlyCaseUnnamed) {
  std::ofstream(here() / "tiny.toml") << small_study;
  const auto unnamed = bedload(here(), {"explain", "tiny.toml"});
  EXPECT_EQ(unnamed.code, 0) << unnamed.err;
  EXPECT_NE(unnamed.out.find("Galileo number"), std::string::npos) << unnamed.out;
  EXPECT_EQ(unnamed.out, bedload(here(), {"explain", "tiny.toml", "rho3000-s1"}).out);
}

TEST_F(StudyLife, PlansModelsAndNumbersOfEveryCaseInOrderOfTheStudy) {
  // light grains carry liquid along, and decide otherwise than heavy ones
  const auto axis = with(small_study, "[\"3000 kg/m3\"]", "[\"9000 kg/m3\", \"2000 kg/m3\", \"4000 kg/m3\"]");
  std::ofstream(here() / "tiny.toml") << axis;
  const auto plan = bedload(here(), {"plan", "tiny.toml"}).out;
  const auto heavy = plan.find("Models of rho9000-s1:\n"), light = plan.find("Models of rho2000-s1 and 1 more (");
  EXPECT_LT(heavy, light) << plan;
  EXPECT_NE(light, plan.npos) << plan;
  const auto group = plan.substr(std::min(light, plan.size()));
  EXPECT_NE(group.find("0.25 ... 0.5 "), group.npos) << group;   // 1/s
  EXPECT_TRUE(std::regex_search(group, std::regex("density ratio s +2 \\.\\.\\. 4\n"))) << group;
  EXPECT_NE(group.find("terms = [\"drag\", \"buoyancy\", "), group.npos) << group;
  EXPECT_NE(group.find("warning: rho9000-s1 and 2 more: a bed "), group.npos) << group;
}

TEST_F(StudyLife, PlansWithWhatDimensionlessGroupsPicked) {
  const auto groups = with(small_study, "density = [\"3000 kg/m3\"]", "density_ratio = [3, 2.65]");
  std::ofstream(here() / "tiny.toml") << groups;
  const auto plan = bedload(here(), {"plan", "tiny.toml"});
  EXPECT_EQ(plan.code, 0) << plan.err;
  const auto picked = plan.out.substr(std::min(plan.out.size(), plan.out.find("Picked by dimensionless groups:")));
  for (const auto* part : {"sg3 ", "3000 kg/m3", "sg2.65", "2650 kg/m3"})
    EXPECT_NE(picked.find(part), picked.npos) << plan.out;
  std::ofstream(here() / "tiny.toml") << small_study;
  EXPECT_EQ(bedload(here(), {"plan", "tiny.toml"}).out.find("Picked"), plan.out.npos);
}

// A shallow bed, and terms left out that the rules want.
TEST_F(StudyLife, SaysBeforeItRunsWhereItsScenesAreOutOfRangeAndKeepsThat) {
  const auto axis = with(small_study, "[\"3000 kg/m3\"]", "[\"3000 kg/m3\", \"2900 kg/m3\"]");
  const auto study = with(axis, "[drive]", "[models]\nterms = [\"drag\", \"buoyancy\"]\n[drive]");
  const auto ran = run(study);
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto first = ran.err.find("started");
  for (const auto* part : {"warning: rho3000-s1 and 1 more: a bed ", "models.terms leaves out what the rules want"})
    EXPECT_LT(ran.err.find(part), first) << part << "\n" << ran.err;
  const auto kept = bedload(here(), {"query", "tiny.toml",
                                     "SELECT label, text FROM warnings JOIN cases USING (case_id) WHERE text LIKE "
                                     "'a bed % d deep feels the flat bottom%' ORDER BY label",
                                     "--csv"});
  EXPECT_EQ(std::ranges::count(kept.out, '\n'), 3) << kept.out << kept.err;
  EXPECT_NE(contents(here() / "tiny" / "report.html").find("Range and missing terms"), std::string::npos);
  const auto before = bedload(here(), {"query", "tiny.toml", "SELECT * FROM warnings ORDER BY 1, 2", "--csv"}).out;
  ASSERT_EQ(run(study, {"--rescan"}).code, 0);
  EXPECT_EQ(bedload(here(), {"query", "tiny.toml", "SELECT * FROM warnings ORDER BY 1, 2", "--csv"}).out, before);
}

TEST_F(StudyLife, EndsWithTheCommandThatShowsItsThresholdsIfItHasAny) {
  const auto ran = run(small_study, {"--out", "elsewhere"});
  EXPECT_NE(ran.err.find("bedload curve elsewhere shows the thresholds"), std::string::npos) << ran.err;
  EXPECT_EQ(bedload(here(), {"curve", "elsewhere"}).code, 0);
  const auto still = run(with(small_study, "[drive]", "[onset]\nmethod = \"none\"\n[drive]"));
  EXPECT_EQ(still.code, 0) << still.err;
  EXPECT_EQ(still.err.find("bedload curve"), std::string::npos) << still.err;
  const auto curve = bedload(here(), {"curve", "tiny.toml"});
  EXPECT_NE(curve.err.find("no case of this study has a ramp"), std::string::npos) << curve.err;
  EXPECT_EQ(curve.code, 0);
  EXPECT_EQ(curve.out, "");
}

TEST_F(StudyLife, WritesAReport) {
  ASSERT_EQ(run(small_study).code, 0);
  EXPECT_NE(contents(here() / "tiny" / "report.html").find("<svg"), std::string::npos);
  fs::remove(here() / "tiny" / "report.html");
  EXPECT_EQ(bedload(here(), {"report", "tiny.toml"}).out, "tiny/report.html\n");
  EXPECT_NE(contents(here() / "tiny" / "report.html").find("<svg"), std::string::npos);
  EXPECT_NE(contents(here() / "tiny" / "report.html").find("<p class='moment'>at rest</p>"), std::string::npos);
}

void damage(const fs::path& file) {
  std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
  bytes.seekp(5000).write("damaged", 7);
}

std::vector<fs::path> checkpoints_of(const fs::path& directory) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(directory))
    if (entry.path().filename().string().starts_with("ck-")) found.push_back(entry.path());
  return found;
}

TEST_F(StudyLife, ReportsAndInspectsDamagedCheckpointsWithoutTouchingThem) {
  ASSERT_EQ(run(small_study).code, 0);
  const auto directory = here() / "tiny" / "by-label" / "rho3000-s1";
  const auto files = checkpoints_of(directory);
  for (const auto& file : files) damage(file);
  const auto report = bedload(here(), {"report", "tiny.toml"});
  EXPECT_EQ(report.code, 0) << report.err;
  EXPECT_NE(report.err.find("no picture of rho3000-s1 in motion"), std::string::npos) << report.err;
  const auto inspected = bedload(here(), {"inspect", "tiny/by-label/rho3000-s1"});
  EXPECT_EQ(inspected.code, 76) << inspected.err;
  for (const auto& file : files) {
    EXPECT_TRUE(fs::exists(file)) << file;
    EXPECT_NE(inspected.err.find(file.filename().string()), std::string::npos) << inspected.err;
  }
}

TEST_F(StudyLife, CountsTheCpuTimeOfAWorkerAndNotTheTimeThatItStoodStill) {
  const auto spent = [] {   // by the children that were waited for, and theirs
    struct rusage usage {};
    ::getrusage(RUSAGE_CHILDREN, &usage);
    const auto seconds = [](const timeval& t) {
      return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
  };
  std::ofstream(here() / "tiny.toml") << with(small_study, "dwell = \"1 td\"", "dwell = \"30 td\"");
  const double before = spent();
  Process scheduler(here(), {"run", "tiny.toml", "--cores", "2"});
  const auto directory = here() / "tiny" / "by-label" / "rho3000-s1";
  for (int n = 0; n < 1000 && !fs::exists(directory / "status.json"); ++n) ::usleep(10'000);
  const auto worker = FileLock::holder(directory / "lock");
  ASSERT_TRUE(worker);
  ::kill(static_cast<pid_t>(worker->pid), SIGSTOP);
  ::usleep(1'500'000);   // the claim is about time that passes
  ::kill(static_cast<pid_t>(worker->pid), SIGCONT);
  ::kill(scheduler.pid(), SIGINT);
  scheduler.wait();
  const double core_seconds = read_attempts(directory).at(0).core_seconds;
  EXPECT_GT(core_seconds, 0);
  EXPECT_LE(core_seconds, spent() - before);
}

TEST_F(StudyLife, StopsWhatIsAtWorkAndSaysWhenNothingIs) {
  std::ofstream(here() / "tiny.toml") << with(small_study, "dwell = \"1 td\"", "dwell = \"100 td\"");
  Process scheduler(here(), {"run", "tiny.toml", "--cores", "2"});
  const auto directory = here() / "tiny" / "by-label" / "rho3000-s1";
  for (int n = 0; n < 1000 && !fs::exists(directory / "status.json"); ++n) ::usleep(10'000);
  const auto stop = bedload(here(), {"stop", "tiny.toml"});
  EXPECT_EQ(stop.code, 0);
  EXPECT_NE(stop.err.find("1 at work asked to write a checkpoint and stop"), std::string::npos) << stop.err;
  EXPECT_EQ(scheduler.wait().code, 75);
  fs::remove(directory / "request");
  const auto again = bedload(here(), {"stop", "tiny.toml"});
  EXPECT_EQ(again.code, 0);
  EXPECT_NE(again.err.find("nothing of tiny.toml is at work"), std::string::npos) << again.err;
  EXPECT_FALSE(fs::exists(directory / "request"));
}

}   // namespace
}   // namespace bedload

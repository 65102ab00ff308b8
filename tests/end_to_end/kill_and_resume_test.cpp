// Scheduler and workers killed in the middle of whatever they do: the study that is run again gives the same bits.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <map>
#include <random>
#include <thread>

#include "base/durable_file.hpp"
#include "checkpoint/checkpoint_series.hpp"
#include "scheduler/attempt.hpp"
#include "tests/end_to_end/bedload_program.hpp"
#include "tests/end_to_end/tiny_study.hpp"
#include "tests/support/temporary_directory.hpp"

namespace bedload {
namespace {

namespace fs = std::filesystem;
using Seconds = std::chrono::duration<double>;

constexpr double most_of_two_cores = 2 * 20;   // [core s] an undisturbed run of 20 s

/// Checkpoints so often that a killed case has one to go on from.
const std::string often_saved = with(tiny_study, "checkpoint.every = \"1 s\"", "checkpoint.every = \"0.2 s\"");

/// Searches for onset and stop in up to three packings, two of which are run before it is asked whether they are enough.
std::string searched() {
  auto text = with(often_saved, "diameter = [\"0.5 mm\", \"0.6 mm\"]", "diameter = \"0.5 mm\"");
  text = with(text, "density = [\"2000 kg/m3\", \"3000 kg/m3\"]", "density = \"2000 kg/m3\"");
  text = with(text, "count = 300", "count = 200\nseed = { count = 3 }");
  text = with(text, "length = \"10 d\"", "length = \"8 d\"");
  return with(text, "[run]",
              "[onset]\nmethod = \"bisect\"\nbracket = 0.5\nhold = \"4 td\"\ninterval = \"30 %\"\nbatch = "
              "2\n\n[record]\nevery = \"0.4 td\"\n\n[run]");
}

/// The same of beds that are sheared before.
std::string sheared() {
  return with(searched(), "seed = { count = 3 }", "seed = { count = 3 }\nshear = { shields = 0.04, time = \"20 td\" }");
}

struct KilledStudy {
  std::string name, text;
  std::size_t directories;   // of beds and cases
};
std::ostream& operator<<(std::ostream& out, const KilledStudy& study) { return out << study.name; }

class KillAndResume : public ::testing::TestWithParam<KilledStudy> {};
const std::vector<std::string> run_command{"run", "tiny.toml", "--cores", "2"};

std::vector<fs::path> directories_of(const fs::path& study) {
  std::vector<fs::path> found;
  for (const auto* kind : {"beds", "cases"})
    if (fs::exists(study / kind))
      for (const auto& entry : fs::directory_iterator(study / kind))
        found.push_back(fs::path(kind) / entry.path().filename());
  return found;
}

void kill_workers(const fs::path& study) {
  for (const auto& directory : directories_of(study))
    if (const auto holder = FileLock::holder(study / directory / "lock"))
      ::kill(static_cast<pid_t>(holder->pid), SIGKILL);
}

bool any_case_has_a_checkpoint(const fs::path& study_directory) {
  for (const auto& directory : directories_of(study_directory))
    if (directory.parent_path() == "cases" && newest_position(study_directory / directory)) return true;
  return false;
}

void kill_all(Process& scheduler, const fs::path& study_directory) {
  ::kill(scheduler.pid(), SIGKILL);
  kill_workers(study_directory);
  scheduler.wait();
}

/// Processor time of all that this process has started and seen end, and of all that those have. [s]
/// The clock on the wall says as much of what else the machine does.
double core_seconds_of_children() {
  rusage used{};
  ::getrusage(RUSAGE_CHILDREN, &used);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

/// Attempts that went on from a checkpoint beyond the bed on which the undisturbed run began.
int resumed_attempts(const fs::path& disturbed, const fs::path& quiet) {
  int resumed = 0;
  for (const auto& directory : directories_of(disturbed)) {
    const auto bed = read_attempts(quiet / directory).at(0).from_step.value();
    for (const auto& attempt : read_attempts(disturbed / directory)) resumed += attempt.from_step.value_or(0) > bed;
  }
  return resumed;
}

/// Digest of the final state of every bed and case.
std::map<std::string, std::string> digests(const fs::path& here) {
  std::map<std::string, std::string> found;
  for (const auto& directory : directories_of(here / "tiny"))
    found[directory] = bedload(here, {"inspect", "tiny" / directory, "--digest"}).out;
  return found;
}

/// The bed at onset that each case keeps to be looked at.
std::map<std::string, std::string> beds_at_onset(const fs::path& study) {
  std::map<std::string, std::string> found;
  for (const auto& directory : directories_of(study))
    if (fs::exists(study / directory / "onset.h5")) found[directory] = contents(study / directory / "onset.h5");
  return found;
}

TEST_P(KillAndResume, GivesTheSameBitsAsAnUndisturbedRun) {
  TemporaryDirectory quiet, disturbed;
  for (const auto* directory : {&quiet, &disturbed}) std::ofstream(directory->path() / "tiny.toml") << GetParam().text;

  const double spent_before = core_seconds_of_children();
  const auto begun = std::chrono::steady_clock::now();
  const auto undisturbed = bedload(quiet.path(), run_command);
  ASSERT_EQ(undisturbed.code, 0) << undisturbed.err;
  const double duration = Seconds(std::chrono::steady_clock::now() - begun).count();
  EXPECT_LE(core_seconds_of_children() - spent_before, most_of_two_cores);
  const auto results = disturbed.path() / "tiny";

  {   // one death that must cost no more than what came after the first checkpoint of a case
    Process scheduler(disturbed.path(), run_command);
    for (int n = 0; n < 6000 && !any_case_has_a_checkpoint(results); ++n) std::this_thread::sleep_for(Seconds(0.01));
    kill_all(scheduler, results);
  }

  const auto seed = std::random_device()();
  RecordProperty("seed", static_cast<int>(seed));
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> moment(0.05 * duration, 0.45 * duration);
  for (int round = 0; round < 2; ++round) {
    Process scheduler(disturbed.path(), run_command);
    std::this_thread::sleep_for(Seconds(moment(random)));   // the claim is about any moment
    kill_all(scheduler, results);
  }
  const auto resumed = bedload(disturbed.path(), run_command);
  ASSERT_EQ(resumed.code, 0) << "seed " << seed << ": " << resumed.err;
  EXPECT_GT(resumed_attempts(results, quiet.path() / "tiny"), 0) << "every attempt began on its bed again";

  const std::vector<std::string> curve{"curve", "tiny.toml", "--csv"};
  EXPECT_EQ(bedload(quiet.path(), curve).out, bedload(disturbed.path(), curve).out) << "seed " << seed;
  const auto expected = digests(quiet.path()), got = digests(disturbed.path());
  EXPECT_EQ(expected.size(), GetParam().directories);
  EXPECT_EQ(expected, got) << "seed " << seed;
  const auto at_onset = beds_at_onset(quiet.path() / "tiny");
  EXPECT_FALSE(at_onset.empty());
  EXPECT_TRUE(at_onset == beds_at_onset(results)) << "seed " << seed;
}

INSTANTIATE_TEST_SUITE_P(Studies, KillAndResume,
                         ::testing::Values(KilledStudy{"ramps", often_saved, 8}, KilledStudy{"searches", searched(), 6},
                                           KilledStudy{"sheared_beds", sheared(), 6}),
                         [](const auto& study) { return study.param.name; });

}   // namespace
}   // namespace bedload

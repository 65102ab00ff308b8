// Scheduler and workers killed in the middle of whatever they do: the study that is run again gives the same bits.
#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <random>
#include <thread>

#include "base/durable_file.hpp"
#include "tests/end_to_end/bedload_program.hpp"
#include "tests/end_to_end/tiny_study.hpp"
#include "tests/support/temporary_directory.hpp"

namespace bedload {
namespace {

namespace fs = std::filesystem;
using Seconds = std::chrono::duration<double>;

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

/// Digest of the final state of every bed and case.
std::map<std::string, std::string> digests(const fs::path& here) {
  std::map<std::string, std::string> found;
  for (const auto& directory : directories_of(here / "tiny"))
    found[directory] = bedload(here, {"inspect", "tiny" / directory, "--digest"}).out;
  return found;
}

TEST(KillAndResume, GivesTheSameBitsAsAnUndisturbedRun) {
  TemporaryDirectory quiet, disturbed;
  for (const auto* directory : {&quiet, &disturbed}) std::ofstream(directory->path() / "tiny.toml") << tiny_study;

  const auto begun = std::chrono::steady_clock::now();
  const auto undisturbed = bedload(quiet.path(), run_command);
  ASSERT_EQ(undisturbed.code, 0) << undisturbed.err;
  const double duration = Seconds(std::chrono::steady_clock::now() - begun).count();

  const auto seed = std::random_device()();
  RecordProperty("seed", static_cast<int>(seed));
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> moment(0.05 * duration, 0.45 * duration);
  for (int round = 0; round < 3; ++round) {
    Process scheduler(disturbed.path(), run_command);
    std::this_thread::sleep_for(Seconds(moment(random)));   // the claim is about any moment
    ::kill(scheduler.pid(), SIGKILL);
    kill_workers(disturbed.path() / "tiny");
    scheduler.wait();
  }
  const auto resumed = bedload(disturbed.path(), run_command);
  ASSERT_EQ(resumed.code, 0) << "seed " << seed << ": " << resumed.err;

  const std::vector<std::string> curve{"curve", "tiny.toml", "--csv"};
  EXPECT_EQ(bedload(quiet.path(), curve).out, bedload(disturbed.path(), curve).out) << "seed " << seed;
  const auto expected = digests(quiet.path()), got = digests(disturbed.path());
  EXPECT_EQ(expected.size(), 8u);
  EXPECT_EQ(expected, got) << "seed " << seed;
}

}   // namespace
}   // namespace bedload

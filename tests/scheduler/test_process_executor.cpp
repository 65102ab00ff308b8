// Real processes under the process executor.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <map>
#include <sstream>

#include "base/durable_file.hpp"
#include "base/error.hpp"
#include "scheduler/process_executor.hpp"
#include "tests/support/temporary_directory.hpp"

namespace bedload {
namespace {

namespace fs = std::filesystem;

/// Scripts leave to other programs as little as they can: a machine that has no room for one more process, or no time to
/// load it, is no fault of the executor's.
class Processes : public testing::Test {
 protected:
  /// Whatever was expected: what the processes wrote helps to see why it did not come.
  void TearDown() override {
    if (!HasFailure()) return;
    for (const auto& file : fs::recursive_directory_iterator(directory_))
      if (file.path().filename().string().starts_with("log."))
        std::cerr << file.path().string() << ":\n" << read_text(file.path()) << "(end)\n";
  }
  /// Runs a shell script whose $0 is the case directory until it ends.
  JobEnd run(const std::string& script, int attempt = 1) {
    ProcessExecutor executor({"/bin/sh", "-c", script});
    executor.start({directory_, attempt});
    return finish(executor);
  }
  static JobEnd finish(ProcessExecutor& executor) {
    const auto begun = Clock::now();
    while (Clock::now() < begun + patience)
      if (const auto ends = executor.wait(0.1); !ends.empty()) return ends[0];
    ADD_FAILURE() << "no end in " << patience.count() << " s";
    return {};
  }
  std::string log(int attempt) { return read_text(directory_ / ("log." + std::to_string(attempt))); }

  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds patience{50};   // a busy machine's; ctest's ends at 60 s, without the log

  InMemoryDirectory temporary_;
  fs::path directory_ = temporary_.path();
};

TEST_F(Processes, ReportTheirExitCode) {
  EXPECT_EQ(run("exit 0").exit_code, 0);
  const JobEnd end = run("exit 75");
  EXPECT_EQ(end.exit_code, 75);
  EXPECT_EQ(end.signal, 0);
}

TEST_F(Processes, ReportTheSignalThatEndedThem) { EXPECT_EQ(run("kill -SEGV $$").signal, SIGSEGV); }

TEST_F(Processes, WriteBothStreamsToTheLogOfTheirAttempt) {
  run("echo out; echo err >&2; echo $0", 3);
  EXPECT_EQ(log(3), "out\nerr\n" + directory_.string() + "\n");
}

TEST_F(Processes, HaveASessionAndATemporaryDirectoryOfTheirOwn) {
  const JobEnd end = run(R"(
    set -eu
    test -d "$TMPDIR"
    : > "$TMPDIR/left"
    read -r pid name state parent group session rest < /proc/$$/stat
    echo "$TMPDIR"
    echo "$$ $session")");
  ASSERT_EQ(end.exit_code, 0);
  std::istringstream text(log(1));
  std::string temporary;
  pid_t process = 0, session = 0;
  std::getline(text, temporary) >> process >> session;
  EXPECT_NE(temporary, fs::temp_directory_path());
  EXPECT_FALSE(temporary.empty());
  EXPECT_FALSE(fs::exists(temporary)) << "it goes with its worker";
  EXPECT_EQ(session, process) << "session leader";
  EXPECT_GT(process, 0);
}

TEST_F(Processes, HaveNothingToRead) { EXPECT_EQ(run("test /proc/$$/fd/0 -ef /dev/null").exit_code, 0); }

TEST_F(Processes, AreAskedToStopBySignal) {
  ProcessExecutor executor({"/bin/sh", "-c", "trap 'exit 75' USR1; : > $0/ready; while :; do sleep 0.01; done"});
  const JobId job = executor.start({directory_, 1});
  while (!fs::exists(directory_ / "ready")) ASSERT_TRUE(executor.wait(0.01).empty());
  executor.ask_to_stop(job);
  EXPECT_EQ(finish(executor).exit_code, 75);
}

TEST_F(Processes, AreKilledWithTheirChildren) {
  ProcessExecutor executor({"/bin/sh", "-c", "sleep 1000 & echo $! > $0/child; : > $0/ready; wait"});
  const JobId job = executor.start({directory_, 1});
  while (!fs::exists(directory_ / "ready")) ASSERT_TRUE(executor.wait(0.01).empty());
  const int child = std::stoi(read_text(directory_ / "child"));
  executor.kill(job);
  EXPECT_EQ(finish(executor).signal, SIGKILL);
  bool gone = false;   // or a zombie until its new parent has collected it
  for (int turn = 0; turn < 500 && !gone; ++turn, executor.wait(0.01)) {
    try {
      gone = read_text("/proc/" + std::to_string(child) + "/stat").find(") Z ") != std::string::npos;
    } catch (const Error&) {
      gone = true;
    }
  }
  EXPECT_TRUE(gone);
}

TEST_F(Processes, RunSideBySide) {
  ProcessExecutor executor({"/bin/sh", "-c", "read -r code < $0/code; exit $code"});
  std::map<JobId, int> expected, seen;
  for (int code = 10; code < 14; ++code) {
    const fs::path one = directory_ / std::to_string(code);
    fs::create_directories(one);
    publish(one / "code", std::to_string(code) + "\n");
    expected[executor.start({one, 1})] = code;
  }
  for (const auto begun = Clock::now(); seen.size() < expected.size() && Clock::now() < begun + patience;)
    for (const auto& end : executor.wait(0.1)) seen[end.job] = end.exit_code;
  EXPECT_EQ(seen, expected);
}

TEST_F(Processes, ThatCannotBeStartedAreAnError) {
  const auto kind_of_failure = [](const std::string& program, const fs::path& directory) {
    ProcessExecutor executor({program});
    try {
      executor.start({directory, 1});
    } catch (const Error& e) {
      EXPECT_TRUE(executor.wait(0).empty());
      return e.kind;
    }
    return ErrorKind::internal;
  };
  EXPECT_EQ(kind_of_failure("/no/such/program", directory_), ErrorKind::unavailable);
  EXPECT_EQ(kind_of_failure("/bin/true", directory_ / "nowhere"), ErrorKind::io);
}

}   // namespace
}   // namespace bedload

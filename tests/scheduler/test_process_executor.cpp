// Real processes under the process executor.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <map>

#include "base/durable_file.hpp"
#include "base/error.hpp"
#include "scheduler/process_executor.hpp"
#include "tests/support/temporary_directory.hpp"

namespace bedload {
namespace {

namespace fs = std::filesystem;

class Processes : public testing::Test {
 protected:
  /// Runs a shell script whose $0 is the case directory until it ends.
  JobEnd run(const std::string& script, int attempt = 1) {
    ProcessExecutor executor({"/bin/sh", "-c", script});
    executor.start({directory_, attempt});
    return finish(executor);
  }
  static JobEnd finish(ProcessExecutor& executor) {
    for (int turn = 0; turn < 100; ++turn)
      if (const auto ends = executor.wait(0.1); !ends.empty()) return ends[0];
    ADD_FAILURE() << "no end in 10 s";
    return {};
  }
  std::string log(int attempt) { return read_text(directory_ / ("log." + std::to_string(attempt))); }

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

TEST_F(Processes, HaveASessionAndAInMemoryDirectoryOfTheirOwn) {
  run("test -d $TMPDIR && touch $TMPDIR/left && echo $TMPDIR; cut -d' ' -f6 /proc/$$/stat; echo $$; cat");
  const std::string text = log(1);
  const auto first = text.find('\n'), second = text.find('\n', first + 1);
  const fs::path temporary = text.substr(0, first);
  EXPECT_NE(temporary, fs::temp_directory_path());
  EXPECT_FALSE(temporary.empty());
  EXPECT_FALSE(fs::exists(temporary)) << "it goes with its worker";
  EXPECT_EQ(text.substr(first + 1, second - first), text.substr(second + 1)) << "session leader";
}

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
  ProcessExecutor executor({"/bin/sh", "-c", "exit $(cat $0/code)"});
  std::map<JobId, int> expected, seen;
  for (int code = 10; code < 14; ++code) {
    const fs::path one = directory_ / std::to_string(code);
    fs::create_directories(one);
    publish(one / "code", std::to_string(code));
    expected[executor.start({one, 1})] = code;
  }
  for (int turn = 0; turn < 100 && seen.size() < expected.size(); ++turn)
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

// The fence of a case directory, and the small files beside it.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <set>

#include "base/durable_file.hpp"
#include "scheduler/attempt.hpp"
#include "scheduler/heartbeat.hpp"
#include "scheduler/last_words.hpp"
#include "scheduler/request.hpp"
#include "tests/support/temporary_directory.hpp"

namespace bedload {
namespace {

TEST(Attempts, KeepEverythingThatWasWritten) {
  const InMemoryDirectory directory;
  Attempt a = open_attempt(directory.path());
  EXPECT_EQ(a.number, 1);
  EXPECT_EQ(a.pid, ::getpid());
  EXPECT_FALSE(a.host.empty());
  EXPECT_FALSE(a.boot_id.empty());
  EXPECT_EQ(a.start.size(), 20u) << a.start;
  a.from_step = 1200;
  a.step = 1300;
  a.core_seconds = 12.5;
  a.version = "0.1.0";
  a.compiler = "GCC 12";
  close_attempt(directory.path(), a, Cause::numerical, "overlap of \"0.3\" d\n\xff");
  const auto read = read_attempts(directory.path());
  ASSERT_EQ(read.size(), 1u);
  EXPECT_EQ(read[0].cause, Cause::numerical);
  EXPECT_EQ(read[0].message.substr(0, 19), "overlap of \"0.3\" d\n");
  EXPECT_EQ(read[0].from_step, 1200u);
  EXPECT_EQ(read[0].step, 1300u);
  EXPECT_EQ(read[0].core_seconds, 12.5);
  EXPECT_EQ(read[0].version, "0.1.0");
  EXPECT_FALSE(read[0].end.empty());
}

TEST(Attempts, CountOnFromTheHighestNumber) {
  const InMemoryDirectory directory;
  for (int n = 1; n <= 12; ++n) EXPECT_EQ(open_attempt(directory.path()).number, n);   // 10 sorts before 2 as text
  EXPECT_EQ(highest_attempt(directory.path()), 12);
  std::ofstream(directory.path() / "attempt.x.json");
  std::ofstream(directory.path() / "attempt.99.json.tmp~");
  EXPECT_EQ(highest_attempt(directory.path()), 12);
  EXPECT_EQ(read_attempts(directory.path()).back().number, 12);
}

TEST(Attempts, GiveEveryNumberToOneOfTwoRacingProcesses) {
  const InMemoryDirectory directory;
  constexpr int wins_each = 25;
  std::vector<pid_t> rivals;
  for (int i = 0; i < 2; ++i) {
    const pid_t pid = ::fork();
    if (pid == 0) {
      for (int wins = 0; wins < wins_each;) try {
          open_attempt(directory.path());
          ++wins;
        } catch (const Error& e) {
          if (e.kind != ErrorKind::fenced) ::_exit(1);
        }
      ::_exit(0);
    }
    rivals.push_back(pid);
  }
  for (const pid_t pid : rivals) {
    int status = 1;
    ::waitpid(pid, &status, 0);
    EXPECT_EQ(status, 0);
  }
  const auto attempts = read_attempts(directory.path());
  ASSERT_EQ(attempts.size(), 2u * wins_each);
  int of_first = 0;
  for (std::size_t i = 0; i < attempts.size(); ++i) {
    EXPECT_EQ(attempts[i].number, static_cast<int>(i) + 1);
    of_first += attempts[i].pid == rivals[0];
  }
  EXPECT_EQ(of_first, wins_each);
}

TEST(Attempts, OfADirectoryThatIsNotThereAreNone) {
  EXPECT_EQ(highest_attempt("/no/such/directory"), 0);
  EXPECT_TRUE(read_attempts("/no/such/directory").empty());
}

TEST(Heartbeats, AreReadAsTheyWereWritten) {
  const InMemoryDirectory directory;
  EXPECT_FALSE(read_heartbeat(directory.path()));
  const Heartbeat h{4242, 7, 0.125, 2.5, "ramp", 3, 12, 0.0864, 210.5, 33.25};
  write_heartbeat(directory.path(), h);
  EXPECT_EQ(read_heartbeat(directory.path()), h);
}

TEST(Heartbeats, AreReadAsFarAsTheyGo) {
  const InMemoryDirectory directory;
  std::ofstream(directory.path() / "status.json") << R"({"step": 5, "of the future": []})";
  ASSERT_TRUE(read_heartbeat(directory.path()));
  EXPECT_EQ(read_heartbeat(directory.path())->step, 5u);
  std::ofstream(directory.path() / "status.json") << R"({"step": 5)";
  EXPECT_FALSE(read_heartbeat(directory.path()));
}

TEST(Heartbeats, ThatCannotBeWrittenEndNothing) { write_heartbeat("/no/such/directory", {}); }

TEST(LastWords, OfAWorkerAreThoseOfItsLastHeartbeat) {
  const InMemoryDirectory directory;
  Attempt attempt = open_attempt(directory.path());
  Heartbeat h;
  h.pid = attempt.pid;
  h.step = 7;
  h.core_seconds = 33.25;
  write_heartbeat(directory.path(), h);
  close_for_the_dead(directory.path(), attempt, Cause::killed, "found dead");
  const Attempt closed = read_attempts(directory.path()).at(0);
  EXPECT_EQ(closed.step, 7u);
  EXPECT_EQ(closed.core_seconds, 33.25);
  EXPECT_EQ(closed.cause, Cause::killed);
}

TEST(Requests, StandUntilTheyAreCleared) {
  const InMemoryDirectory directory;
  EXPECT_FALSE(read_request(directory.path()));
  for (const Request request : {Request::stop, Request::hold}) {
    write_request(directory.path(), request);
    EXPECT_EQ(read_request(directory.path()), request);
  }
  clear_request(directory.path());
  EXPECT_FALSE(read_request(directory.path()));
}

}   // namespace
}   // namespace bedload

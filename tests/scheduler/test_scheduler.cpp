// The scheduler, with scripted workers and a clock that is a number.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include "tests/scheduler/fake_world.hpp"

namespace bedload {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

TEST(Scheduler, TakesEveryCaseToItsEndInOrderAndWithinItsCores) {
  FakeStudy study;
  for (const char* id : {"a", "b", "c", "d", "e"}) study.add_case(id);
  const auto outcome = study.run();
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.done, 5);
  EXPECT_EQ(study.executor.started, (Names{"a", "b", "c", "d", "e"}));
  EXPECT_EQ(study.executor.most_at_once, 2u);
  EXPECT_EQ(study.harvested.size(), 5u);
  EXPECT_EQ(study.state_of("e"), "done");
}

TEST(Scheduler, RunsNothingOfAFinishedStudy) {
  FakeStudy study;
  study.add_bed("bed");
  study.add_case("a", "bed");
  study.run();
  study.harvested.clear();
  EXPECT_EQ(study.run().exit_code, 0);
  EXPECT_TRUE(study.executor.started.empty());
  EXPECT_TRUE(study.harvested.empty());
}

TEST(Scheduler, RunsOnlyTheCasesThatWereAdded) {
  FakeStudy study;
  study.add_case("a");
  study.run();
  study.add_case("b");
  EXPECT_EQ(study.run().done, 2);
  EXPECT_EQ(study.executor.started, Names{"b"});
}

TEST(Scheduler, RunsOnlyTheCasesThatWereAskedFor) {
  FakeStudy study;
  study.add_bed("bed");
  study.add_bed("other bed");
  study.add_case("a", "other bed");
  study.add_case("b", "bed");
  study.options.only = {"b"};
  EXPECT_EQ(study.run().exit_code, 0);
  EXPECT_EQ(study.executor.started, (Names{"bed", "b"}));
}

/// d is needed once a, b and c are done, e never.
Names spares_of_three(const Names& harvested) { return harvested.size() < 3 ? Names{"d", "e"} : Names{"e"}; }

TEST(Scheduler, LeavesSpareCasesAndTheirBedsUntilTheyAreNeeded) {
  FakeStudy study;
  study.spares = spares_of_three;
  for (const char* id : {"a", "b", "c"}) study.add_case(id);
  for (const char* id : {"d", "e"}) study.add_bed(std::string("bed of ") + id);
  for (const char* id : {"d", "e"}) study.add_case(id, std::string("bed of ") + id);
  const auto outcome = study.run();
  EXPECT_EQ(study.executor.started, (Names{"a", "b", "c", "bed of d", "d"}));
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.done, 4);
  EXPECT_EQ(outcome.left, 0);
  EXPECT_EQ(study.listener.last.cases, 4);
  EXPECT_EQ(study.state_of("e"), "spare");
}

TEST(Scheduler, StartsASpareCaseThatALaterRunNeeds) {
  FakeStudy study;
  study.spares = spares_of_three;
  for (const char* id : {"a", "b", "c", "d", "e"}) study.add_case(id);
  study.run();
  study.spares = nullptr;
  EXPECT_EQ(study.run().done, 5);
  EXPECT_EQ(study.executor.started, Names{"e"});
}

TEST(Scheduler, RunsASpareCaseThatIsAskedForByName) {
  FakeStudy study;
  study.spares = spares_of_three;
  for (const char* id : {"a", "b", "c", "d", "e"}) study.add_case(id);
  study.options.only = {"e"};
  EXPECT_EQ(study.run().done, 1);
  EXPECT_EQ(study.executor.started, Names{"e"});
  EXPECT_EQ(study.state_of("d"), "spare");
}

TEST(Scheduler, PreparesASharedBedOnceAndLinksItIntoItsCases) {
  FakeStudy study;
  study.add_case("a", "bed");
  study.add_case("b", "bed");
  study.add_case("lone");
  study.add_bed("bed");
  EXPECT_EQ(study.run().exit_code, 0);
  EXPECT_EQ(study.executor.started, (Names{"bed", "lone", "a", "b"}));
  EXPECT_TRUE(fs::exists(study.directory_of("a") / "bed.h5"));
  EXPECT_EQ(study.harvested.size(), 3u) << "a bed has no results";
}

TEST(Scheduler, PreparesNoBedForCasesThatHaveTheirs) {
  FakeStudy study;
  study.add_bed("bed");
  study.add_case("a", "bed");
  publish(study.directory_of("a") / "bed.h5", "a bed");
  EXPECT_EQ(study.run().exit_code, 0);
  EXPECT_EQ(study.executor.started, Names{"a"});
}

TEST(Scheduler, FailsTheCasesOfABedThatFailed) {
  FakeStudy study;
  study.add_bed("bed");
  study.add_case("a", "bed");
  study.add_case("b");
  study.executor.scripts["bed"] = {Act::error(Cause::user_error, 65)};
  const auto outcome = study.run();
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(outcome.failed, 1);
  EXPECT_EQ(outcome.done, 1) << "the others go on";
  EXPECT_EQ(study.state_of("a"), "failed");
}

TEST(Scheduler, RecordsWhatIsKnownOfACaseThatFailedButNotOfABed) {
  FakeStudy study;
  study.add_bed("bed");
  study.add_case("a");
  study.add_case("b");
  study.executor.scripts["bed"] = study.executor.scripts["a"] = {Act::error(Cause::numerical, 70)};
  EXPECT_EQ(study.run().exit_code, 1);
  EXPECT_EQ(study.failures, Names{"a"});
}

TEST(Scheduler, ResumesWhatWasInterrupted) {
  FakeStudy study;
  study.add_case("a");
  Attempt dead = open_attempt(study.directory_of("a"));   // by a worker that is no more
  dead.from_step = 0;
  write_attempt(study.directory_of("a"), dead);
  publish(study.directory_of("a") / "checkpoint", "40");
  EXPECT_EQ(study.run().exit_code, 0);
  const auto attempts = read_attempts(study.directory_of("a"));
  ASSERT_EQ(attempts.size(), 2u);
  EXPECT_EQ(attempts[0].cause, Cause::killed);
  EXPECT_EQ(attempts[1].from_step, 40u);
}

TEST(Scheduler, ResumesAtOnceHoweverOftenTheCaseWasKilledBefore) {
  FakeStudy study;
  study.add_case("a");
  for (int i = 0; i < 6; ++i) {
    Attempt dead = open_attempt(study.directory_of("a"));
    close_attempt(study.directory_of("a"), dead, Cause::killed);
  }
  const double before = study.executor.now;
  EXPECT_EQ(study.run().exit_code, 0);
  EXPECT_LE(study.executor.now - before, 11);   // the attempt itself takes 10 s
}

TEST(Scheduler, GoesOnAsLongAsKilledWorkersMakeProgress) {
  FakeStudy study;
  study.add_case("a");
  study.executor.scripts["a"] = std::deque<Act>(12, Act::killed(1));
  study.executor.scripts["a"].push_back(Act::finish());
  EXPECT_EQ(study.run().exit_code, 0);
  EXPECT_EQ(study.executor.started.size(), 13u);
}

TEST(Scheduler, GivesUpACaseKilledTenTimesWithoutProgress) {
  FakeStudy study;
  study.add_case("a");
  study.add_case("b");
  study.executor.scripts["a"] = {Act::killed(0)};
  const auto outcome = study.run();
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(outcome.done, 1);
  EXPECT_EQ(std::ranges::count(study.executor.started, "a"), 10);
  EXPECT_EQ(study.run().exit_code, 1) << "and does not start it at the next run";
  EXPECT_TRUE(study.executor.started.empty());
}

TEST(Scheduler, PausesLongerAfterEveryAttemptWithoutProgress) {
  FakeStudy study;
  study.add_case("a");
  study.executor.scripts["a"] = {Act::killed(0)};
  const double before = study.executor.now;
  study.run();
  const double pauses = study.executor.now - before - 10 * 10;   // ten attempts of 10 s
  EXPECT_GE(pauses, 1 + 2 + 4 + 8 + 16 + 32 + 60 + 60 + 60);
  EXPECT_LE(pauses, 1 + 2 + 4 + 8 + 16 + 32 + 60 + 60 + 60 + 10);   // half a second of waiting each
}

TEST(Scheduler, FailsACaseThatCrashesTwiceAtTheSameStep) {
  FakeStudy study;
  study.add_case("a");
  study.executor.scripts["a"] = {Act::crash(7), Act::crash(9), Act::crash(9), Act::finish()};
  EXPECT_EQ(study.run().exit_code, 1);
  EXPECT_EQ(study.executor.started.size(), 3u);
  EXPECT_TRUE(study.listener.heard("crashed twice at step 9: signal 11")) << study.listener.events.back();
}

TEST(Scheduler, DoesNotRepeatNumericalFailures) {
  FakeStudy study;
  study.add_case("a");
  study.executor.scripts["a"] = {Act::error(Cause::numerical, 80)};
  EXPECT_EQ(study.run().exit_code, 1);
  EXPECT_EQ(study.executor.started.size(), 1u);
}

TEST(Scheduler, BelievesAFinishedCheckpointOfAWorkerThatDied) {
  FakeStudy study;
  study.add_case("a");
  Act act = Act::finish();
  act.says.reset();
  act.end.signal = 11;
  study.executor.scripts["a"] = {act};
  EXPECT_EQ(study.run().exit_code, 0);
  EXPECT_EQ(study.executor.started.size(), 1u);
}

TEST(Scheduler, RecordsWorkersThatDiedBeforeTheirAttempt) {
  FakeStudy study;
  study.add_case("a");
  study.executor.scripts["a"] = {{0, false, {}, {0, 65, 0}, 0, 1, false, false}};
  EXPECT_EQ(study.run().exit_code, 1);
  const auto attempts = read_attempts(study.directory_of("a"));
  ASSERT_EQ(attempts.size(), 1u);
  EXPECT_EQ(attempts[0].cause, Cause::user_error);
  EXPECT_EQ(attempts[0].message, "exit code 65, see log.1");
}

TEST(Scheduler, SetsAsideWhatTheDiskRefusesAndTriesItAtTheNextRun) {
  FakeStudy study;
  study.add_case("a");
  study.add_case("b");
  study.executor.scripts["a"] = {Act::error(Cause::io, 74), Act::finish()};
  const auto outcome = study.run();
  EXPECT_EQ(outcome.exit_code, 74);
  EXPECT_EQ(outcome.done, 1);
  EXPECT_EQ(study.executor.started, (Names{"a", "b"}));
  EXPECT_EQ(study.run().exit_code, 0);
}

TEST(Scheduler, StopsWithWorkLeftAtTheFirstInterruptAndContinuesLater) {
  FakeStudy study;
  for (const char* id : {"a", "b", "c"}) study.add_case(id);
  study.executor.scripts["a"] = study.executor.scripts["b"] = {Act::work_until_asked(), Act::finish()};
  study.executor.at_turn = [&] { study.interrupts = study.executor.now > 1020; };
  const auto outcome = study.run();
  EXPECT_EQ(outcome.exit_code, 75);
  EXPECT_EQ(outcome.left, 3);
  EXPECT_EQ(study.executor.asked, (Names{"a", "b"})) << "each once";
  EXPECT_TRUE(study.executor.killed.empty());
  EXPECT_EQ(study.state_of("a"), "stopped");
  EXPECT_EQ(study.state_of("c"), "pending");
  study.executor.at_turn = nullptr;
  study.interrupts = 0;
  EXPECT_EQ(study.run().exit_code, 0);
  EXPECT_EQ(read_attempts(study.directory_of("a")).back().from_step, 5u);
}

TEST(Scheduler, KillsAtTheSecondInterrupt) {
  FakeStudy study;
  study.add_case("a");
  Act deaf = Act::work_until_asked();
  deaf.until_asked = false;
  study.executor.scripts["a"] = {deaf};
  study.executor.at_turn = [&] { study.interrupts = (study.executor.now > 1020) + (study.executor.now > 1040); };
  EXPECT_EQ(study.run().exit_code, 130);
  EXPECT_EQ(study.executor.killed, Names{"a"});
  EXPECT_LT(study.executor.now, 1050);
}

TEST(Scheduler, ContinuesAWorkerThatSomebodyElseStopped) {
  FakeStudy study;
  study.add_case("a");
  Act terminated = Act::error(Cause::stopped, 75);
  terminated.gains = 3;
  study.executor.scripts["a"] = {terminated, Act::finish()};
  EXPECT_EQ(study.run().exit_code, 0);
  EXPECT_EQ(study.executor.started.size(), 2u);
}

TEST(Scheduler, LeavesACaseOnHoldUntilItsRequestIsCleared) {
  FakeStudy study;
  study.add_case("a");
  study.add_case("b");
  write_request(study.directory_of("a"), Request::hold);
  write_request(study.directory_of("b"), Request::stop);   // of an earlier run
  EXPECT_EQ(study.run().exit_code, 75);
  EXPECT_EQ(study.executor.started, Names{"b"});
  EXPECT_EQ(study.state_of("a"), "stopped");
  clear_request(study.directory_of("a"));
  EXPECT_EQ(study.run().exit_code, 0);
}

TEST(Scheduler, KillsASilentWorkerAndContinuesIt) {
  FakeStudy study;
  study.add_case("a");
  Act silent;
  silent.beats = false;
  silent.lasts = 1e9;
  study.executor.scripts["a"] = {silent, Act::finish()};
  const double before = study.executor.now;
  EXPECT_EQ(study.run().exit_code, 0);
  EXPECT_EQ(study.executor.killed, Names{"a"});
  EXPECT_GE(study.executor.now - before, study.options.stall_limit);
  EXPECT_LE(study.executor.now - before, study.options.stall_limit + 20);
  EXPECT_EQ(read_attempts(study.directory_of("a"))[0].message, "it was silent");
}

TEST(Scheduler, LeavesALongWorkerWithAHeartbeatAlone) {
  FakeStudy study;
  study.add_case("a");
  Act slow = Act::finish();
  slow.lasts = 3 * study.options.stall_limit;
  study.executor.scripts["a"] = {slow};
  EXPECT_EQ(study.run().exit_code, 0);
  EXPECT_TRUE(study.executor.killed.empty());
}

/// A worker of an earlier scheduler: it holds its lock until it is let go.
struct Survivor {
  explicit Survivor(const fs::path& directory) : lock(FileLock::try_lock(directory / "lock")) {
    Attempt a = open_attempt(directory);
    a.from_step = 0;
    write_attempt(directory, a);
  }
  std::optional<FileLock> lock;
};

TEST(Scheduler, AdoptsAWorkerThatOutlivedItsScheduler) {
  FakeStudy study;
  study.options.cores = 1;
  study.add_case("a");
  study.add_case("b");
  Survivor survivor(study.directory_of("b"));
  Names started_meanwhile;
  study.executor.at_turn = [&] {
    if (study.executor.now < 1030) return;
    if (survivor.lock) {
      started_meanwhile = study.executor.started;
      publish(study.directory_of("b") / "checkpoint", "100 finished");
    }
    survivor.lock.reset();
  };
  EXPECT_EQ(study.run().exit_code, 0);
  EXPECT_TRUE(started_meanwhile.empty()) << "its core was counted";
  EXPECT_EQ(study.executor.started, Names{"a"});
  EXPECT_EQ(study.harvested, (Names{"b", "a"}));
  EXPECT_EQ(read_attempts(study.directory_of("b")).size(), 1u);
}

TEST(Scheduler, ContinuesAnAdoptedWorkerThatDied) {
  FakeStudy study;
  study.add_case("a");
  Survivor survivor(study.directory_of("a"));
  study.executor.at_turn = [&] {
    if (study.executor.now > 1030) survivor.lock.reset();
  };
  EXPECT_EQ(study.run().exit_code, 0);
  EXPECT_EQ(study.executor.started, Names{"a"});
  EXPECT_EQ(read_attempts(study.directory_of("a"))[0].cause, Cause::killed);
}

TEST(Scheduler, AsksAnAdoptedWorkerToStopByARequest) {
  FakeStudy study;
  study.add_case("a");
  Survivor survivor(study.directory_of("a"));
  study.executor.at_turn = [&] {
    study.interrupts = study.executor.now > 1020;
    if (read_request(study.directory_of("a")) != Request::stop || !survivor.lock) return;
    close_attempt(study.directory_of("a"), read_attempts(study.directory_of("a")).back(), Cause::stopped);
    survivor.lock.reset();
  };
  EXPECT_EQ(study.run().exit_code, 75);
  EXPECT_EQ(study.state_of("a"), "stopped");
  EXPECT_FALSE(read_request(study.directory_of("a"))) << "nothing is left to stop the next attempt";
}

TEST(Scheduler, WatchesTheOwnerWhenItsOwnWorkerWasFenced) {
  FakeStudy study;
  study.add_case("a");
  std::optional<Survivor> rival;
  study.executor.scripts["a"] = {{0, false, {}, {0, 73, 0}, 0, 5, false, false}, Act::finish()};
  study.executor.at_turn = [&] {
    if (!rival && study.executor.now > 1002) rival.emplace(study.directory_of("a"));
    if (study.executor.now > 1030) rival->lock.reset();
  };
  EXPECT_EQ(study.run().exit_code, 0);
  EXPECT_TRUE(study.listener.heard("at work already"));
  EXPECT_EQ(study.executor.started.size(), 2u);
  const auto attempts = read_attempts(study.directory_of("a"));
  ASSERT_EQ(attempts.size(), 2u);
  EXPECT_EQ(attempts[0].message, "it died; its scheduler had gone before")
      << "nobody else wrote into the owner's attempt";
  EXPECT_EQ(attempts[1].cause, Cause::finished);
}

TEST(Scheduler, TakesNoNumberFromAnOwnerThatIsAboutToOpenItsAttempt) {
  FakeStudy study;
  study.add_case("a");
  std::optional<FileLock> rival;
  study.executor.scripts["a"] = {{0, false, {}, {0, 73, 0}, 0, 5, false, false}, Act::finish()};
  int highest = -1;
  study.executor.at_turn = [&] {
    if (!rival && study.executor.now > 1002 && study.executor.now < 1030)
      rival = FileLock::try_lock(study.directory_of("a") / "lock");
    if (study.executor.now < 1030) highest = highest_attempt(study.directory_of("a"));
    else rival.reset();
  };
  EXPECT_EQ(study.run().exit_code, 0);
  EXPECT_EQ(highest, 0);
}

TEST(Scheduler, KillsASilentAdoptedWorker) {
  FakeStudy study;
  study.add_case("a");
  const fs::path directory = study.directory_of("a");
  const pid_t child = ::fork();
  if (child == 0) {
    const Survivor survivor(directory);
    publish(directory / "ready", "");
    for (;;) ::pause();
  }
  while (!fs::exists(directory / "ready")) ::usleep(1000);
  EXPECT_EQ(study.run().exit_code, 0);
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
  EXPECT_EQ(study.executor.started, Names{"a"});
}

TEST(Scheduler, MarksNoCaseDoneWhoseResultsCouldNotBeWritten) {
  FakeStudy study;
  study.add_case("a");
  study.no_results = true;
  EXPECT_EQ(study.run().exit_code, 1);
  EXPECT_EQ(study.state_of("a"), "failed");
  study.no_results = false;
  EXPECT_EQ(study.run().exit_code, 0) << "and harvests them at the next run";
  EXPECT_TRUE(study.executor.started.empty());
}

TEST(Scheduler, RebuildsALostDatabaseFromTheDirectories) {
  FakeStudy study;
  for (const char* id : {"a", "b", "c"}) study.add_case(id);
  study.executor.scripts["b"] = {Act::killed(2), Act::error(Cause::numerical, 80)};
  study.run();
  const auto rows = [&] {
    return Database(study.study / "study.db", Database::Mode::query)
        .query(
            "SELECT case_id, state, message, (SELECT group_concat(cause) FROM attempts a WHERE a.case_id = c.case_id) "
            "FROM cases c ORDER BY position")
        .rows;
  };
  const auto before = rows();
  fs::remove(study.study / "study.db");
  EXPECT_EQ(study.run().exit_code, 1);
  EXPECT_TRUE(study.executor.started.empty());
  EXPECT_EQ(rows(), before);
}

TEST(Scheduler, ContinuesACaseWhosePlanWasExtended) {
  FakeStudy study;
  study.add_case("a");
  study.run();
  publish(study.directory_of("a") / "checkpoint", "100");   // the longer ramp is not finished
  EXPECT_EQ(study.run().exit_code, 0);
  EXPECT_EQ(study.executor.started, Names{"a"});
  EXPECT_EQ(study.harvested, (Names{"a", "a"}));
}

TEST(Scheduler, TellsHowFarItIsAndHowLongItWillTake) {
  FakeStudy study;
  study.options.cores = 1;
  Act long_one = Act::finish();
  long_one.lasts = 100;
  for (const char* id : {"a", "b", "c"}) {
    study.add_case(id);
    study.executor.scripts[id] = {long_one};
  }
  Progress halfway;
  study.executor.at_turn = [&] {
    if (study.executor.now <= 1150) halfway = study.listener.last;   // the second half of b, and c
  };
  study.run();
  EXPECT_EQ(halfway.cases, 3);
  EXPECT_EQ(halfway.done, 1);
  ASSERT_EQ(halfway.running.size(), 1u);
  EXPECT_EQ(halfway.running[0].label, "b");
  EXPECT_EQ(halfway.running[0].phase, "ramp");
  EXPECT_NEAR(halfway.running[0].fraction, 0.5, 0.02);
  EXPECT_NEAR(halfway.running[0].left, 50, 2);
  EXPECT_NEAR(halfway.left, 150, 2);
}

TEST(Scheduler, IsTheOnlyOneOfItsStudy) {
  const InMemoryDirectory directory;
  const FileLock lock = lock_study(directory.path());
  try {
    lock_study(directory.path());
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind, ErrorKind::locked);
    EXPECT_NE(std::string(e.what()).find(fmt::format("pid {}", ::getpid())), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find(host_name()), std::string::npos) << e.what();
  }
}

TEST(InterruptCounter, CountsInsteadOfDying) {
  const InterruptCounter counter;
  ::raise(SIGINT);
  ::raise(SIGTERM);
  EXPECT_EQ(InterruptCounter::count(), 2);
}

}   // namespace
}   // namespace bedload

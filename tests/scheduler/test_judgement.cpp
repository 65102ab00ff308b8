// The rules of retrying.
#include <gtest/gtest.h>

#include <csignal>

#include "scheduler/judgement.hpp"

namespace bedload {
namespace {

using Step = std::optional<std::uint64_t>;

Attempt attempt(Cause cause, Step from, Step reached) {
  Attempt a;
  a.cause = cause;
  a.from_step = from;
  a.step = reached;
  return a;
}

TEST(Judgement, BelievesTheCheckpointBeforeTheWorker) {
  EXPECT_EQ(judge({900, true}, {attempt(Cause::crash, 0, 900)}).verdict, Verdict::done);
  EXPECT_EQ(judge({900, false}, {attempt(Cause::finished, 0, 950)}).verdict, Verdict::again);
}

TEST(Judgement, StartsWhatWasNeverTried) { EXPECT_EQ(judge({}, {}).verdict, Verdict::again); }

TEST(Judgement, FailsACaseThatCrashedTwiceAtTheSameStep) {
  const auto crash = attempt(Cause::crash, 100, 140);
  EXPECT_EQ(judge({100, false}, {crash}).verdict, Verdict::again);
  EXPECT_EQ(judge({100, false}, {crash, crash}).verdict, Verdict::failed);
  EXPECT_EQ(judge({100, false}, {crash, attempt(Cause::wall_limit, 100, 120), crash}).verdict, Verdict::failed);
}

TEST(Judgement, ContinuesACaseThatCrashedAtTwoSteps) {
  EXPECT_EQ(judge({100, false}, {attempt(Cause::crash, 100, 140), attempt(Cause::crash, 100, 150)}).verdict,
            Verdict::again);
}

TEST(Judgement, CountsACrashBeforeTheFirstStepAsAStep) {
  const auto crash = attempt(Cause::crash, std::nullopt, std::nullopt);
  EXPECT_EQ(judge({0, false}, {crash, crash}).verdict, Verdict::failed);
}

TEST(Judgement, FailsACaseKilledTenTimesWithoutProgress) {
  std::vector<Attempt> attempts(9, attempt(Cause::killed, 100, 130));
  EXPECT_EQ(judge({100, false}, attempts).verdict, Verdict::again);
  EXPECT_EQ(judge({100, false}, attempts).without_progress, 9);
  attempts.push_back(attempts[0]);
  EXPECT_EQ(judge({100, false}, attempts).verdict, Verdict::failed);
}

TEST(Judgement, NeverHoldsProgressAgainstACase) {
  std::vector<Attempt> attempts;
  for (std::uint64_t from = 0; from < 50; ++from) attempts.push_back(attempt(Cause::killed, from, from + 1));
  EXPECT_EQ(judge({50, false}, attempts).verdict, Verdict::again);
  EXPECT_EQ(judge({50, false}, attempts).without_progress, 0);
  std::vector<Attempt> crashes(9, attempt(Cause::crash, 100, 140));   // and then the checkpoint moved
  EXPECT_EQ(judge({120, false}, crashes).verdict, Verdict::again);
}

TEST(Judgement, ForgetsWhatCameBeforeAStop) {
  const auto crash = attempt(Cause::crash, 100, 140);
  const auto stop = attempt(Cause::stopped, std::nullopt, std::nullopt);   // as `bedload retry` leaves it
  EXPECT_EQ(judge({100, false}, {crash, crash, stop}).verdict, Verdict::again);
  EXPECT_EQ(judge({100, false}, {crash, crash, stop, crash}).verdict, Verdict::again);
  EXPECT_EQ(judge({100, false}, {crash, crash, stop, crash, crash}).verdict, Verdict::failed);
}

TEST(Judgement, DoesNotRepeatErrorsOfTheUserOrThePhysics) {
  for (const Cause cause : {Cause::user_error, Cause::numerical, Cause::corrupt})
    EXPECT_EQ(judge({100, false}, {attempt(cause, 0, 120)}).verdict, Verdict::failed) << word(cause);
}

TEST(Judgement, CallsAWallLimitNoFailure) {
  EXPECT_EQ(judge({100, false}, std::vector<Attempt>(40, attempt(Cause::wall_limit, 100, 100))).verdict,
            Verdict::again);
}

TEST(Judgement, SetsAsideWhatTheDiskRefused) {
  EXPECT_EQ(judge({100, false}, {attempt(Cause::io, 100, 120)}).verdict, Verdict::set_aside);
}

TEST(Judgement, GivesMemoryOneMoreChance) {
  const auto hungry = attempt(Cause::out_of_memory, 100, 100);
  EXPECT_EQ(judge({100, false}, {hungry}).verdict, Verdict::again);
  EXPECT_EQ(judge({100, false}, {hungry, hungry}).verdict, Verdict::failed);
}

TEST(Judgement, ReadsACauseFromTheWaitStatus) {
  for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL})
    EXPECT_EQ(cause_of(JobEnd{1, 0, signal}), Cause::crash);
  EXPECT_EQ(cause_of(JobEnd{1, 0, SIGKILL}), Cause::killed);
  EXPECT_EQ(cause_of(JobEnd{1, 137, 0}), Cause::killed);
  EXPECT_EQ(cause_of(JobEnd{1, 65, 0}), Cause::user_error);
  EXPECT_EQ(cause_of(JobEnd{1, 74, 0}), Cause::io);
  EXPECT_EQ(cause_of(JobEnd{1, 75, 0}), Cause::stopped);
  EXPECT_EQ(cause_of(JobEnd{1, 80, 0}), Cause::numerical);
  EXPECT_EQ(cause_of(JobEnd{1, 82, 0}), Cause::fenced);
  EXPECT_EQ(cause_of(JobEnd{1, 1, 0}), Cause::crash);
  EXPECT_EQ(cause_of(JobEnd{1, 0, 0}), Cause::crash) << "an end without a finished checkpoint is no success";
}

}   // namespace
}   // namespace bedload

// The end of a worker: its attempt completed, its case judged, its results harvested.
#include "scheduler/scheduler.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "scheduler/last_words.hpp"
#include "scheduler/request.hpp"

namespace bedload {

namespace {

constexpr double longest_pause = 60;   // before an attempt that follows one without progress [s]

}   // namespace

void Scheduler::ended(const Running& r, const JobEnd* end) {
  Work& work = works_[r.work];
  try {
    if (r.adopted && r.asked) clear_request(work.directory);
    settle(work, completed_attempts(r, end), r.asked);
    set_spares();
  } catch (const Error& e) {
    work.set_aside = true;
    work.disk_refused = e.kind == ErrorKind::io;
    set_state(work, work.disk_refused ? CaseState::pending : CaseState::failed, e.what());
    sink_->event(fmt::format("{}: {}", work.entry.label, e.what()));
  }
}

/// The case's attempts, with the end of the last written for a worker that could not.
std::vector<Attempt> Scheduler::completed_attempts(const Running& r, const JobEnd* end) {
  const std::filesystem::path& directory = works_[r.work].directory;
  auto attempts = read_attempts(directory);
  const Cause cause = r.silenced || !end ? Cause::killed : cause_of(*end);
  std::string message = "it died; its scheduler had gone before";
  if (end) message = fmt::format("{}, see log.{}", describe(*end), r.attempt);
  if (r.silenced) message = "it was silent";
  const bool opened = !attempts.empty() && attempts.back().number >= r.attempt;
  if (!opened && end && cause != Cause::fenced && !world_.newest(directory).finished) {
    attempts.push_back(open_attempt(directory));
    attempts.back().pid = end->job;
  }
  if (!attempts.empty() && attempts.back().cause == Cause::running) {
    if (end && cause == Cause::fenced) return attempts;   // another worker's attempt, still running
    close_for_the_dead(directory, attempts.back(), cause, message);
  }
  return attempts;
}

void Scheduler::settle(Work& work, const std::vector<Attempt>& attempts, bool asked) {
  const Judgement judgement = judge(world_.newest(work.directory), attempts);
  if (judgement.verdict == Verdict::done) return harvest(work, attempts);
  ledger_->record_attempts(work.entry.id, attempts);
  const CaseState before = work.entry.state;
  const bool on_request = asked || read_request(work.directory).has_value();
  switch (judgement.verdict) {
    case Verdict::done: break;
    case Verdict::failed:
      set_state(work, CaseState::failed, judgement.reason);
      if (!work.entry.is_bed) world_.on_failed(ledger_->database(), work.directory);
      break;
    case Verdict::set_aside:
      work.set_aside = work.disk_refused = true;
      set_state(work, CaseState::pending, judgement.reason);
      break;
    case Verdict::again:
      set_state(work, on_request ? CaseState::stopped : CaseState::pending, judgement.reason);
      work.not_before = world_.clock();
      if (judgement.without_progress > 0)
        work.not_before += std::min(longest_pause, std::ldexp(1.0, judgement.without_progress - 1));
      break;
  }
  if (before != CaseState::running) return;   // known from an earlier run
  const char* what = on_request ? "stopped" : "interrupted";
  if (judgement.verdict == Verdict::failed) what = "failed";
  if (judgement.verdict == Verdict::set_aside) what = "set aside";
  const char* const colon = judgement.reason.empty() ? "" : ": ";
  sink_->event(fmt::format("{}: {}{}{}", work.entry.label, what, colon, judgement.reason));
}

/// Results, attempts and state change together.
void Scheduler::harvest(Work& work, const std::vector<Attempt>& attempts) {
  if (work.entry.state == CaseState::done) return;
  try {
    Database::Transaction transaction(ledger_->database());
    ledger_->record_attempts(work.entry.id, attempts);
    if (!work.entry.is_bed) world_.on_finished(ledger_->database(), work.directory);
    set_state(work, CaseState::done);
    transaction.commit();
    work.fraction = 1;
    sink_->event(fmt::format("{}: done", work.entry.label));
  } catch (const Error& e) {
    if (e.kind == ErrorKind::io) throw;
    set_state(work, CaseState::failed, fmt::format("no results: {}", e.what()));
    sink_->event(fmt::format("{}: finished, but no results: {}", work.entry.label, e.what()));
  }
}

}   // namespace bedload

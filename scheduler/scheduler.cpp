// The loop: start what can be, wait, judge what ended; and the reconciliation with the directories before it.
#include "scheduler/scheduler.hpp"

#include <fmt/format.h>
#include <signal.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "scheduler/bed_sharing.hpp"
#include "scheduler/request.hpp"

namespace bedload {
namespace {

namespace fs = std::filesystem;

constexpr double turn = 0.5;              // longest wait of one turn of the loop [s]
constexpr double longest_pause = 60;      // before an attempt that follows one without progress [s]

double fraction_of(const Heartbeat& h) { return h.planned_time > 0 ? std::clamp(h.time / h.planned_time, 0.0, 1.0) : 0; }

/// What the last words of a dead worker and the system's view of its end tell; written for it into its attempt.
void write_end_of(const fs::path& directory, Attempt& attempt, Cause cause, const std::string& message) {
  const auto heartbeat = read_heartbeat(directory);
  if (heartbeat && heartbeat->pid == attempt.pid) {
    attempt.step = heartbeat->step;
    attempt.core_seconds = heartbeat->wall_time;
  }
  attempt.cause = cause;
  attempt.message = message;
  attempt.end = utc_now();
  write_attempt(directory, attempt);
}

}  // namespace

FileLock lock_study(const fs::path& study_directory) {
  return FileLock::lock_or_refuse(study_directory / "lock", fmt::format("study {}", study_directory.string()));
}

Scheduler::Scheduler(Ledger& ledger, Executor& executor, ProgressSink& sink, SchedulerWorld world, SchedulerOptions options)
    : ledger_(&ledger), executor_(&executor), sink_(&sink), world_(std::move(world)), options_(std::move(options)) {}

// ---- before the loop ----

void Scheduler::reconcile() {
  Database::Transaction transaction(ledger_->database());
  works_.clear();
  running_.clear();
  const auto& only = options_.only;
  for (auto& entry : ledger_->cases()) {
    Work& work = works_.emplace_back();
    work.directory = ledger_->directory_of(entry);
    work.wanted = !entry.is_bed && (only.empty() || std::ranges::find(only, entry.id) != only.end());
    work.entry = std::move(entry);
  }
  for (auto& work : works_) inspect(work);
  want_beds();
  transaction.commit();
}

/// The truth about one case, from its directory.
void Scheduler::inspect(Work& work) try {
  // Attempts first, lock second: a worker locks before it opens its attempt, so an attempt that was running before the
  // lock was seen free is dead.
  auto attempts = read_attempts(work.directory);
  if (const auto holder = FileLock::holder(work.directory / "lock")) return adopt(work, *holder);
  if (read_request(work.directory) == Request::stop) clear_request(work.directory);
  if (!attempts.empty() && attempts.back().cause == Cause::running)
    write_end_of(work.directory, attempts.back(), Cause::killed, "found dead");
  if (const auto heartbeat = read_heartbeat(work.directory)) work.fraction = fraction_of(*heartbeat);
  settle(work, attempts, false);
  if (work.disk_refused) {   // in an earlier run: try again
    work.set_aside = work.disk_refused = false;
    set_state(work, CaseState::pending);
  }
  work.not_before = 0;
} catch (const Error& e) {
  set_state(work, CaseState::failed, e.what());
}

void Scheduler::adopt(Work& work, const LockHolder& holder) {
  Running r;
  r.work = static_cast<std::size_t>(&work - works_.data());
  r.adopted = true;
  r.attempt = highest_attempt(work.directory);
  r.heartbeat = read_heartbeat(work.directory);
  r.changed = world_.clock();
  running_.push_back(r);
  set_state(work, CaseState::running);
  sink_->event(fmt::format("{}: at work already, pid {} on {}", work.entry.label, holder.pid, holder.host));
}

/// A bed is prepared if an unfinished case lacks it.
void Scheduler::want_beds() {
  for (auto& work : works_) {
    const bool unfinished = work.entry.state == CaseState::pending || work.entry.state == CaseState::running;
    if (!work.wanted || !unfinished || work.entry.bed.empty() || has_bed(work.directory)) continue;
    Work* const bed = find(work.entry.bed);
    if (!bed) throw Error(ErrorKind::internal, fmt::format("{} needs bed {}, which was not enrolled", work.entry.label,
                                                           work.entry.bed));
    bed->wanted = true;
  }
}

// ---- the loop ----

RunOutcome Scheduler::run() {
  began_ = world_.clock();
  reconcile();
  for (;;) {
    heed_interrupts();
    if (!stopping_) start_what_can_be();
    sink_->update(progress());
    if (running_.empty() && (stopping_ || !more_to_start())) return outcome();
    for (const JobEnd& end : executor_->wait(turn)) {
      const auto r = std::ranges::find_if(running_, [&](const Running& x) { return !x.adopted && x.job == end.job; });
      if (r == running_.end()) continue;
      const Running gone = *r;
      running_.erase(r);
      ended(gone, &end);
    }
    watch();
  }
}

void Scheduler::heed_interrupts() {
  const int interrupts = world_.interrupts();
  if (interrupts >= 1 && !stopping_) {
    stopping_ = true;
    sink_->event(fmt::format("stopping: {} workers write a checkpoint; Ctrl-C again kills them", running_.size()));
    for (auto& r : running_) stop(r);
  }
  if (interrupts >= 2 && !killed_) {
    killed_ = true;
    for (const auto& r : running_) kill(r);
  }
}

void Scheduler::stop(Running& r) {
  r.asked = true;
  if (r.adopted)
    write_request(works_[r.work].directory, Request::stop);
  else
    executor_->ask_to_stop(r.job);
}

void Scheduler::kill(const Running& r) {
  if (!r.adopted) return executor_->kill(r.job);
  const Work& work = works_[r.work];
  const auto holder = FileLock::holder(work.directory / "lock");   // alive, so its pid is its own
  if (holder && holder->host == host_name())
    ::kill(static_cast<pid_t>(holder->pid), SIGKILL);
  else if (holder)
    sink_->event(fmt::format("{}: cannot kill pid {} on {} from here", work.entry.label, holder->pid, holder->host));
}

void Scheduler::start_what_can_be() {
  for (const bool bed : {true, false})
    for (auto& work : works_) {
      if (work.entry.is_bed != bed || !work.wanted || work.set_aside || work.entry.state != CaseState::pending) continue;
      if (static_cast<int>(running_.size()) >= options_.cores) return;
      if (world_.clock() < work.not_before || !bed_ready(work)) continue;
      start(work);
    }
}

/// Puts the case's bed into its directory if that can be; a case whose bed failed, fails.
bool Scheduler::bed_ready(Work& work) {
  if (work.entry.bed.empty() || has_bed(work.directory)) return true;
  const Work& bed = *find(work.entry.bed);
  if (bed.entry.state == CaseState::failed) {
    set_state(work, CaseState::failed, fmt::format("its bed {} failed", bed.entry.label));
    sink_->event(fmt::format("{}: failed: {}", work.entry.label, work.entry.message));
  }
  if (bed.entry.state == CaseState::stopped || bed.set_aside) {
    work.set_aside = true;
    work.disk_refused = bed.disk_refused;
  }
  return bed.entry.state == CaseState::done;
}

void Scheduler::start(Work& work) try {
  if (const auto holder = FileLock::holder(work.directory / "lock")) return adopt(work, *holder);
  if (read_request(work.directory)) {
    work.set_aside = true;
    return set_state(work, CaseState::stopped, "on request");
  }
  if (!work.entry.bed.empty() && !has_bed(work.directory)) share_bed(find(work.entry.bed)->directory, work.directory);
  Running r;
  r.work = static_cast<std::size_t>(&work - works_.data());
  r.attempt = highest_attempt(work.directory) + 1;
  r.heartbeat = read_heartbeat(work.directory);
  r.changed = world_.clock();
  r.job = executor_->start({work.directory, r.attempt});
  running_.push_back(r);
  set_state(work, CaseState::running);
  sink_->event(fmt::format("{}: {}", work.entry.label, r.attempt == 1 ? "started" : fmt::format("attempt {}", r.attempt)));
} catch (const Error& e) {
  if (e.kind != ErrorKind::io) throw;   // without its program nothing can run
  work.set_aside = work.disk_refused = true;
  set_state(work, CaseState::pending, e.what());
  sink_->event(fmt::format("{}: set aside: {}", work.entry.label, e.what()));
}

bool Scheduler::more_to_start() const {
  return std::ranges::any_of(works_, [](const Work& work) {
    return work.wanted && !work.set_aside && work.entry.state == CaseState::pending;
  });
}

// ---- workers at work ----

void Scheduler::watch() {
  std::vector<Running> gone;
  std::erase_if(running_, [&](const Running& r) {
    if (!r.adopted || FileLock::holder(works_[r.work].directory / "lock")) return false;
    gone.push_back(r);
    return true;
  });
  for (const auto& r : gone) ended(r, nullptr);
  for (auto& r : running_) look_at(r);
}

/// A worker is judged by whether its heartbeat changes, on this process's own clock: those of hosts may disagree.
void Scheduler::look_at(Running& r) {
  Work& work = works_[r.work];
  const double now = world_.clock();
  if (const auto heartbeat = read_heartbeat(work.directory); heartbeat && heartbeat != r.heartbeat) {
    r.heartbeat = heartbeat;
    r.changed = now;
    r.alive = true;
    work.fraction = fraction_of(*heartbeat);
    if (!r.first_fraction) {
      r.first_fraction = work.fraction;
      r.first_seen = now;
    }
  }
  if (now - r.changed <= options_.stall_limit || r.silenced) return;
  r.silenced = true;
  sink_->event(fmt::format("{}: no heartbeat for {}, killed", work.entry.label, duration_text(now - r.changed)));
  kill(r);
}

// ---- the end of a worker ----

void Scheduler::ended(const Running& r, const JobEnd* end) {
  Work& work = works_[r.work];
  try {
    if (r.adopted && r.asked) clear_request(work.directory);
    settle(work, completed_attempts(r, end), r.asked);
  } catch (const Error& e) {
    work.set_aside = true;
    work.disk_refused = e.kind == ErrorKind::io;
    set_state(work, work.disk_refused ? CaseState::pending : CaseState::failed, e.what());
    sink_->event(fmt::format("{}: {}", work.entry.label, e.what()));
  }
}

/// The case's attempts, with the end of the last written for a worker that could not.
std::vector<Attempt> Scheduler::completed_attempts(const Running& r, const JobEnd* end) {
  const fs::path& directory = works_[r.work].directory;
  auto attempts = read_attempts(directory);
  const Cause cause = r.silenced || !end ? Cause::killed : cause_of(*end);
  const std::string message = r.silenced ? "it was silent" : end ? fmt::format("{}, see log.{}", describe(*end), r.attempt)
                                        : "it died; its scheduler had gone before";
  const bool opened = !attempts.empty() && attempts.back().number >= r.attempt;
  if (!opened && end && cause != Cause::fenced && !world_.newest(directory).finished) {
    attempts.push_back(open_attempt(directory));
    attempts.back().pid = end->job;
  }
  if (!attempts.empty() && attempts.back().cause == Cause::running) {
    if (end && cause == Cause::fenced) return attempts;   // another worker's attempt, still running
    write_end_of(directory, attempts.back(), cause, message);
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
    case Verdict::done:
      break;
    case Verdict::failed:
      set_state(work, CaseState::failed, judgement.reason);
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
  const std::string what = judgement.verdict == Verdict::again ? std::string(on_request ? "stopped" : "interrupted")
                           : judgement.verdict == Verdict::failed ? "failed" : "set aside";
  sink_->event(fmt::format("{}: {}{}{}", work.entry.label, what, judgement.reason.empty() ? "" : ": ", judgement.reason));
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

void Scheduler::set_state(Work& work, CaseState state, const std::string& message) {
  if (work.entry.state == state && work.entry.message == message) return;
  ledger_->set_state(work.entry.id, state, message);
  work.entry.state = state;
  work.entry.message = message;
}

Scheduler::Work* Scheduler::find(const std::string& id) {
  const auto found = std::ranges::find_if(works_, [&](const Work& work) { return work.entry.id == id; });
  return found == works_.end() ? nullptr : &*found;
}

// ---- what it says ----

Progress Scheduler::progress() {
  Progress p;
  p.stopping = stopping_;
  p.elapsed = world_.clock() - began_;
  for (const auto& work : works_) {
    if (!work.wanted) continue;
    const CaseState state = work.entry.state;
    (work.entry.is_bed ? p.beds : p.cases) += 1;
    (work.entry.is_bed ? p.beds_done : p.done) += state == CaseState::done;
    if (!work.entry.is_bed) p.failed += state == CaseState::failed, p.stopped += state == CaseState::stopped;
  }
  std::vector<UnfinishedCase> unfinished;
  for (const auto& work : works_)
    if (work.wanted && !work.set_aside && work.entry.state == CaseState::pending)
      unfinished.push_back({work.entry.is_bed, work.fraction, 0});
  for (const auto& r : running_) {
    const Work& work = works_[r.work];
    const double now = world_.clock();
    UnfinishedCase one{work.entry.is_bed, work.fraction, 0};
    if (r.first_fraction && r.changed > r.first_seen)
      one.rate = (work.fraction - *r.first_fraction) / (r.changed - r.first_seen);
    unfinished.push_back(one);
    RunningCase& line = p.running.emplace_back();
    line.label = work.entry.label;
    line.fraction = work.fraction;
    line.silent = now - r.changed;
    line.left = TimeLeft::of(one);
    if (!r.heartbeat || !(r.alive || r.adopted)) continue;
    line.phase = r.heartbeat->phase;
    line.hold = r.heartbeat->hold;
    line.holds = r.heartbeat->holds;
    line.shields = r.heartbeat->shields;
    line.steps_per_second = r.heartbeat->steps_per_second;
  }
  p.left = time_left_.of_all(unfinished, options_.cores);
  return p;
}

RunOutcome Scheduler::outcome() const {
  RunOutcome o;
  bool disk_refused = false;
  for (const auto& work : works_) {
    if (!work.wanted || work.entry.is_bed) continue;
    disk_refused = disk_refused || work.disk_refused;
    o.done += work.entry.state == CaseState::done;
    o.failed += work.entry.state == CaseState::failed;
    o.left += work.entry.state != CaseState::done && work.entry.state != CaseState::failed;
  }
  const auto code = [](ErrorKind kind) { return static_cast<int>(kind); };
  if (killed_) o.exit_code = 130;
  else if (o.left > 0) o.exit_code = code(disk_refused && !stopping_ ? ErrorKind::io : ErrorKind::stopped);
  else if (o.failed > 0) o.exit_code = code(ErrorKind::some_failed);
  return o;
}

}  // namespace bedload

// The scheduler's loop: start what can be, wait, watch.
#include "scheduler/scheduler.hpp"

#include <fmt/format.h>
#include <signal.h>

#include <algorithm>

#include "base/error.hpp"
#include "scheduler/bed_sharing.hpp"
#include "scheduler/request.hpp"

namespace bedload {
namespace {

namespace fs = std::filesystem;

constexpr double turn = 0.5;   // longest wait of one turn of the loop [s]

}   // namespace

FileLock lock_study(const fs::path& study_directory) {
  return FileLock::lock_or_refuse(study_directory / "lock", fmt::format("study {}", study_directory.string()));
}

Scheduler::Scheduler(Ledger& ledger, Executor& executor, ProgressSink& sink, SchedulerWorld world,
                     SchedulerOptions options)
    : ledger_(&ledger), executor_(&executor), sink_(&sink), world_(std::move(world)), options_(std::move(options)) {}

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
    sink_->event(running_.size() == 1 ? "stopping: 1 worker writes a checkpoint; Ctrl-C again kills it"
                                      : fmt::format("stopping: {} workers write a checkpoint; Ctrl-C again kills them",
                                                    running_.size()));
    for (auto& r : running_) stop(r);
  }
  if (interrupts >= 2 && !killed_) {
    killed_ = true;
    for (const auto& r : running_) kill(r);
  }
}

void Scheduler::stop(Running& r) {
  r.asked = true;
  if (r.adopted) write_request(works_[r.work].directory, Request::stop);
  else executor_->ask_to_stop(r.job);
}

void Scheduler::kill(const Running& r) {
  if (!r.adopted) return executor_->kill(r.job);
  const Work& work = works_[r.work];
  const auto holder = FileLock::holder(work.directory / "lock");   // alive, so its pid is its own
  if (holder && holder->host == host_name()) ::kill(static_cast<pid_t>(holder->pid), SIGKILL);
  else if (holder)
    sink_->event(fmt::format("{}: cannot kill pid {} on {} from here", work.entry.label, holder->pid, holder->host));
}

void Scheduler::start_what_can_be() {
  for (const bool bed : {true, false})
    for (auto& work : works_) {
      if (work.entry.is_bed != bed || !work.wanted || work.set_aside || work.entry.state != CaseState::pending)
        continue;
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
  sink_->event(fmt::format("{}: {}", work.entry.label,
                           r.attempt == 1 ? "started" : fmt::format("goes on, attempt {}", r.attempt)));
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
    work.fraction = heartbeat->fraction();
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

}   // namespace bedload

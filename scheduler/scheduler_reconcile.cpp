// The ledger against the case directories, before the scheduler's loop: what lives, what is done, what died.
#include "scheduler/scheduler.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "scheduler/bed_sharing.hpp"
#include "scheduler/last_words.hpp"
#include "scheduler/request.hpp"

namespace bedload {

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
  set_spares();
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
    close_for_the_dead(work.directory, attempts.back(), Cause::killed, "found dead");
  if (const auto heartbeat = read_heartbeat(work.directory)) work.fraction = heartbeat->fraction();
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

/// What waits becomes spare, or is needed again. A case that was asked for by name is needed.
void Scheduler::set_spares() {
  const auto spares = world_.spares(ledger_->database());
  for (auto& work : works_) {
    const bool asked = work.wanted && !options_.only.empty();
    const bool spare = !asked && std::ranges::find(spares, work.entry.id) != spares.end();
    if (work.entry.state == (spare ? CaseState::pending : CaseState::spare))
      set_state(work, spare ? CaseState::spare : CaseState::pending);
  }
  want_beds();
}

/// A bed is prepared if an unfinished case lacks it.
void Scheduler::want_beds() {
  for (auto& work : works_) {
    const bool unfinished = work.entry.state == CaseState::pending || work.entry.state == CaseState::running;
    if (!work.wanted || !unfinished || work.entry.bed.empty() || has_bed(work.directory)) continue;
    Work* const bed = find(work.entry.bed);
    if (!bed)
      throw Error(ErrorKind::internal,
                  fmt::format("{} needs bed {}, which was not enrolled", work.entry.label, work.entry.bed));
    bed->wanted = true;
  }
}

}   // namespace bedload

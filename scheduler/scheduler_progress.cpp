// What the scheduler tells of itself: progress while it runs, the outcome when it ends.
#include "scheduler/scheduler.hpp"

#include <fmt/format.h>

#include "base/error.hpp"

namespace bedload {

Progress Scheduler::progress() {
  Progress p;
  p.stopping = stopping_;
  p.elapsed = world_.clock() - began_;
  for (const auto& work : works_) {
    const CaseState state = work.entry.state;
    if (!work.wanted || state == CaseState::spare) continue;
    (work.entry.is_bed ? p.beds : p.cases) += 1;
    (work.entry.is_bed ? p.beds_done : p.done) += state == CaseState::done;
    if (!work.entry.is_bed) p.failed += state == CaseState::failed, p.stopped += state == CaseState::stopped;
  }
  std::vector<UnfinishedCase> unfinished;
  for (const auto& work : works_)
    if (work.wanted && !work.set_aside && work.entry.state == CaseState::pending)
      unfinished.push_back({work.entry.is_bed, work.fraction, 0});
  for (const auto& r : running_) {
    unfinished.push_back(pace_of(r));
    p.running.push_back(line_of(r));
  }
  p.left = time_left_.of_all(unfinished, options_.cores);
  return p;
}

/// Measured between heartbeats that this scheduler saw: what an earlier attempt took says nothing about this one.
UnfinishedCase Scheduler::pace_of(const Running& r) const {
  const Work& work = works_[r.work];
  const bool known = r.first_fraction && r.changed > r.first_seen;
  return {work.entry.is_bed, work.fraction,
          known ? (work.fraction - *r.first_fraction) / (r.changed - r.first_seen) : 0};
}

RunningCase Scheduler::line_of(const Running& r) const {
  RunningCase line;
  line.label = works_[r.work].entry.label;
  line.fraction = works_[r.work].fraction;
  line.silent = world_.clock() - r.changed;
  line.left = TimeLeft::of(pace_of(r));
  if (!r.heartbeat || !(r.alive || r.adopted)) return line;   // the heartbeat is of an attempt before
  line.phase = r.heartbeat->phase;
  line.hold = r.heartbeat->hold;
  line.holds = r.heartbeat->holds;
  line.shields = r.heartbeat->shields;
  line.steps_per_second = r.heartbeat->steps_per_second;
  return line;
}

RunOutcome Scheduler::outcome() const {
  RunOutcome o;
  bool disk_refused = false;
  for (const auto& work : works_) {
    if (!work.wanted || work.entry.is_bed || work.entry.state == CaseState::spare) continue;
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

}   // namespace bedload

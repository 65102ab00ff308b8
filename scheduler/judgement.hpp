// What becomes of a case when a worker has ended: a pure function of its newest checkpoint and its attempts.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scheduler/attempt.hpp"
#include "scheduler/executor.hpp"

namespace bedload {

/// Where the newest whole checkpoint of a case stands.
struct Position {
  std::uint64_t step = 0;
  bool finished = false;
};

enum class Verdict {
  done,        // the checkpoint says so, whatever the worker said
  again,       // continue it
  set_aside,   // not again in this run: its disk refuses
  failed       // not again until the user asks
};

struct Judgement {
  Verdict verdict = Verdict::again;
  std::string reason;   // for the user; empty when all is as it should be
  int without_progress =
      0;   // attempts at the end of the list that left the checkpoint where it was, and not by request
};

/// An attempt that moved the checkpoint forward is never held against its case. Errors of the user and of the physics are
/// not repeated; a crash is, unless two came at the same step; so is a kill, until there were ten. What came
/// before an attempt that was stopped on request is forgotten: the user wants the case to go on.
Judgement judge(const Position&, const std::vector<Attempt>&);

/// The cause that a wait status suggests, for a worker that did not write one. (Through launchers it may lie: mpirun turns
/// a kill into exit code 137.)
Cause cause_of(const JobEnd&);
/// "signal 11 (Segmentation fault)", "exit code 70"
std::string describe(const JobEnd&);

}   // namespace bedload

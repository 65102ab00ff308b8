// What a run of a study would do: which cases are new, kept, extended, dropped, and what they cost.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scheduler/ledger.hpp"
#include "studies/study.hpp"

namespace bedload {

enum class Fate {
  fresh,     // nothing of it exists
  kept,      // exists, done or part-done: goes on from where it stands
  extended   // was finished, and goes on: its ramp was made longer or its onset criterion changed
};
std::string_view word(Fate);

struct PlannedCase {
  Case one;
  Fate fate = Fate::fresh;
  bool done = false;             // and stays so
  bool results_change = false;   // done, but under another onset criterion
};

struct Plan {
  std::vector<PlannedCase> cases;
  std::vector<CaseInputs> beds;           // to settle, one per bed that cases share
  std::vector<CaseEntry> dropped;         // in the database, no longer in the study file
  std::vector<CaseEntry> other_physics;   // of them, those computed under another physics_version
};

/// `known`: what the database has (nothing for a study that was never run).
Plan make_plan(std::vector<Case> cases, const std::vector<CaseEntry>& known, const std::filesystem::path& results);

/// What one case, or one bed, costs: about, by rates measured on one core of a workstation.
struct Cost {
  double core_seconds = 0;   // CPU time to the end of its ramp, though it may end earlier; of a bed, to settle
  double bytes = 0;          // of a case: two checkpoints and its rows; of a bed: its checkpoint and bed.h5
};
Cost predicted_cost(const Scene&);
/// The same by what a trade has measured, where the case follows one.
Cost predicted_cost(const Case&);

}   // namespace bedload

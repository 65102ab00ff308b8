// Results: what a finished case leaves in the database, a pure function of its scene and final state.
#pragma once

#include <cstdint>
#include <string>

#include "scheduler/database.hpp"
#include "solver/scene.hpp"
#include "solver/state.hpp"

namespace bedload {

/// Who a case is within its study.
struct CaseIdentity {
  std::string id;          // digest of the inputs
  std::string label;       // of the case, e.g. "d0.5mm-rho2000-s1"
  std::string set;         // digest of the inputs without the packing seed: the parameter set that its seeds share
  std::string set_label;   // the label without the seed
  std::uint64_t seed = 1;
};

/// What made the numbers.
struct Provenance {
  std::string version;     // of bedload, with git sha
  std::string compiler;    // name and version
  std::string flags;       // of the compiler
  std::string libraries;   // names and versions
  std::string host;        // that finished the case
};

/// Creates the result tables and views that are not there yet.
void create_result_tables(Database&);

/// Replaces every row of the case and recomputes the threshold curve, in one transaction (a part of the caller's, if
/// one is open).
void store_results(Database&, const CaseIdentity&, const Scene&, const State&, const Provenance&);

/// How many holds of the study's ramps and searches are not steady, of those whose stress is known, in a line; empty if none.
/// Staircases and stirs of a search are not asked to be.
std::string unsteady_holds(const Database&);

/// Replaces the case's rows of `step_health`: of its finished holds, and of the one under way in a state that is not the last.
void store_health(Database&, const std::string& case_id, const State&);

/// Replaces the case's rows of `models` and `warnings`: what its scene alone says, whatever becomes of its run.
void store_models(Database&, const std::string& case_id, const Scene&);

}   // namespace bedload

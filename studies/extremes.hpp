// Scenes at the edges of what can be asked for, each run with its books open: the matrix of `bedload validate extremes`.
//
// A scene is a study file of studies/validation (extremes-*.toml) and keys that are put in place of the file's, so that anyone
// can run it alone. One factor at a time around two beds, special arrangements of grains, and a set of scenes in which every
// pair of levels of the factors occurs.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "scheduler/database.hpp"
#include "solver/conservation_books.hpp"

namespace bedload {

/// How large a scene of the matrix may be: in grains, and in fluid steps if it ends.
inline constexpr std::uint64_t most_grains = 500, fewest_steps = 200, most_steps = 2000;

/// What the books must hold to; docs/physics_coupling.md says what is exact and what is bounded.
inline constexpr double exact_volume = 1e-10, exact_momentum = 1e-10, exact_divergence = 1e-8, energy_made = 0.01;
inline constexpr double most_left = 0.1;   // of a cell's volume per step, with mobile grains

/// What becomes of a scene.
enum class Outcome { finished, refused, failed };
std::string_view name_of(Outcome);

struct ExtremeScene {
  std::string name;
  std::string base;   // study file, without .toml
  std::string
      overrides;   // lines of a study file: `grains.density = "1010 kg/m3"`; `without drive.shields` takes a table out
  int steps = 0;   // length of the run, in fluid steps
  Outcome expected = Outcome::finished;
  std::string why;      // it must be refused
  bool quick = false;   // part of the short form
};

/// The whole matrix, or the part of the short form; the same on every machine.
std::vector<ExtremeScene> extreme_scenes(bool quick);

struct ExtremeRow {
  ExtremeScene scene;
  Outcome outcome = Outcome::failed;
  std::string message;   // why it was refused or failed
  std::size_t grains = 0;
  std::uint64_t steps = 0;   // fluid steps done
  std::uint64_t retries = 0;
  double cfl = 0, overlap = 0;   // worst of all steps
  Books books;
  bool resumed_is_straight = false;   // a run saved and loaded half way ends in the same bytes
  bool all_finite = false;            // every number of the last state and of the record
  double core_seconds = 0;

  /// What is wrong with the row; empty if all is as it must be.
  std::string wrong() const;
};

struct ExtremesOptions {
  bool quick = false;
  int cores = 0;   // worker threads; 0 = all. No value depends on it.
  std::function<void(const std::string&)> progress = [](const std::string&) {};   // one line per scene done
  std::function<bool()> stop = [] { return false; };   // asked before every step, by all workers
};

/// Runs the matrix in memory; nothing is written. Rows in the order of extreme_scenes(), without those that were stopped.
std::vector<ExtremeRow> run_extremes(const ExtremesOptions&);
/// Throws Error stopped if asked to stop.
ExtremeRow run_extreme(
    const ExtremeScene&, const std::function<bool()>& stop = [] { return false; });

/// The matrix as a table: scene, base, overrides, outcome, books, retries, verdict, message.
Rows extremes_table(const std::vector<ExtremeRow>&);

}   // namespace bedload

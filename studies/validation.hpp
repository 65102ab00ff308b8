// The validation ladder: study files whose answer is known, run in memory, and what is read from their runs.
//
// A rung is one study file under studies/validation/ (embedded in the program) and a function that measures its finished
// cases. A group is a list of rungs in a file of its own, validate_<group>.cpp. To add a rung: write the study file, write
// the function, add both to the group's list. To add a group: declare its list here, add a line to validation_groups().
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/vec3.hpp"
#include "solver/coupler.hpp"
#include "studies/study.hpp"

namespace bedload {

/// What `ours` is held against: the exact answer of the equations that are solved, an experiment, or nothing: a row for
/// information, which never decides.
enum class Against { equations, experiment, nothing };

/// How far `ours` may lie from the reference. An infinite side is open.
struct Band {
  double below = 0, above = 0;   // both >= 0; fractions of the reference, or in its unit
  bool relative = true;

  static Band within(double fraction) { return {fraction, fraction, true}; }
  static Band within_absolute(double difference) { return {difference, difference, false}; }
  static Band at_most(double fraction_above = 0) { return {std::numeric_limits<double>::infinity(), fraction_above}; }
  static Band at_least(double fraction_below = 0) { return {fraction_below, std::numeric_limits<double>::infinity()}; }
};

/// One line of the ladder.
struct ValidationRow {
  std::string name;       // what is compared, with its unit: "time of contact at 0.1 m/s [us]"
  double reference = 0;   // of another origin than the run: a formula or a publication
  std::string source;     // of the reference: "Hertz 1882", "Ghia et al. 1982, Re 100"
  double ours = 0;        // read from the run's record or final state; not finite = no pass
  Band band;
  Against against = Against::equations;

  /// A row that tells `ours` and how it was had, and decides nothing.
  static ValidationRow note(std::string name, std::string how, double ours) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    return {std::move(name), none, std::move(how), ours, {}, Against::nothing};
  }
  bool decides() const { return against != Against::nothing; }

  double deviation() const;   // of ours; a fraction of |reference| if the band is relative, else in the row's unit
  bool in_band() const;       // false for a note
};

/// A curve that says more than a number; docs/verification.md shows it.
struct ValidationFigure {
  std::string name;      // of its file, without ".svg"
  std::string caption;   // one or two sentences: what is drawn, and the reference's source
  std::string svg;       // see svg_plot.hpp
};

/// A sphere's fall on one mesh, for the table of meshes (mesh_table.hpp).
struct MeshFall {
  double cell = 0;                              // edge [d]
  bool corrected = false;                       // freed of the flow that it makes itself
  double against_law = 0, against_stokes = 0;   // mean speed over the terminal one, less one
  double ripple = 0;                            // over a cell, of the mean speed
  double seconds_of_500_steps = 0;              // CPU time of one core
};

struct Findings {
  std::vector<ValidationRow> rows;
  std::vector<ValidationFigure> figures;
  std::vector<MeshFall> falls = {};

  std::size_t deciding() const;   // rows that are no notes
  std::size_t in_band() const;    // of these
};

/// A case that ran to its end, and all that can be read from it.
struct FinishedCase {
  Case one;                        // label, inputs (SI, by study key), scene
  State state;                     // the last: fields, grains, record (samples, holds, profiles, tracks)
  std::vector<Vec3> drag;          // on each grain in the last step, by id [N]
  std::uint64_t fluid_steps = 0;   // without those of packing
  double core_seconds = 0;         // CPU time of these steps
  double packing_seconds = 0;      // CPU time of packing the bed
  double worst_divergence = 0;     // StepHealth::divergence, largest of all steps
  double deepest_overlap = 0;      // per diameter, of all steps

  double input(std::string_view key) const { return one.inputs.number(key); }   // "grains.diameter", SI
};

/// One study file and what is measured in its cases.
struct Rung {
  std::string_view study;   // studies/validation/<study>.toml
  std::string_view what;    // one sentence: the experiment
  /// Of finished cases, in the order of the study's axes; with --quick those only that `quick` takes. A value that cannot
  /// be measured is NaN, and out of band.
  std::function<Findings(const std::vector<FinishedCase>&)> measure;
  /// True for cases that --quick runs; empty: none of them.
  std::function<bool(const Case&)> quick;
};
inline bool every_case(const Case&) { return true; }   // for Rung::quick

struct ValidationGroup {
  std::string_view name, what;
  std::vector<Rung> (*rungs)();
};

std::vector<Rung> contact_rungs();    // validate_contact.cpp
std::vector<Rung> bed_rungs();        // validate_bed.cpp
std::vector<Rung> fluid_rungs();      // validate_fluid.cpp
std::vector<Rung> onset_rungs();      // validate_onset.cpp
std::vector<Rung> settling_rungs();   // validate_settling.cpp

/// In the order of the ladder.
std::span<const ValidationGroup> validation_groups();
/// The groups named, or all of them; an unknown name is Error usage with the list.
std::vector<ValidationGroup> groups_named(const std::vector<std::string>&);

/// The study of a rung, and its cases in the order of its axes (with `quick`, those that it takes).
Study validation_study(std::string_view name);
std::vector<Case> cases_of(const Rung&, bool quick);

/// A rung that was climbed.
struct RungResult {
  std::string group, study, what;
  Findings findings;         // empty if a case failed
  std::string failure;       // why a case, or the study file, could not be run; empty if all were
  bool stopped = false;      // before all its cases were run: no findings
  int cases = 0;             // that were run
  double core_seconds = 0;   // of all cases, packing too
  bool passed() const;
};

struct ValidationOptions {
  bool quick = false;
  int cores = 0;   // worker threads; 0 = all. No value depends on it.
  std::function<void(const std::string&)> progress = [](const std::string&) {};   // one line per finished rung
  std::function<bool()> stop = [] { return false; };   // asked before every step, by all workers
};

/// Runs all rungs of the groups, cases side by side, costly ones first; nothing is written. Results in the order of the ladder.
std::vector<RungResult> climb(const std::vector<ValidationGroup>&, const ValidationOptions&);

/// Runs one case to its end in memory. Throws Error numerical if it leaves its domain, Error stopped if asked to stop.
FinishedCase run_in_memory(const Case&, const std::function<bool()>& stop);

/// Trajectory of one grain of record.tracks; positions made continuous across periodic seams.
struct Trajectory {
  std::vector<double> time;   // [s]
  std::vector<Vec3> position, velocity, spin;

  std::size_t size() const { return time.size(); }
  /// First row at or after `t`; size() if there is none.
  std::size_t row_at(double t) const;
};
Trajectory trajectory_of(const FinishedCase&, std::uint64_t grain);

}   // namespace bedload

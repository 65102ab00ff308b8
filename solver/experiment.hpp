// The experiment on one bed: pack, shear and let rest if it is to have that history, then hold after hold of the ramp, recording, until onset is confirmed or the ramp ends.
#pragma once

#include <memory>

#include "solver/coupler.hpp"

namespace bedload {

/// Predicted end of the clock of a scene's experiment [s]: levels x dwell of a ramp, about as much as a search takes.
double planned_time(const Scene&);

class Experiment {
 public:
  explicit Experiment(const Scene&);
  ~Experiment();

  /// The state before anything has moved: grains placed, fluid at rest; phase packing, or holding if nothing needs to settle.
  State begin() const;
  /// A settled bed (the final state of a bed directory) as the start of this scene's ramp, or of the shear before it.
  State begin_on(State settled) const;
  /// The settled (and sheared) bed that a search branches from, for a state that was taken up again. Not needed where `begin` or
  /// `begin_on` was asked, or where nothing needs to settle.
  void branch_from(const State& settled);
  /// A finished state whose ramp this scene has not ended (more levels, another onset criterion) goes on with the next
  /// hold. False, and nothing changed, if there is nothing to go on with.
  bool reopen(State&) const;

  /// One packing interval or one coupled step, with what surrounds it: impose the hold's flow when it begins, count
  /// motion, sample, close the hold when its dwell has passed. Never called when finished. A coupled step whose health is
  /// past a limit is undone and taken again shorter; if it still is after the last retry (ailment(health) says why), the
  /// state is left as it was before the step, and the run cannot go on.
  StepHealth step(State&);

  static bool finished(const State& s) { return s.search.phase == Search::finished; }
  const Coupler& coupler() const;
  void forget();   // all scratch

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}   // namespace bedload

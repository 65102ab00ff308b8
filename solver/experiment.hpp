// The experiment on one bed: pack, then hold after hold of the ramp, recording, until onset is confirmed or the ramp ends.
#pragma once

#include <memory>

#include "solver/coupler.hpp"

namespace bedload {

class Experiment {
 public:
  explicit Experiment(const Scene&);
  ~Experiment();

  /// The state before anything has moved: grains placed, fluid at rest; phase packing, or holding if nothing needs to settle.
  State begin() const;
  /// A settled bed (the final state of a bed directory) as the start of this scene's ramp.
  State begin_on(State settled) const;
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
  /// Predicted end of the run's clock [s] (ramp: levels x dwell).
  double planned_time() const;
  void forget();   // all scratch

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}   // namespace bedload

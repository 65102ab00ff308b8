// Books over a run of coupled steps: what must stay the same, and by how much it did not.
#pragma once

#include <memory>
#include <optional>

#include "solver/coupler.hpp"

namespace bedload {

/// The worst of a run; nothing where walls or fixed grains take part in a way that the books do not see.
struct Books {
  bool grains_unchanged = true;   // number, diameters, densities; centres inside the box
  double fluid_volume = 0;        // |sum of eps V_c - (box - grains)|, per box
  std::optional<double>
      momentum;            // along the periodic directions, what a step made of it, per sum of |p| and impulses
  double divergence = 0;   // largest |div(eps u + J)| T that a step left
  bool mobile = false;     // some grain moves: then the divergence is only bounded
  std::optional<double>
      energy;   // most that was made without a source, per energy exchanged (docs/physics_coupling.md)
};

/// Follows a run, step by step. Costs about as much as a coupled step of a small bed.
class ConservationBooks {
 public:
  explicit ConservationBooks(const Scene&);
  ~ConservationBooks();

  /// After every coupled step, with the state before it and after it. A step that began a hold, whose steady flow was set
  /// at once, is not booked.
  void add(const State& before, const State& after, const StepHealth&, const StepBooks&);
  const Books& worst() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}   // namespace bedload

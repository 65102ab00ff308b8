// Making a bed: where the grains start, how they settle, when they are at rest.
#pragma once

#include <cstdint>
#include <memory>

#include "solver/grains/bed_scene.hpp"
#include "solver/grains/contact_history.hpp"
#include "solver/grains/grain_dynamics.hpp"
#include "solver/grains/grains.hpp"

namespace bedload {

/// The grains before settling. Refuses (study_invalid) grains that do not fit the box, overlap in the table, or share a
/// place.
Grains place_grains(const BedScene&);

/// True when the source is settled by BedPacking (poured, lattice); a table's grains are left as they are.
bool needs_settling(const BedScene&);

/// One-way settling: submerged weight, linear (Stokes) drag to still fluid, contacts; until the mean kinetic energy per
/// grain is below 1e-6 W' d and no grain is falling freely. Restitution and drag are at most what docs/physics_grains.md,
/// (G13), says; the step is its own. The last grains that move are moved alone (stragglers.hpp). Deterministic in (Grains,
/// ContactHistory).
class BedPacking {
 public:
  explicit BedPacking(const BedScene&);
  ~BedPacking();
  struct Progress {
    double dt;                // advanced [s]
    double energy;            // mean kinetic energy per grain / (W' d)
    double deepest_overlap;   // per diameter of the smaller grain [-]
    bool settled;
    std::uint64_t grain_steps;   // sub-steps of single grains that it took [-]
  };
  /// One interval of 50 to 200 sub-steps; wraps positions into the box.
  Progress advance(Grains&, ContactHistory&);
  /// A hundred times the fall from the top of the box to the bottom [s]: what has not come to rest by then will not.
  double patience() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Gives ids in spatial order (by x-slab of one diameter, then y-slab, then z), contacts with them: makes order of id =
/// order of memory = (nearly) order in space. Deterministic in its input.
void renumber_in_space(const BedScene&, Grains&, ContactHistory&);

/// Grains that rest on each other in a settled bed of scene.source.count grains, at least 1 [-].
double bed_layers(const BedScene&);

/// Young's modulus for stiffness = "auto" [Pa]: the rule of docs/decisions/stiffness.md. Reads fluid,
/// gravity and the grains' diameter, density and Poisson's ratio.
double automatic_young_modulus(const BedScene&, double layers);

}   // namespace bedload

// Extra drag on grains that stand out of a bed: their exposed part meets the flow at its own height.
//
// Kirchner, Dietrich, Iseya & Ikeda 1990 (Sedimentology 37, 647) integrate the drag on a bed grain over the height of its
// exposed part, each slice of the frontal area with the velocity at its height; exposure is measured from the tops of the
// neighbours. An unresolved grain has one velocity, that at its centre. What is added here is the difference for a sphere:
// exposed slices with the velocity at their own height, sheltered ones with that at the centre (an engineering choice).
#pragma once

#include <span>
#include <vector>

#include "solver/coupling/quad.hpp"
#include "solver/grains/grains.hpp"
#include "solver/grains/neighbour_search.hpp"

namespace bedload {

/// Up to which height each grain is sheltered, in radii above its centre: -1 = it stands free, 1 = to its top or more. Mean
/// over sixteen directions round the horizon of the highest top of the grains which stand in that direction, as wide as they
/// are, nearer than twice touching; -1 where none does; cut to -1..1. By id; the order of neighbours does not matter. All calls are
/// for one box: pairs found before serve again.
class Sheltering {
 public:
  std::span<const double> find(const PeriodicBox&, const Grains&);

 private:
  void list_pairs(const PeriodicBox&, const Grains&);

  PairList pairs_;   // of `origin_` and `diameter_`, with a skin
  std::vector<Vec3> origin_;
  std::vector<double> diameter_, level_;
  std::vector<Quad> highest_;   // of four directions each
};

/// Mean height of a sphere's frontal area above its centre, only slices above `level` counted [radii]:
/// (2/(3 pi)) (1 - level^2)^(3/2); 0 for a sphere that stands free or is buried, at most 0.21.
double exposed_moment(double level);

/// Velocity of the flow at the exposed slices over that at the centre, averaged over the frontal area [m/s]: exposed_moment x
/// radius x vertical shear, which is the horizontal part of vorticity x up.
Vec3 exposure_velocity(double level, double diameter, Vec3 vorticity);

}   // namespace bedload

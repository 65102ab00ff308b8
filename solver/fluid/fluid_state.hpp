// What a fluid step reads of the step before it.
#pragma once

#include "solver/fluid/staggered_grid.hpp"

namespace bedload {

/// Interstitial velocity on the faces and reduced kinematic pressure q = (p - p_hydrostatic)/rho_f on the centres.
/// The void fraction is not here: it is a function of the grains' positions.
struct FluidState {
  FluidState() = default;
  explicit FluidState(const StaggeredGrid& g) : velocity(g), pressure(g) {}
  bool operator==(const FluidState&) const = default;

  FaceFields velocity;          // u, v, w [m/s]
  Field<Centre> pressure;       // q [m2/s2]
  double column_gradient = 0;   // uniform -dq/dz that keeps a z-periodic box free of net volume flux [m/s2]
};

}   // namespace bedload

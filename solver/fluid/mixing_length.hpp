// How far an eddy reaches: as far as the cells filter, or as the walls let it.
#pragma once

#include <vector>

#include "solver/fluid/staggered_grid.hpp"

namespace bedload {

/// A plane across a direction past which eddies do not reach: a wall, or the surface of a bed.
struct TurbulentSurface {
  double position = 0;         // along its normal [m]
  bool fluid_above = true;     // on which side of it the flow is
  double sand_roughness = 0;   // k_s [m]; 0 = smooth
  double friction_speed = 0;   // u* [m/s], for the damping beside it
};

/// 1/l^2 [1/m2] that the surfaces across one direction add at cell centres (index k) and at faces (index k, 0..n); infinite
/// behind a surface, where there are no eddies.
struct SurfaceTerms {
  std::vector<double> centres, faces;
};

/// 1/l^2 = 1/(C_s Delta)^2 + sum over surfaces of 1/[kappa (y + z0) D(y)]^2 (Mason & Thomson 1992), y the distance, D van
/// Driest's damping with his term for roughness. At faces 1/l is the mean of 1/[kappa (y + z0)] between the two cell
/// centres, as far as that stretch is in the flow: then a log law is an exact solution of the discrete equations.
void find_surface_terms(int cells, double h, double viscosity, const std::vector<TurbulentSurface>&, SurfaceTerms&);

/// 1/(C_s Delta)^2 [1/m2], Delta the longest edge of a cell: an eddy is resolved when it spans cells in every direction.
double filter_term(const StaggeredGrid&);

}   // namespace bedload

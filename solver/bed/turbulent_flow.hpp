// The steady mean flow of the turbulence closure over a bed: one-dimensional, on the planes of the grid.
#pragma once

#include <vector>

#include "solver/scene.hpp"

namespace bedload {

struct TurbulentFlow {
  std::vector<double> planes;   // u of every plane of cells, from the bottom up [m/s]; 0 below the bed's surface
  double lid_speed = 0;         // of a lid that drives it [m/s]
};

/// The flow that puts the stress u*^2 of `friction_speed` [m/s] on a bed (or bottom) at z_b [m], driven as the scene's ramp says:
/// the stress is the same at all heights under a lid, and falls to zero at a free-slip top, or half-way to a lid at rest,
/// under a gradient. It is the steady flow of the discrete closure, docs/physics_fluid.md (F14) to (F18), if the bed holds
/// the fluid in it still.
TurbulentFlow turbulent_flow(const Scene&, double bed_height, double friction_speed);

/// u* [m/s] that a lid of that speed [m/s] puts on the bed; carries the sign of the speed.
double friction_speed_under_lid(const Scene&, double bed_height, double lid_speed);

}   // namespace bedload

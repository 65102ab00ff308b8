// The terms that act beside drag, for all grains: lift, walls, exposure.
#pragma once

#include "solver/coupling/exposure.hpp"
#include "solver/coupling/hydrodynamic_forces.hpp"

namespace bedload {

/// What the terms of a scene need besides the flow at the grains.
struct Surroundings {
  const StaggeredGrid& grid;
  const PeriodicBox box;
  double viscosity;   // [m2/s]
  double lid_speed;   // of the upper wall, along x [m/s]
};

/// The terms shear_lift, magnus, wall_forces and exposure, as far as they are on.
bool any_explicit(const Terms&);

/// Adds these terms, in this order: walls change flow.drag and add to flow.force; lift and exposure add to flow.force.
/// Reads flow.velocity, vorticity, void_fraction, packing, drag, removed; a lift never exceeds half of the drag (lift_force).
void add_explicit_forces(const Surroundings&, const Grains&, const Terms&, Sheltering&, FlowAtGrains&);

}   // namespace bedload

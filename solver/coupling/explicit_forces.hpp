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

/// What a wall near a lone grain makes of its viscous torque, per axis: factors on the vorticity that the wall's shear has, and
/// on the grain's spin. 1 about the wall's normal, and for a grain among others.
struct WallTorque {
  Vec3 shear{1, 1, 1}, spin{1, 1, 1};
};
WallTorque wall_torque(const StaggeredGrid&, Vec3 position, double diameter, double loneness);

/// Adds these terms, in this order: walls change flow.drag and add to flow.force; lift and exposure add to flow.force.
/// Reads flow.velocity, vorticity, void_fraction, packing, drag, removed; a lift never exceeds half of the drag (limited_lift), which is
/// counted.
void add_explicit_forces(const Surroundings&, const Grains&, const Terms&, Sheltering&, FlowAtGrains&);

}   // namespace bedload

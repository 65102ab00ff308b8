// What resists the rolling of a grain over another, or over a wall.
#pragma once

#include <span>

#include "solver/grains/contact_laws.hpp"
#include "solver/grains/neighbour_list.hpp"

namespace bedload {

/// Torque on the lower grain [N m] (the partner gets the opposite), and the rolling spring for the next step [rad].
struct RollingTorque {
  Vec3 torque, spring;
};

/// An elastic spring of rolling with damping, capped at mu_r R* F_n: docs/physics_grains.md, (G21)-(G23).
class RollingResistance {
 public:
  explicit RollingResistance(double rolling_friction) : friction_(rolling_friction) {}

  /// `turning`: spin of the lower grain relative to its partner [rad/s]. Zero and zero for grains apart.
  RollingTorque respond(const HertzMindlin&, Damping, const Overlap&, Vec3 turning, Vec3 spring,
                        double dt) const noexcept;

  /// What the rolling spring of a contact holds, R*^2 S_t psi^2/2 [J]; 0 for grains apart.
  static double energy(const HertzMindlin&, const Overlap&, Vec3 spring) noexcept;

 private:
  double friction_;   // mu_r [-]
};

/// Adds the rolling torques of all contacts to `loads`, and renews their rolling springs. Depths and dampings are those
/// of the contact pass of the same step. Frictionless walls do not resist.
void add_rolling_torques(const RollingResistance&, const HertzMindlin&, const Bodies&, double dt, NeighbourList&,
                         std::span<Load> loads) noexcept;

}   // namespace bedload

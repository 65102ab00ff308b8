// How a collision in a liquid rebounds: by the Stokes number of its approach.
#pragma once

#include <vector>

#include "solver/grains/bed_scene.hpp"
#include "solver/grains/wet_table.hpp"

namespace bedload {

struct SolidSphere {
  double radius;            // [m]
  double inverse_inertia;   // [1/(kg m2)]; 0 = fixed
};

/// e = e_dry exp(-35/St), St = m* U/(6 pi mu R*^2) with half the mass of the displaced liquid added to each grain
/// (Legendre, Zenit, Daniel & Guiraud 2006; against a wall it is (rho_p + rho_f/2) d U/(9 mu)): docs/physics_grains.md,
/// (G16)-(G17). Below HertzMindlin::lowest_restitution a collision rebounds with that.
class WetRestitution {
 public:
  WetRestitution(const FluidProperties&, double dry_restitution);

  static constexpr double decay = 35;   // of ln e with 1/St [-]

  /// Approach speed at which the liquid leaves 1/e of the dry rebound, i.e. at which St = 35 [m/s].
  double viscous_speed(SolidSphere, SolidSphere) const noexcept;
  double viscous_speed_at_wall(SolidSphere) const noexcept;

  WetTable table() const noexcept { return {table_.data(), static_cast<double>(table_.size() - 1), per_fold}; }
  double damping(double viscous_speed, double approach) const noexcept {
    return table().damping(viscous_speed, approach);
  }

 private:
  double inverse_mass(SolidSphere) const noexcept;

  static constexpr double per_fold = 16;   // entries of the table per factor 1/e of restitution
  double viscosity_, fluid_density_;       // dynamic [Pa s]; [kg/m3]
  std::vector<double> table_;              // alpha for e = e_dry exp(-n/16); the last for the lowest restitution [-]
};

}   // namespace bedload

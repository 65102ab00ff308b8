// How a collision in a liquid rebounds: by the Stokes number of its approach.
#pragma once

#include <algorithm>
#include <vector>

#include "solver/grains/bed_scene.hpp"
#include "solver/grains/bodies.hpp"

namespace bedload {

/// e = e_dry exp(-35/St), St = m* U/(6 pi mu R*^2) with half the mass of the displaced liquid added to each grain
/// (Legendre, Zenit, Daniel & Guiraud 2006; against a wall it is (rho_p + rho_f/2) d U/(9 mu)): docs/physics_grains.md,
/// (G16)-(G17). Below HertzMindlin::lowest_restitution a collision rebounds with that.
class WetRestitution {
 public:
  WetRestitution(const FluidProperties&, double dry_restitution);

  static constexpr double decay = 35;   // of ln e with 1/St [-]

  /// Approach speed at which the liquid leaves 1/e of the dry rebound, i.e. at which St = 35 [m/s].
  double viscous_speed(const Body&, const Body&) const noexcept;
  double viscous_speed_at_wall(const Body&) const noexcept;

  /// Damping alpha of a contact that begins at this speed [-]; that of the slowest ones if it is not approaching.
  double damping(double viscous_speed, double approach) const noexcept {
    const double place = std::min(per_fold * viscous_speed / std::max(approach, 1e-200), cells_);
    const auto cell = static_cast<int>(std::min(place, cells_ - 1));
    return table_[cell] + (place - cell) * (table_[cell + 1] - table_[cell]);
  }

 private:
  double inverse_mass(const Body&) const noexcept;

  static constexpr double per_fold = 16;   // entries of the table per factor 1/e of restitution
  double viscosity_, fluid_density_;       // dynamic [Pa s]; [kg/m3]
  std::vector<double> table_;              // alpha for e = e_dry exp(-n/16); the last for the lowest restitution [-]
  double cells_;                           // entries but one [-]
};

}   // namespace bedload

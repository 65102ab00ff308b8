// The dimensionless numbers of sediment motion: each formula once, with its definition.
#pragma once

#include <cmath>

namespace bedload {

/// Submerged specific weight of a grain, |s - 1| g [m/s2]: what makes it sink, or rise.
inline double reduced_gravity(double density_ratio, double gravity) { return std::abs(density_ratio - 1) * gravity; }

/// Shields number theta = tau_b/(|rho_p - rho_f| g d) of a bed shear stress [Pa].
inline double shields_number(double stress, double fluid_density, double density_ratio, double gravity,
                             double diameter) {
  return stress / (fluid_density * reduced_gravity(density_ratio, gravity) * diameter);
}

/// Bed shear stress of a Shields number [Pa].
inline double stress_of_shields(double shields, double fluid_density, double density_ratio, double gravity,
                                double diameter) {
  return shields * fluid_density * reduced_gravity(density_ratio, gravity) * diameter;
}

/// Galileo number Ga = sqrt(|s - 1| g d^3)/nu: weight against viscosity.
inline double galileo_number(double density_ratio, double gravity, double diameter, double viscosity) {
  return std::sqrt(reduced_gravity(density_ratio, gravity) * diameter * diameter * diameter) / viscosity;
}

/// Grain Reynolds number of the shear velocity, Re* = u* d/nu = sqrt(theta) Ga.
inline double friction_reynolds_number(double shields, double galileo) { return std::sqrt(shields) * galileo; }

/// Re = U L/nu.
inline double reynolds_number(double speed, double length, double viscosity) { return speed * length / viscosity; }

/// Grain Reynolds number of a shear rate, Re_g = gdot d^2/nu; theta Ga^2 for the viscous shear tau_b/mu.
inline double shear_reynolds_number(double shear_rate, double diameter, double viscosity) {
  return reynolds_number(shear_rate * diameter, diameter, viscosity);
}

/// Stokes number of an impact at speed U with the added mass of a sphere, St = (s + 1/2) d U/(9 nu).
inline double impact_stokes_number(double density_ratio, double diameter, double speed, double viscosity) {
  return (density_ratio + 0.5) * diameter * speed / (9 * viscosity);
}

}   // namespace bedload

// What a wall takes from a turbulent flow whose sublayer the cells do not resolve.
#pragma once

namespace bedload {

inline constexpr double von_karman = 0.41;
inline constexpr double smooth_wall_intercept = 5.2;   // B of u+ = ln(y+)/kappa + B

/// Length z0 [m] at which the log law of a wall of Nikuradse's sand roughness k_s [m] has u = 0: k_s/30.
constexpr double roughness_length(double sand_roughness) { return sand_roughness / 30; }

/// Shear stress per rho_f [m2/s2] on a wall past which the flow has the tangential speed `speed` [m/s] at `distance` y [m].
/// Smooth: u+ = y+ up to y+ = 11.06, u+ = ln(y+)/kappa + B beyond (one wall unit: nu/u*). Rough:
/// u/u* = ln((y + z0)/z0)/kappa, where that is the larger stress: a wall is never smoother than smooth.
double wall_stress(double speed, double distance, double viscosity, double sand_roughness);
/// The inverse: the speed [m/s] at that distance over a wall that bears the stress u*^2 of `friction_speed` [m/s].
double wall_speed(double friction_speed, double distance, double viscosity, double sand_roughness);

}   // namespace bedload

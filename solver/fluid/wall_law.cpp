// The log law solved for its stress.
#include "solver/fluid/wall_law.hpp"

#include <algorithm>
#include <cmath>

namespace bedload {
namespace {

constexpr double sublayer_edge = 11.062;   // y+ where u+ = y+ meets the log law

/// y+ of y+ (ln(y+)/kappa + B) = Re, Newton from above: the function is convex and rising there, so every step falls.
double wall_units(double reynolds) {
  double y = reynolds / sublayer_edge;
  for (int n = 0; n < 20; ++n) {
    const double u = std::log(y) / von_karman + smooth_wall_intercept;
    const double change = (y * u - reynolds) / (u + 1 / von_karman);
    y -= change;
    if (change <= 1e-14 * y) break;
  }
  return y;
}

}   // namespace

double wall_stress(double speed, double distance, double viscosity, double sand_roughness) {
  const double reynolds = speed * distance / viscosity;
  double stress = viscosity * speed / distance;
  const auto at_least = [&](double friction_speed) { stress = std::max(stress, friction_speed * friction_speed); };
  if (reynolds > sublayer_edge * sublayer_edge) at_least(wall_units(reynolds) * viscosity / distance);
  if (sand_roughness > 0) at_least(von_karman * speed / std::log1p(distance / roughness_length(sand_roughness)));
  return stress;
}

double wall_speed(double friction_speed, double distance, double viscosity, double sand_roughness) {
  const double y = friction_speed * distance / viscosity;
  const double smooth = y > sublayer_edge ? std::log(y) / von_karman + smooth_wall_intercept : y;
  if (sand_roughness <= 0) return friction_speed * smooth;
  return friction_speed * std::min(smooth, std::log1p(distance / roughness_length(sand_roughness)) / von_karman);
}

}   // namespace bedload

// Mason & Thomson's blend (J. Fluid Mech. 242, 1992, 51) with van Driest's damping (J. Aeronaut. Sci. 23, 1956, 1007).
#include "solver/fluid/mixing_length.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/fluid/wall_law.hpp"

namespace bedload {
namespace {

constexpr double smagorinsky_constant = 0.17;   // Lilly: the value of a resolved inertial range
constexpr double damping_length = 26;           // wall units
constexpr double rough_from = 60;               // k_s in wall units from which nothing is damped
constexpr double infinite = std::numeric_limits<double>::infinity();

double damping(const TurbulentSurface& s, double y, double viscosity) {
  double d = 1 - std::exp(-y * s.friction_speed / (damping_length * viscosity));
  if (s.sand_roughness > 0) d += std::exp(-rough_from / damping_length * y / s.sand_roughness);
  return std::min(d, 1.0);
}

/// 1/l^2 at distance y, the mean of 1/[kappa (y + z0)] taken from y - half to y + half.
double term(const TurbulentSurface& s, double y, double half, double viscosity) {
  const double far = y + half, near = std::max(0.0, y - half), z0 = roughness_length(s.sand_roughness);
  if (!(far > 0)) return infinite;
  const double mean = half > 0 ? std::log((far + z0) / (near + z0)) / (2 * half) : 1 / (y + z0);
  const double inverse = mean / (von_karman * damping(s, 0.5 * (near + far), viscosity));
  return std::isfinite(inverse) ? inverse * inverse : infinite;
}

}   // namespace

void find_surface_terms(int cells, double h, double viscosity, const std::vector<TurbulentSurface>& surfaces,
                        SurfaceTerms& terms) {
  terms.centres.assign(static_cast<std::size_t>(cells), 0.0);
  terms.faces.assign(static_cast<std::size_t>(cells) + 1, 0.0);
  for (const TurbulentSurface& s : surfaces) {
    const auto distance = [&](double x) { return s.fluid_above ? x - s.position : s.position - x; };
    for (std::size_t k = 0; k < terms.centres.size(); ++k)
      terms.centres[k] += term(s, distance((double(k) + 0.5) * h), 0, viscosity);
    for (std::size_t k = 0; k < terms.faces.size(); ++k)
      terms.faces[k] += term(s, distance(double(k) * h), 0.5 * h, viscosity);
  }
}

double filter_term(const StaggeredGrid& g) {
  const double length = smagorinsky_constant * std::max({g.h.x, g.h.y, g.h.z});
  return 1 / (length * length);
}

}   // namespace bedload

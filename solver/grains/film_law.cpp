// Rigid surfaces far apart, elastic ones close up.
#include "solver/grains/film_law.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace bedload {

FilmLaw::FilmLaw(const BedScene& scene)
    : viscous_force_(6 * std::numbers::pi * scene.fluid.density * scene.fluid.viscosity) {
  const double modulus = scene.grains.young_modulus / (2 * (1 - scene.grains.poisson * scene.grains.poisson));   // Y*
  compliance_ = viscous_force_ / (2 * std::numbers::sqrt2 * modulus);
}

double fifth_root(double q) noexcept {
  if (!(q > std::numeric_limits<double>::min())) return 0;
  // The logarithm of q is nearly its bits: a first guess within some per cent, then Newton.
  constexpr std::uint64_t one = std::bit_cast<std::uint64_t>(1.0);
  double s = std::bit_cast<double>(one - one / 5 + std::bit_cast<std::uint64_t>(q) / 5);
  for (int n = 0; n < 5; ++n) {
    const double s2 = s * s;
    s = 0.2 * (4 * s + q / (s2 * s2));
  }
  return s;
}

double FilmLaw::elastic_gap(double reduced_radius, double speed) const noexcept {
  const double root = fifth_root(compliance_ * std::abs(speed) * reduced_radius * std::sqrt(reduced_radius));
  return std::min(root * root, 0.5 * thickest * reduced_radius);
}

double FilmLaw::resistance(double gap, double reduced_radius, double speed) const noexcept {
  const double most = thickest * reduced_radius;
  if (!(gap < most)) return 0;
  const double h = std::max({gap, elastic_gap(reduced_radius, speed), thinnest * reduced_radius});
  return viscous_force_ * reduced_radius * reduced_radius * (1 / h - 1 / most);
}

}   // namespace bedload

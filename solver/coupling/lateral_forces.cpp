#include "solver/coupling/lateral_forces.hpp"

#include <algorithm>
#include <numbers>

namespace bedload {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double largest_lift = 0.5;   // of the drag

}   // namespace

Vec3 saffman_mei(Vec3 slip, Vec3 vorticity, double d, double viscosity) {
  const double w = norm(slip), omega = norm(vorticity);
  if (!(w > 0 && omega > 0)) return {};
  const double re = w * d / viscosity;
  const double root = 0.3314 * std::sqrt(d * omega / (2 * w));
  // Published in two pieces that part by exp(-4) at Re 40; the first one's exponential goes on here, so that they meet.
  const double f = (1 - root) * std::exp(-re / 10) + root * std::max(1.0, std::sqrt(re / 40));
  return 1.615 * d * d * std::sqrt(viscosity / omega) * f * vorticity;
}

Vec3 magnus(Vec3 slip, Vec3 relative_spin, double d, double viscosity) {
  const double w = norm(slip), spin = norm(relative_spin);
  if (!(w > 0 && spin > 0)) return {};
  const double re = w * d / viscosity, spin_re = spin * d * d / viscosity, slow = spin_re / re;
  const double finite = 0.45 + (slow - 0.45) * std::exp(-0.05684 * std::pow(spin_re, 0.4) * std::pow(re, 0.3));
  return pi / 8 * d * d * d * std::min(finite / slow, 1.0) * relative_spin;
}

double wall_lift_coefficient(double gap, double re) {
  const double touching = 3.663 / std::pow(re * re + 0.1173, 0.22);
  const double decay = std::exp(-std::exp(-0.3 + 0.025 * re) * std::pow(gap, 0.8 + 0.01 * re));
  const double reversal = (1 - std::exp(-gap)) * std::pow(re / 250, 2.5);
  return touching * std::exp(-0.5 * gap * std::pow(re / 250, 4.0 / 3)) * (decay - reversal);
}

Vec3 shear_lift_near_wall(Vec3 slip, Vec3 vorticity, Vec3 at_wall, double d, double viscosity, double distance) {
  const Vec3 far = saffman_mei(slip, vorticity, d, viscosity);
  const double gap = std::max(distance / d - 0.5, 0.0);
  if (gap >= 1) return far;
  const double re = std::min(norm(at_wall) * distance * d / viscosity, 200.0);
  // U^2 is written slip x (shear x distance): the two are one for a sphere at rest, for which the coefficient was made.
  const Vec3 near = pi / 8 * d * d * distance * wall_lift_coefficient(gap, re) * at_wall;
  return (1 - gap) * near + gap * far;
}

Vec3 limited_lift(Vec3 lift_vector, double drag) {
  const double k = norm(lift_vector), most = largest_lift * drag;
  return k > most ? most / k * lift_vector : lift_vector;
}

}   // namespace bedload

#include "solver/coupling/lateral_forces.hpp"

#include <algorithm>
#include <numbers>

#include "solver/coupling/elementary.hpp"

namespace bedload {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double largest_lift = 0.5;   // of the drag

}   // namespace

Quad saffman_mei(Quad slip, Quad vorticity, Quad d, double viscosity) {
  const Quad re = slip * d / viscosity;
  const Quad root_of_rate = 0.3314 * root(d * vorticity / (2.0 * slip));
  // Published in two pieces that part by exp(-4) at Re 40; the first one's exponential goes on here, so that they meet.
  const Quad beyond = root(re / 40.0);
  const Quad f =
      (1.0 - root_of_rate) * exponential(-re / 10.0) + root_of_rate * choose(beyond > 1.0, beyond, quad(1.0));
  return choose((slip > 0.0) & (vorticity > 0.0), 1.615 * d * d * root(viscosity / vorticity) * f, Quad{});
}

Vec3 saffman_mei(Vec3 slip, Vec3 vorticity, double d, double viscosity) {
  return saffman_mei(quad(norm(slip)), quad(norm(vorticity)), quad(d), viscosity)[0] * vorticity;
}

Quad magnus(Quad slip, Quad relative_spin, Quad d, double viscosity) {
  const Quad re = slip * d / viscosity, spin_re = relative_spin * d * d / viscosity, slow = spin_re / re;
  const Quad powers = exponential(0.4 * logarithm(spin_re) + 0.3 * logarithm(re));
  const Quad finite = (0.45 + (slow - 0.45) * exponential(-0.05684 * powers)) / slow;
  const Quad factor = pi / 8 * d * d * d * choose(finite < 1.0, finite, quad(1.0));
  return choose((slip > 0.0) & (relative_spin > 0.0), factor, Quad{});
}

Vec3 magnus(Vec3 slip, Vec3 relative_spin, double d, double viscosity) {
  return magnus(quad(norm(slip)), quad(norm(relative_spin)), quad(d), viscosity)[0] * relative_spin;
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

// Moduli of the contact, and the damping that gives the restitution asked for.
#include "solver/grains/contact_laws.hpp"

#include <algorithm>

namespace bedload {

HertzMindlin::HertzMindlin(const GrainProperties& grains)
    : material_{grains.young_modulus / (1 - grains.poisson * grains.poisson),
                2 * (1 - grains.poisson) / (2 - grains.poisson), grains.friction},
      root_shear_ratio_(std::sqrt(material_.shear_ratio)),
      damping_(damping(damping_of_restitution(std::max(grains.restitution, lowest_restitution)))) {}

HertzMindlin HertzMindlin::without_friction() const {
  HertzMindlin smooth = *this;
  smooth.material_.friction = 0;
  return smooth;
}

// The collision in units in which m* = 4/3 Y* sqrt(R*) = approach speed = 1: x'' = -max(0, x^3/2 + c x^1/4 x') with
// c = alpha sqrt(3/2) (G10). Runge-Kutta of fourth order; only + - * / and square roots, the same bits everywhere.
double restitution_of_damping(double alpha) noexcept {
  const double c = alpha * std::sqrt(1.5);
  const auto acceleration = [c](double x, double v) {
    const double depth = x > 0 ? x : 0, root = std::sqrt(depth);
    const double force = depth * root + c * std::sqrt(root) * v;
    return force > 0 ? -force : 0.0;
  };
  constexpr double h = 2e-3;
  double x = 0, v = 1;
  do {
    const double v1 = v, a1 = acceleration(x, v);
    const double v2 = v + h / 2 * a1, a2 = acceleration(x + h / 2 * v1, v2);
    const double v3 = v + h / 2 * a2, a3 = acceleration(x + h / 2 * v2, v3);
    const double v4 = v + h * a3, a4 = acceleration(x + h * v3, v4);
    x += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  } while (v > 0 || (x > 0 && acceleration(x, v) < 0));   // until apart, or flying apart without force
  return -v;
}

double damping_of_restitution(double restitution) noexcept {
  if (restitution >= 1) return 0;
  double low = 0, high = 1;
  while (restitution_of_damping(high) > restitution) high *= 2;
  for (int halving = 0; halving < 30; ++halving) {
    const double middle = (low + high) / 2;
    (restitution_of_damping(middle) > restitution ? low : high) = middle;
  }
  return (low + high) / 2;
}

}   // namespace bedload

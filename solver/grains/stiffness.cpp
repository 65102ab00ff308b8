// How soft grains may be made: the rule behind stiffness = "auto".
#include <algorithm>
#include <cmath>

#include "solver/grains/bed_packing.hpp"

namespace bedload {
namespace {

constexpr double static_overlap = 0.005;     // under the bed's weight, per diameter [-]
constexpr double collision_overlap = 0.02;   // of a collision at the fastest speed, per diameter [-]
constexpr double strong_shields = 0.3;       // sheared at this Shields number ...
constexpr double viscous_galileo = 18;       // ... if the flow about a grain is laminar, i.e. below this Galileo number

struct Scales {
  double excess;    // |s - 1| [-]
  double gravity;   // [m/s2]
  double galileo;   // sqrt((s-1) g d^3)/nu [-]
};

Scales scales_of(const BedScene& scene) {
  const double d = scene.grains.diameter, excess = std::abs(scene.grains.density / scene.fluid.density - 1);
  const double g = norm(scene.gravity);
  return {excess, g, std::sqrt(excess * g * d * d * d) / scene.fluid.viscosity};
}

/// Of a lone grain, by Schiller and Naumann's drag: Re (1 + 0.15 Re^0.687) = Ga^2/18, by bisection [m/s].
double terminal_speed(const BedScene& scene, const Scales& scales) {
  const double driving = scales.galileo * scales.galileo / 18;
  double low = 0, high = driving;
  for (int halving = 0; halving < 100; ++halving) {
    const double re = (low + high) / 2;
    (re * (1 + 0.15 * std::pow(re, 0.687)) < driving ? low : high) = re;
  }
  return high * scene.fluid.viscosity / scene.grains.diameter;
}

/// The fastest that grains may meet in an onset study [m/s] (G15).
double fastest_encounter(const BedScene& scene) {
  const Scales s = scales_of(scene);
  const double d = scene.grains.diameter;
  const double laminar_shear = strong_shields * s.excess * s.gravity * d / scene.fluid.viscosity;   // of the flow [1/s]
  const double shear_speed =
      s.galileo > viscous_galileo ? std::sqrt(s.excess * s.gravity * d) : 0.2 * laminar_shear * d;
  return std::max(terminal_speed(scene, s), shear_speed);
}

}   // namespace

double bed_layers(const BedScene& scene) {
  constexpr double packing = 0.6;
  const double height = static_cast<double>(scene.source.count) * sphere_volume(scene.grains.diameter) /
                        (packing * scene.length.x * scene.length.y);
  return std::max(1.0, height / (std::sqrt(2.0 / 3) * scene.grains.diameter));   // close layers lie that far apart
}

double automatic_young_modulus(const BedScene& scene, double layers) {
  const GrainProperties& grains = scene.grains;
  const double contact = 1 - grains.poisson * grains.poisson, v = fastest_encounter(scene), d = grains.diameter;
  const double excess_weight = std::abs(grains.density - scene.fluid.density) * norm(scene.gravity) * d;   // [Pa]
  const double under_weight =
      std::numbers::pi / 2 * contact * layers * excess_weight / (static_overlap * std::sqrt(static_overlap));   // (G14)
  const double in_collision = 0.98 * contact * grains.density * v * v / std::pow(collision_overlap, 2.5);       // (G15)
  return std::max(under_weight, in_collision);
}

}   // namespace bedload

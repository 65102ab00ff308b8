// Drag laws as dimensionless multipliers: F = drag/(3 pi mu d U), U the superficial slip speed.
#pragma once

#include <algorithm>
#include <cmath>
#include <string_view>
#include <variant>

#include "solver/scene.hpp"

namespace bedload {

/// A lone sphere in creeping flow. Within 2 % for Re < 0.1.
struct Stokes {
  double multiplier(double /*void_fraction*/, double /*re*/) const noexcept { return 1; }
};

/// A lone sphere, Schiller & Naumann 1933: 1 + 0.15 Re^0.687 to Re 1000, Cd = 0.44 beyond.
struct SchillerNaumann {
  double multiplier(double /*void_fraction*/, double re) const noexcept {
    return re < 1000 ? 1 + 0.15 * std::pow(re, 0.687) : 0.44 * re / 24;
  }
};

/// Spheres in a suspension or bed, Di Felice 1994 (Int. J. Multiphase Flow 20, 153) on Dallavalle's
/// Cd = (0.63 + 4.8/sqrt Re)^2, written without dividing by Re; the exponent is clamped below Re = 1e-6.
struct DiFelice {
  double multiplier(double void_fraction, double re) const noexcept {
    const double root = 0.63 * std::sqrt(re) + 4.8;
    const double decades = 1.5 - std::log10(std::max(re, 1e-6));
    const double chi = 3.7 - 0.65 * std::exp(-0.5 * decades * decades);
    return root * root / 24 * std::pow(void_fraction, -chi);
  }
};

using DragLaw = std::variant<Stokes, SchillerNaumann, DiFelice>;

/// The law of that name; visited once per pass over the grains, never per grain.
DragLaw drag_law(DragLawName);
std::string_view name_of(DragLawName);

/// Speed at which a lone sphere falls under the law in a fluid that stays still [m/s]; W' = 3 pi mu d F U.
/// viscosity: kinematic [m2/s]; density_ratio s > 1; diameter [m]; gravity [m/s2].
double terminal_speed(DragLawName, double viscosity, double density_ratio, double diameter, double gravity);

}   // namespace bedload

// Drag laws as dimensionless multipliers: F = drag/(3 pi mu d U), U the superficial slip speed.
#pragma once

#include <algorithm>
#include <cmath>
#include <string_view>
#include <variant>

#include "solver/scene.hpp"

namespace bedload {

/// Where a law was measured or computed: between two void fractions, up to a Reynolds number.
struct DragRange {
  double lowest_void, highest_void, highest_re;
};

/// No drag law means anything below close packing of equal spheres: void fractions at grains are kept at or above this.
inline constexpr double least_void = 0.26;

/// A law for a lone sphere leaves out what neighbours do: less than 2 % at packing densities below this.
inline constexpr double lone_sphere_void = 0.995;

/// A lone sphere in creeping flow. Within 2 % for Re < 0.1.
struct Stokes {
  static constexpr DragRange range{lone_sphere_void, 1, 0.1};
  double multiplier(double /*void_fraction*/, double /*re*/) const noexcept { return 1; }
};

/// A lone sphere, Schiller & Naumann 1933: 1 + 0.15 Re^0.687 to Re 1000, Newton's Cd = 0.44 beyond, up to the drag crisis.
struct SchillerNaumann {
  static constexpr DragRange range{lone_sphere_void, 1, 2e5};
  double multiplier(double /*void_fraction*/, double re) const noexcept {
    return re < 1000 ? 1 + 0.15 * std::pow(re, 0.687) : 0.44 * re / 24;
  }
};

/// Dallavalle's Cd = (0.63 + 4.8/sqrt Re)^2 of a lone sphere as a multiplier, written without dividing by Re.
inline double dallavalle(double re) noexcept {
  const double root = 0.63 * std::sqrt(re) + 4.8;
  return root * root / 24;
}

/// The bell in log10 Re, centred on Re 32, by which Di Felice's and Rong's exponents sag; clamped below Re = 1e-6.
inline double dip_at_moderate_re(double re) noexcept {
  const double decades = 1.5 - std::log10(std::max(re, 1e-6));
  return std::exp(-0.5 * decades * decades);
}

/// Spheres in a suspension or bed, Di Felice 1994 (Int. J. Multiphase Flow 20, 153) on Dallavalle's lone sphere.
struct DiFelice {
  static constexpr DragRange range{0.36, 1, 1e4};
  double multiplier(double void_fraction, double re) const noexcept {
    return dallavalle(re) * std::pow(void_fraction, -(3.7 - 0.65 * dip_at_moderate_re(re)));
  }
};

/// Packed beds, Ergun 1952 (Chem. Eng. Prog. 48, 89). No drag is left on a lone slow sphere: for beds alone.
struct Ergun {
  static constexpr DragRange range{0.36, 0.65, 1500};
  double multiplier(double void_fraction, double re) const noexcept {
    return (150 * (1 - void_fraction) + 1.75 * re) / (18 * void_fraction * void_fraction);
  }
};

/// Beds and suspensions, Gidaspow 1994 (Multiphase Flow and Fluidization): Ergun where dense, Wen & Yu 1966 where dilute.
/// Published with a jump at eps 0.8; blended here, linearly in eps, over 0.75 to 0.85.
struct Gidaspow {
  static constexpr DragRange range{0.36, 1, 1000};
  double multiplier(double void_fraction, double re) const noexcept {
    const double dilute = std::clamp((void_fraction - 0.75) / 0.1, 0.0, 1.0);
    const double wen_yu = SchillerNaumann{}.multiplier(1, re) * std::pow(void_fraction, -3.65);
    return (1 - dilute) * Ergun{}.multiplier(void_fraction, re) + dilute * wen_yu;
  }
};

/// Random arrays of spheres by lattice Boltzmann, Koch & Hill 2001 (Annu. Rev. Fluid Mech. 33, 619): eps (F0 + F3 Re/2),
/// with Re of the diameter.
struct KochHill {
  static constexpr DragRange range{0.36, 1, 200};
  double multiplier(double void_fraction, double re) const noexcept {
    const double eps = void_fraction, phi = 1 - eps;
    const double logarithm = phi > 0 ? 135.0 / 64 * phi * std::log(phi) : 0;
    const double slow = phi < 0.4 ? (1 + 3 * std::sqrt(phi / 2) + logarithm + 16.14 * phi) /
                                        (1 + phi * (0.681 + phi * (-8.48 + phi * 8.16)))
                                  : 10 * phi / (eps * eps * eps);
    const double inertial = 0.0673 + 0.212 * phi + 0.0232 / (eps * eps * eps * eps * eps);
    return eps * (slow + 0.5 * inertial * re);
  }
};

/// Creeping flow through random arrays, van der Hoef, Beetstra & Kuipers 2005 (J. Fluid Mech. 528, 233).
inline double creeping_array(double void_fraction) noexcept {
  const double eps = void_fraction, phi = 1 - eps;
  return 10 * phi / (eps * eps) + eps * eps * (1 + 1.5 * std::sqrt(phi));
}

/// Random arrays by lattice Boltzmann, Beetstra, van der Hoef & Kuipers 2007 (AIChE J. 53, 489); written without dividing
/// by Re.
struct Beetstra {
  static constexpr DragRange range{0.4, 1, 1000};
  double multiplier(double void_fraction, double re) const noexcept {
    const double eps = void_fraction, phi = 1 - eps;
    const double inertial = ((1 / eps + 3 * phi * eps) * re + 8.4 * std::pow(re, 1 - 0.343)) * 0.413 / (24 * eps * eps);
    const double power = std::pow(re, 0.5 * (1 + 4 * phi));
    return creeping_array(eps) + inertial * power / (power + std::pow(10, 3 * phi));
  }
};

/// Static random arrays by an immersed boundary method, Tang, Peters, Kuipers, Kriebitzsch & van der Hoef 2015 (AIChE J. 61,
/// 688); beyond Re 1000, where the fit turns down, its inertial part goes on in proportion to Re.
struct Tang {
  static constexpr DragRange range{0.4, 1, 1000};
  double multiplier(double void_fraction, double re) const noexcept {
    const double eps = void_fraction, phi = 1 - eps, e4 = eps * eps * eps * eps;
    const double r = std::min(re, range.highest_re);
    const double inertial =
        (0.11 * phi * (1 + phi) - 0.00456 / e4) * r + (0.169 * eps + 0.0644 / e4) * std::pow(r, 1 - 0.343);
    return creeping_array(eps) + inertial * std::max(re / range.highest_re, 1.0);
  }
};

/// Packed beds of a wide range of porosity by lattice Boltzmann, Rong, Dong & Yu 2013 (Chem. Eng. Sci. 99, 44), on
/// Dallavalle's lone sphere.
struct Rong {
  static constexpr DragRange range{0.37, 1, 3000};
  double multiplier(double void_fraction, double re) const noexcept {
    const double eps = void_fraction;
    const double chi = 2.65 * (eps + 1) - (5.3 - 3.5 * eps) * eps * eps * dip_at_moderate_re(re);
    return dallavalle(re) * std::pow(eps, -chi);
  }
};

using DragLaw = std::variant<Stokes, SchillerNaumann, DiFelice, Ergun, Gidaspow, KochHill, Beetstra, Tang, Rong>;

/// The law of that name; visited once per pass over the grains, never per grain.
DragLaw drag_law(DragLawName);
std::string_view name_of(DragLawName);
/// Void fractions and Reynolds numbers for which the law was made.
DragRange range_of(DragLawName);

/// Speed at which a lone sphere falls under the law in a fluid that stays still [m/s]; W' = 3 pi mu d F U. A law for beds
/// alone (Ergun) says nothing of lone spheres: the speed is then Schiller & Naumann's.
/// viscosity: kinematic [m2/s]; density_ratio s > 1; diameter [m]; gravity [m/s2].
double terminal_speed(DragLawName, double viscosity, double density_ratio, double diameter, double gravity);

}   // namespace bedload

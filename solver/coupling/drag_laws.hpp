// Drag laws as dimensionless multipliers: F = drag/(3 pi mu d U), U the superficial slip speed.
#pragma once

#include <numbers>
#include <string_view>
#include <variant>

#include "solver/coupling/elementary.hpp"
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

/// A law is written once, as `of(void fraction, Reynolds number)`, for one grain or for four.
template <class Law>
struct ForOneOrFour {
  double multiplier(double void_fraction, double re) const noexcept { return Law::of(void_fraction, re); }
  Quad multiplier(Quad void_fraction, Quad re) const noexcept { return Law::of(void_fraction, re); }
};

/// A lone sphere in creeping flow. Within 2 % for Re < 0.1.
struct Stokes : ForOneOrFour<Stokes> {
  static constexpr DragRange range{lone_sphere_void, 1, 0.1};
  template <class Real>
  static Real of(Real /*void_fraction*/, Real /*re*/) noexcept {
    return Real{} + 1;
  }
};

/// A lone sphere, Schiller & Naumann 1933: 1 + 0.15 Re^0.687 to Re 1000, Newton's Cd = 0.44 beyond, up to the drag crisis.
struct SchillerNaumann : ForOneOrFour<SchillerNaumann> {
  static constexpr DragRange range{lone_sphere_void, 1, 2e5};
  template <class Real>
  static Real of(Real /*void_fraction*/, Real re) noexcept {
    return choose(re < 1000.0, 1 + 0.15 * power(re, Real{} + 0.687), 0.44 * re / 24.0);
  }
};

/// Dallavalle's Cd = (0.63 + 4.8/sqrt Re)^2 of a lone sphere as a multiplier, written without dividing by Re.
template <class Real>
inline Real dallavalle(Real re) noexcept {
  const Real sum = 0.63 * root(re) + 4.8;
  return sum * sum / 24.0;
}

/// The bell in log10 Re, centred on Re 32, by which Di Felice's and Rong's exponents sag; clamped below Re = 1e-6.
template <class Real>
inline Real dip_at_moderate_re(Real re) noexcept {
  const Real decades = 1.5 - logarithm(choose(re > 1e-6, re, Real{} + 1e-6)) * std::numbers::log10e;
  return exponential(-0.5 * decades * decades);
}

/// Spheres in a suspension or bed, Di Felice 1994 (Int. J. Multiphase Flow 20, 153) on Dallavalle's lone sphere.
struct DiFelice : ForOneOrFour<DiFelice> {
  static constexpr DragRange range{0.36, 1, 1e4};
  template <class Real>
  static Real of(Real void_fraction, Real re) noexcept {
    return dallavalle(re) * power(void_fraction, -(3.7 - 0.65 * dip_at_moderate_re(re)));
  }
};

/// Packed beds, Ergun 1952 (Chem. Eng. Prog. 48, 89). No drag is left on a lone slow sphere: for beds alone.
struct Ergun : ForOneOrFour<Ergun> {
  static constexpr DragRange range{0.36, 0.65, 1500};
  template <class Real>
  static Real of(Real void_fraction, Real re) noexcept {
    return (150.0 * (1.0 - void_fraction) + 1.75 * re) / (18.0 * void_fraction * void_fraction);
  }
};

/// Beds and suspensions, Gidaspow 1994 (Multiphase Flow and Fluidization): Ergun where dense, Wen & Yu 1966 where dilute.
/// Published with a jump at eps 0.8; blended here, linearly in eps, over 0.75 to 0.85.
struct Gidaspow : ForOneOrFour<Gidaspow> {
  static constexpr DragRange range{0.36, 1, 1000};
  template <class Real>
  static Real of(Real void_fraction, Real re) noexcept {
    const Real none{}, one = none + 1.0, above = (void_fraction - 0.75) / 0.1;
    const Real dilute = choose(above < 0.0, none, choose(above > 1.0, one, above));
    const Real wen_yu = SchillerNaumann::of(one, re) * power(void_fraction, none - 3.65);
    return (one - dilute) * Ergun::of(void_fraction, re) + dilute * wen_yu;
  }
};

/// Random arrays of spheres by lattice Boltzmann, Koch & Hill 2001 (Annu. Rev. Fluid Mech. 33, 619): eps (F0 + F3 Re/2),
/// with Re of the diameter.
struct KochHill : ForOneOrFour<KochHill> {
  static constexpr DragRange range{0.36, 1, 200};
  template <class Real>
  static Real of(Real eps, Real re) noexcept {
    const Real phi = 1.0 - eps, e3 = eps * eps * eps;
    const Real dilute = (1.0 + 3.0 * root(phi / 2.0) + 135.0 / 64 * phi * logarithm(phi) + 16.14 * phi) /
                        (1.0 + phi * (0.681 + phi * (-8.48 + phi * 8.16)));
    const Real slow = choose(phi < 0.4, dilute, 10.0 * phi / e3);
    const Real inertial = 0.0673 + 0.212 * phi + 0.0232 / (e3 * eps * eps);
    return eps * (slow + 0.5 * inertial * re);
  }
};

/// Creeping flow through random arrays, van der Hoef, Beetstra & Kuipers 2005 (J. Fluid Mech. 528, 233).
template <class Real>
inline Real creeping_array(Real eps) noexcept {
  const Real phi = 1.0 - eps;
  return 10.0 * phi / (eps * eps) + eps * eps * (1.0 + 1.5 * root(phi));
}

/// Random arrays by lattice Boltzmann, Beetstra, van der Hoef & Kuipers 2007 (AIChE J. 53, 489); written without dividing
/// by Re.
struct Beetstra : ForOneOrFour<Beetstra> {
  static constexpr DragRange range{0.4, 1, 1000};
  template <class Real>
  static Real of(Real eps, Real re) noexcept {
    const Real phi = 1.0 - eps;
    const Real inertial =
        ((1.0 / eps + 3.0 * phi * eps) * re + 8.4 * power(re, Real{} + (1 - 0.343))) * 0.413 / (24.0 * eps * eps);
    const Real steep = power(re, 0.5 * (1.0 + 4.0 * phi));
    return creeping_array(eps) + inertial * steep / (steep + exponential(3 * std::numbers::ln10 * phi));
  }
};

/// Static random arrays by an immersed boundary method, Tang, Peters, Kuipers, Kriebitzsch & van der Hoef 2015 (AIChE J. 61,
/// 688); beyond Re 1000, where the fit turns down, its inertial part goes on in proportion to Re.
struct Tang : ForOneOrFour<Tang> {
  static constexpr DragRange range{0.4, 1, 1000};
  template <class Real>
  static Real of(Real eps, Real re) noexcept {
    const Real phi = 1.0 - eps, e4 = eps * eps * eps * eps, one = Real{} + 1.0;
    const Real beyond = choose(re > range.highest_re, re / range.highest_re, one);
    const Real r = choose(re > range.highest_re, Real{} + range.highest_re, re);
    const Real inertial =
        (0.11 * phi * (1.0 + phi) - 0.00456 / e4) * r + (0.169 * eps + 0.0644 / e4) * power(r, Real{} + (1 - 0.343));
    return creeping_array(eps) + inertial * beyond;
  }
};

/// Packed beds of a wide range of porosity by lattice Boltzmann, Rong, Dong & Yu 2013 (Chem. Eng. Sci. 99, 44), on
/// Dallavalle's lone sphere.
struct Rong : ForOneOrFour<Rong> {
  static constexpr DragRange range{0.37, 1, 3000};
  template <class Real>
  static Real of(Real eps, Real re) noexcept {
    const Real chi = 2.65 * (eps + 1.0) - (5.3 - 3.5 * eps) * eps * eps * dip_at_moderate_re(re);
    return dallavalle(re) * power(eps, -chi);
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

// Logarithm, exponential and power, four at a time, by + - * / and fused multiply-adds alone: the same bits on every machine,
// whatever its library's functions make of its processor.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "solver/coupling/quad.hpp"
#include "solver/grains/lanes.hpp"

namespace bedload {

inline Quad root(Quad x) noexcept {
  for (int t = 0; t < 4; ++t) x[t] = std::sqrt(x[t]);   // one instruction
  return x;
}
inline Quad choose(QuadMask first, Quad a, Quad b) noexcept { return first ? a : b; }

namespace elementary {

// ln 2 in two parts, the first so short that its products with exponents of two are exact.
inline constexpr double ln2_high = 0x1.62e42feep-1, ln2_low = 0x1.a39ef35793c76p-33;
/// Adding and taking away 1.5 2^52 rounds to whole numbers, which then stand in the last bits of the sum.
inline constexpr double rounds = 0x1.8p52;
inline constexpr long long one_exponent = 1023, mantissa_bits = 52;

}   // namespace elementary

/// Natural logarithm of positive numbers, to 4e-16 of it; of 0, and of less than 2^-1022, about -709; no number of
/// what is none, or endless.
inline Quad logarithm(Quad x) noexcept {
  using namespace elementary;
  const QuadMask bits = std::bit_cast<QuadMask>(x), none{};
  const QuadMask mantissa = none + ((1LL << mantissa_bits) - 1), one = none + (one_exponent << mantissa_bits);
  // x = m 2^e with m in [1, 2), then within [1/sqrt 2, sqrt 2].
  QuadMask e = (bits >> mantissa_bits) - one_exponent;
  Quad m = std::bit_cast<Quad>((bits & mantissa) | one);
  const QuadMask large = m > Quad{} + 0x1.6a09e667f3bcdp0;
  m = large ? 0.5 * m : m;
  e -= large;   // a mask is -1
  const Quad exponent = std::bit_cast<Quad>(e + std::bit_cast<long long>(rounds)) - rounds;
  // ln m = 2 artanh s = 2 s (1 + s^2/3 + s^4/5 + ...), |s| <= 0.172
  const Quad s = (m - 1) / (m + 1), z = s * s;
  Quad series = Quad{} + 1.0 / 23;
  for (int k = 21; k >= 3; k -= 2) series = fused(series, z, Quad{} + 1.0 / k);
  const Quad rest = fused(series, z * (s + s), exponent * ln2_low);
  const Quad logarithm_of_x = fused(exponent, Quad{} + ln2_high, (s + s) + rest);
  return fused(x, Quad{}, logarithm_of_x);   // passes on what is no number
}

/// Exponential, to 4e-16 of it; beyond +-700 that of +-700.
inline Quad exponential(Quad x) noexcept {
  using namespace elementary;
  constexpr double largest = 700, per_ln2 = 0x1.71547652b82fep0;
  x = x > Quad{} + largest ? Quad{} + largest : x;
  x = x < Quad{} - largest ? Quad{} - largest : x;
  // e^x = 2^n e^r with |r| <= ln 2/2
  const Quad sum = fused(x, Quad{} + per_ln2, Quad{} + rounds), n = sum - rounds;
  const Quad r = fused(n, Quad{} - ln2_low, fused(n, Quad{} - ln2_high, x));
  constexpr double factorial[] = {1,     1,      2,       6,        24,        120,        720,
                                  5040., 40320., 362880., 3628800., 39916800., 479001600., 6227020800.};
  Quad series = Quad{} + 1 / factorial[13];
  for (int k = 12; k >= 0; --k) series = fused(series, r, Quad{} + 1 / factorial[k]);
  const QuadMask whole = std::bit_cast<QuadMask>(sum) - std::bit_cast<long long>(rounds);
  return series * std::bit_cast<Quad>((whole + one_exponent) << mantissa_bits);
}

/// Of a base that is not negative; 0 to a positive power is less than 1e-100 from an exponent of 1/3 on.
inline Quad power(Quad base, Quad exponent) noexcept { return exponential(exponent * logarithm(base)); }

inline double logarithm(double x) noexcept { return logarithm(Quad{x, x, x, x})[0]; }
inline double exponential(double x) noexcept { return exponential(Quad{x, x, x, x})[0]; }
inline double power(double base, double exponent) noexcept {
  return power(Quad{base, base, base, base}, Quad{exponent, exponent, exponent, exponent})[0];
}

}   // namespace bedload

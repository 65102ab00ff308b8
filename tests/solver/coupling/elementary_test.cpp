// Logarithm, exponential and power of four numbers, against those of long double.
#include "solver/coupling/elementary.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace bedload {
namespace {

/// How far a number is from the right one, in units of the last place.
double ulps(double ours, long double right) {
  const double place =
      std::nextafter(std::abs(double(right)), std::numeric_limits<double>::infinity()) - std::abs(double(right));
  return double(std::abs(ours - right) / place);
}

TEST(Elementary, LogarithmIsRightToTwoUnitsOfTheLastPlace) {
  for (double x = 1e-300; x < 1e300; x *= 1.37)
    ASSERT_LE(ulps(logarithm(x), std::log(static_cast<long double>(x))), 2) << x;
  for (double x = 0.5; x < 2; x += 1.7e-4) ASSERT_LE(ulps(logarithm(x), std::log(static_cast<long double>(x))), 2) << x;
  EXPECT_EQ(logarithm(1.0), 0);
}

TEST(Elementary, ExponentialIsRightToTwoUnitsOfTheLastPlace) {
  for (double x = -690; x < 690; x += 0.0371)
    ASSERT_LE(ulps(exponential(x), std::exp(static_cast<long double>(x))), 2) << x;
  EXPECT_EQ(exponential(0.0), 1);
}

TEST(Elementary, PowerIsRightForVoidFractionsAndReynoldsNumbers) {
  for (double base = 1e-6; base < 1e6; base *= 1.9)
    for (const double exponent : {-5.3, -3.7, -1.0, 0.657, 0.687, 2.0}) {
      const long double right = std::pow(static_cast<long double>(base), static_cast<long double>(exponent));
      // Two and a half units of the last place of the exponential's argument, and two of its own.
      const double argument = std::abs(exponent * std::log(base)), unit = 0x1p-52;
      ASSERT_LE(std::abs(double(power(base, exponent) / right - 1)), (2.5 * argument + 2) * unit)
          << base << " " << exponent;
    }
  EXPECT_EQ(power(1.0, 3.7), 1);
}

TEST(Elementary, StaysFiniteAtTheEdges) {
  EXPECT_LT(power(0.0, 1.0 / 3), 1e-100);
  EXPECT_GE(power(0.0, 1.0 / 3), 0);
  EXPECT_TRUE(std::isfinite(exponential(1e9)) && exponential(-1e9) > 0);
  EXPECT_TRUE(std::isnan(exponential(std::numeric_limits<double>::quiet_NaN())));
}

TEST(Elementary, EachOfFourIsAsIfAlone) {
  const Quad base{0.3, 1e-5, 700, 1}, exponent{-3.5, 0.7, 0.66, 12};
  const Quad together = power(base, exponent);
  for (int t = 0; t < 4; ++t) EXPECT_EQ(together[t], power(base[t], exponent[t]));
}

}   // namespace
}   // namespace bedload

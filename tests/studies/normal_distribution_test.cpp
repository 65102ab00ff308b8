// Probabilities of the normal distribution and their derivatives, in the middle and far out.
#include "studies/normal_distribution.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace bedload {
namespace {

/// By Simpson's rule, of exp(-(z^2 - middle^2)/2), so that nothing underflows: the logarithm of the mass between.
double log_mass_by_quadrature(double m, double h) {
  constexpr int panels = 20000;   // (h m/panels)^4/180 is left out
  double sum = 0;
  for (int n = 0; n <= panels; ++n) {
    const double z = m - h / 2 + h * n / panels;
    sum += (n == 0 || n == panels ? 1 : n % 2 ? 4 : 2) * std::exp((m - z) * (m + z) / 2);
  }
  return std::log(sum * h / panels / 3) - m * m / 2 - std::log(2 * std::numbers::pi) / 2;
}

TEST(NormalDistribution, KeepsItsDigitsInBothTails) {
  EXPECT_NEAR(log_normal_cdf(0), -std::numbers::ln2, 1e-15);
  EXPECT_NEAR(log_normal_cdf(1.9599639845400542), std::log(0.975), 1e-15);   // the tabulated quantile
  EXPECT_NEAR(log_normal_cdf(10) / -7.61985302416053e-24, 1, 1e-12);         // -Q(10), Abramowitz & Stegun table 26.2
  for (const double z : {-6.0, -20.0, -36.9, -37.1, -60.0, -1000.0})
    // Mills' ratio as Laplace's continued fraction, from its 200th denominator upwards.
    EXPECT_NEAR(
        log_normal_cdf(z),
        [z] {
          double below = -z;
          for (int k = 200; k > 0; --k) below = -z + k / below;
          return -z * z / 2 - std::log(2 * std::numbers::pi) / 2 - std::log(below);
        }(),
        1e-14 * z * z)
        << z;
}

TEST(NormalDistribution, KnowsTheMassBetweenWhetherNarrowOrFarOut) {
  for (const double m : {0.0, 0.3, -1.0, 4.0, -12.0, 39.0})
    for (const double h : {1e-9, 1e-3, 0.04, 0.06, 0.5, 1.0}) {
      const double exact = log_mass_by_quadrature(m, h);
      EXPECT_NEAR(log_mass_between(m, h).value, exact, 1e-12 * (1 + std::abs(exact))) << m << " " << h;
    }
}

TEST(NormalDistribution, DifferentiatesItsMass) {
  for (const double m : {0.0, 0.3, -1.0, 4.0, -12.0})
    for (const double h : {0.02, 0.5, 3.0, 20.0}) {
      const LogMass at = log_mass_between(m, h);
      const double step = 1e-4 * std::fmin(1, h);
      const LogMass right = log_mass_between(m + step, h), left = log_mass_between(m - step, h);
      const LogMass wide = log_mass_between(m, h + step), slim = log_mass_between(m, h - step);
      const auto near = [&](double derivative, double high, double low, const char* name) {
        EXPECT_NEAR(derivative, (high - low) / (2 * step), 1e-6 * (1 + std::abs(derivative)))
            << name << " at " << m << ", " << h;
      };
      near(at.m, right.value, left.value, "m");
      near(at.h, wide.value, slim.value, "h");
      near(at.mm, right.m, left.m, "mm");
      near(at.mh, wide.m, slim.m, "mh");
      near(at.mh, right.h, left.h, "hm");
      near(at.hh, wide.h, slim.h, "hh");
    }
}

TEST(NormalDistribution, DifferentiatesTheMassOfOneSide) {
  for (const double z : {-50.0, -3.0, 0.0, 2.0}) {
    const double step = 1e-5;
    for (const auto side : {log_mass_below, log_mass_above}) {
      const LogMass at = side(z), right = side(z + step), left = side(z - step);
      EXPECT_NEAR(at.m, (right.value - left.value) / (2 * step), 1e-6 * (1 + std::abs(at.m))) << z;
      EXPECT_NEAR(at.mm, (right.m - left.m) / (2 * step), 1e-6 * (1 + std::abs(at.mm))) << z;
    }
    EXPECT_EQ(log_mass_above(z).value, log_mass_below(-z).value);
  }
}

TEST(NormalDistribution, KnowsStudents) {
  // Quantiles at 97.5 %, Abramowitz & Stegun table 26.10.
  const struct {
    std::size_t freedom;
    double t;
  } table[] = {{1, 12.706}, {2, 4.303}, {3, 3.182}, {4, 2.776}, {7, 2.365}, {10, 2.228}, {19, 2.093}, {120, 1.980}};
  for (const auto& [freedom, t] : table) EXPECT_NEAR(student_within(t, freedom), 0.95, 1e-4) << freedom;
}

}   // namespace
}   // namespace bedload

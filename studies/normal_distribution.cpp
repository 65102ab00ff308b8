// Complementary error functions, and series where those lose digits.
#include "studies/normal_distribution.hpp"

#include <cmath>
#include <numbers>

namespace bedload {

namespace {

double log_density(double z) { return -z * z / 2 - std::log(2 * std::numbers::pi) / 2; }

/// Density times h times 1 + q, q from the even derivatives of the density: a difference of distributions would lose the
/// digits. To h^4; what is left out is below (h m)^6/322560.
LogMass log_mass_of_narrow(double m, double h) {
  const double second = m * m - 1, fourth = (m * m - 6) * m * m + 3, h2 = h * h, h4 = h2 * h2;
  const double whole = 1 + second * h2 / 24 + fourth * h4 / 1920;
  const double q_m = (2 * m * h2 / 24 + (4 * m * m - 12) * m * h4 / 1920) / whole;
  const double q_h = (second * h / 12 + fourth * h2 * h / 480) / whole;
  const double q_mm = (h2 / 12 + (12 * m * m - 12) * h4 / 1920) / whole;
  const double q_mh = (m * h / 6 + (4 * m * m - 12) * m * h2 * h / 480) / whole;
  const double q_hh = (second / 12 + fourth * h2 / 160) / whole;
  return {log_density(m) + std::log(h) + std::log(whole),
          -m + q_m,
          1 / h + q_h,
          -1 + q_mm - q_m * q_m,
          q_mh - q_m * q_h,
          -1 / h2 + q_hh - q_h * q_h};
}

}   // namespace

// Beyond the range of erfc by the asymptotic series (Abramowitz & Stegun 26.2.12); the first term left out is 945/z^10.
double log_normal_cdf(double z) {
  if (z > 0) return std::log1p(-std::erfc(z / std::numbers::sqrt2) / 2);
  if (z > -37) return std::log(std::erfc(-z / std::numbers::sqrt2) / 2);
  const double y = 1 / (z * z);
  return log_density(z) - std::log(-z) + std::log1p(-y * (1 - 3 * y * (1 - 5 * y * (1 - 7 * y))));
}

LogMass log_mass_below(double z) {
  const double value = log_normal_cdf(z), ratio = std::exp(log_density(z) - value);
  return {value, ratio, 0, -ratio * (ratio + z), 0, 0};
}

LogMass log_mass_above(double z) {
  LogMass mirrored = log_mass_below(-z);
  mirrored.m = -mirrored.m;
  return mirrored;
}

LogMass log_mass_between(double m, double h) {
  if (h * (1 + std::abs(m)) < 0.05) return log_mass_of_narrow(m, h);
  const double mirrored = -std::abs(m);   // into the tail where distributions are small, and differ in all their digits
  const double far = log_normal_cdf(mirrored - h / 2), near = log_normal_cdf(mirrored + h / 2);
  const double value = near + std::log(-std::expm1(far - near));
  const double above = m + h / 2, below = m - h / 2;
  const double at_above = std::exp(log_density(above) - value), at_below = std::exp(log_density(below) - value);
  const double by_m = at_above - at_below, by_h = (at_above + at_below) / 2;
  return {value,
          by_m,
          by_h,
          -above * at_above + below * at_below - by_m * by_m,
          -(above * at_above + below * at_below) / 2 - by_m * by_h,
          (-above * at_above + below * at_below) / 4 - by_h * by_h};
}

// Abramowitz & Stegun 26.7.3 and 26.7.4.
double student_within(double t, std::size_t freedom) {
  const double angle = std::atan(t / std::sqrt(static_cast<double>(freedom)));
  const double sine = std::sin(angle), cosine = std::cos(angle);
  const bool odd = freedom % 2;
  double term = odd ? cosine : 1, sum = 0;
  for (std::size_t power = odd; power + 2 <= freedom; power += 2) {
    sum += term;
    term *= cosine * cosine * static_cast<double>(power + 1) / static_cast<double>(power + 2);
  }
  return odd ? 2 / std::numbers::pi * (angle + sine * sum) : sine * sum;
}

}   // namespace bedload

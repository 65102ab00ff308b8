#include "studies/paired_difference.hpp"

#include <cmath>
#include <limits>

namespace bedload {

namespace {

double mean_of(const std::vector<SingleDifference>& singles) {
  double sum = 0;
  for (const SingleDifference& s : singles) sum += s.difference;
  return sum / static_cast<double>(singles.size());
}

}   // namespace

bool PairedDifference::seen() const { return std::abs(mean) > uncertainty; }
double PairedDifference::size() const { return std::fmax(std::abs(mean), uncertainty); }

SingleDifference log_ratio(double base, double base_lower, double base_upper, double other, double other_lower,
                           double other_upper) {
  const auto deviation = [](double lower, double upper) { return std::log(upper / lower) / (2 * std::sqrt(3.0)); };
  return {std::log(other / base), std::hypot(deviation(base_lower, base_upper), deviation(other_lower, other_upper))};
}

SingleDifference symmetric_difference(double base, double base_error, double other, double other_error) {
  const double sum = base + other;
  return {2 * (other - base) / sum, 4 / (sum * sum) * std::hypot(other * base_error, base * other_error)};
}

double pooled_deviation(const Differences& all) {
  double squares = 0, freedom = 0;
  for (const auto& singles : all) {
    if (singles.size() < 2) continue;
    const double mean = mean_of(singles);
    for (const SingleDifference& s : singles) squares += (s.difference - mean) * (s.difference - mean);
    freedom += static_cast<double>(singles.size() - 1);
  }
  return freedom > 0 ? std::sqrt(squares / freedom) : 0;
}

PairedDifference paired(const std::vector<SingleDifference>& singles, double pooled) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  if (singles.empty()) return {unknown, unknown};
  const double n = static_cast<double>(singles.size());
  double squares = 0;
  for (const SingleDifference& s : singles) squares += s.error * s.error;
  return {mean_of(singles), 2 * std::sqrt(squares / n + pooled * pooled) / std::sqrt(n)};
}

PairedDifference relative(const PairedDifference& logarithmic) {
  return {std::expm1(logarithmic.mean), logarithmic.uncertainty * std::exp(logarithmic.mean)};
}

PairedDifference relative_of_symmetric(const PairedDifference& symmetric) {
  const auto ratio = [](double s) { return s < 2 ? (2 + s) / (2 - s) : std::numeric_limits<double>::infinity(); };
  const double mean = symmetric.mean, low = std::fmax(mean - symmetric.uncertainty, -2),
               high = mean + symmetric.uncertainty;
  const double below = ratio(mean) - ratio(low), above = ratio(high) - ratio(mean);
  if (!symmetric.seen()) return {ratio(mean) - 1, std::fmax(below, above)};
  return {ratio(mean) - 1, mean > 0 ? below : above};
}

}   // namespace bedload

#include "studies/paired_difference.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

namespace bedload {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

double mean_of(const Differences& singles) {
  double sum = 0;
  for (const SingleDifference& s : singles) sum += s.difference;
  return sum / static_cast<double>(singles.size());
}

/// Bit for bit the same outcomes: the change has not begun to act.
bool nothing_changed(const Differences& singles) {
  return !singles.empty() &&
         std::ranges::all_of(singles, [](const auto& s) { return s.difference == 0 && s.error == 0; });
}

std::set<std::string> packings_of(const std::vector<Differences>& changes) {
  std::set<std::string> all;
  for (const Differences& singles : changes)
    for (const SingleDifference& s : singles) all.insert(s.packing);
  return all;
}

/// In rows of changes that have all packings, in the order of the packings.
std::vector<std::vector<double>> complete_rows(const std::vector<Differences>& changes) {
  const auto packings = packings_of(changes);
  std::vector<std::vector<double>> rows;
  for (const Differences& singles : changes) {
    if (singles.size() != packings.size() || nothing_changed(singles)) continue;
    std::vector<double>& row = rows.emplace_back();
    for (const auto& packing : packings)
      row.push_back(std::ranges::find(singles, packing, &SingleDifference::packing)->difference);
  }
  return rows;
}

}   // namespace

bool PairedDifference::known() const { return !std::isnan(low) && !std::isnan(high); }
bool PairedDifference::seen() const { return low > 0 || high < 0; }
double PairedDifference::worst() const { return known() ? std::max(std::abs(low), std::abs(high)) : unknown; }

SingleDifference log_ratio(double base, double base_lower, double base_upper, double other, double other_lower,
                           double other_upper) {
  const auto deviation = [](double lower, double upper) { return std::log(upper / lower) / (2 * std::sqrt(3.0)); };
  return {std::log(other / base), std::hypot(deviation(base_lower, base_upper), deviation(other_lower, other_upper))};
}

SingleDifference symmetric_difference(double base, double base_error, double other, double other_error) {
  const double sum = base + other;
  return {2 * (other - base) / sum, 4 / (sum * sum) * std::hypot(other * base_error, base * other_error)};
}

Scatter scatter_of(const std::vector<Differences>& changes) {
  const auto rows = complete_rows(changes);
  if (rows.empty() || rows[0].size() < 2) return {};
  const std::size_t packings = rows[0].size();
  const double count = static_cast<double>(rows.size()), n = static_cast<double>(packings);
  std::vector<double> of_packing(packings);   // mean over the changes
  double of_all = 0;
  for (const auto& row : rows)
    for (std::size_t p = 0; p < packings; ++p) of_packing[p] += row[p] / count, of_all += row[p] / (count * n);
  const bool alone = rows.size() == 1;
  double squares = 0;
  for (const auto& row : rows) {
    double of_row = 0;
    for (const double d : row) of_row += d / n;
    for (std::size_t p = 0; p < packings; ++p) {
      const double left = row[p] - of_row - (alone ? 0 : of_packing[p] - of_all);
      squares += left * left;
    }
  }
  const double freedom = alone ? n - 1 : (count - 1) * (n - 1);
  return {std::sqrt(squares / (alone ? 2 * freedom : freedom)), freedom};
}

PairedDifference paired(const Differences& singles, const Scatter& scatter) {
  if (singles.empty()) return {unknown, unknown, unknown};
  const double n = static_cast<double>(singles.size()), mean = mean_of(singles);
  if (nothing_changed(singles)) return {};
  if (!(scatter.freedom > 0)) return {mean, unknown, unknown};
  double squares = 0;
  for (const SingleDifference& s : singles) squares += s.error * s.error;
  const double half =
      std::max(student_95(scatter.freedom) * scatter.deviation * std::sqrt(2 / n), 2 * std::sqrt(squares) / n);
  return {mean, mean - half, mean + half};
}

PairedDifference relative(const PairedDifference& logarithmic) {
  return {std::expm1(logarithmic.mean), std::expm1(logarithmic.low), std::expm1(logarithmic.high)};
}

PairedDifference relative_of_symmetric(const PairedDifference& symmetric) {
  const auto relative_of = [](double s) {
    return s >= 2 ? std::numeric_limits<double>::infinity() : s <= -2 ? -1 : 2 * s / (2 - s);
  };
  return {relative_of(symmetric.mean), relative_of(symmetric.low), relative_of(symmetric.high)};
}

double student_95(double freedom) {
  constexpr std::array table{12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228};
  if (freedom <= 10) return table[static_cast<std::size_t>(std::max(freedom, 1.0)) - 1];
  return 1.960 + 2.4 / freedom + 2.7 / (freedom * freedom);
}

}   // namespace bedload

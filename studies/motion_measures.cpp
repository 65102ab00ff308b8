#include "studies/motion_measures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "studies/database_values.hpp"

namespace bedload {

namespace {

constexpr double open_above = std::numeric_limits<double>::infinity();

/// Of two middle ones the mean.
double median_of(std::vector<double> numbers) {
  std::ranges::sort(numbers);
  const std::size_t half = numbers.size() / 2;
  return numbers.size() % 2 == 1 ? numbers[half] : (numbers[half - 1] + numbers[half]) / 2;
}

/// What the seeds of one set say.
struct OfSeeds {
  std::string set, label;
  std::array<std::vector<ShieldsBounds>, 4> reached;   // in the order of MotionMeasures
  std::vector<ShieldsBounds> flux_threshold;
  std::vector<double> flux_error;
  double exponent = 0;
};

/// NULL = open, or not known within its bounds.
ShieldsBounds bounds_in(const Value& shields, const Value& lower, const Value& upper) {
  if (const double found = number_in(shields); std::isfinite(found)) return {found, found};
  const double from = number_in(lower), to = number_in(upper);
  return {std::isfinite(from) ? from : 0, std::isfinite(to) ? to : open_above};
}

std::size_t place_of(const std::string& criterion, double value) {
  if (criterion == "moved_grains") return 0;
  if (criterion == "moved_fraction") return value < 0.05 ? 1 : 2;
  return 3;
}

std::string counted_cases(const Database& database) {
  return in_study(database) + " AND case_id NOT IN (SELECT case_id FROM variations)";
}

/// The sets in the curve's order, with what is in `thresholds`.
std::vector<OfSeeds> read_thresholds(const Database& database) {
  std::vector<OfSeeds> sets;
  const Rows found = database.query(fmt::format(
      "SELECT s.parameter_set, s.set_label, t.criterion, t.value, t.shields, t.shields_lower, t.shields_upper "
      "FROM scenes s JOIN thresholds t USING (case_id) WHERE t.criterion IN ('moved_grains', 'moved_fraction', "
      "'reference_transport') AND {} "
      "ORDER BY s.diameter_m, s.density_ratio, s.viscosity_m2_per_s, s.parameter_set, s.seed",
      counted_cases(database)));
  for (const auto& row : found.rows) {
    if (sets.empty() || sets.back().set != text_in(row[0])) {
      OfSeeds& of = sets.emplace_back();
      of.set = text_in(row[0]), of.label = text_in(row[1]);
    }
    const ShieldsBounds bounds = bounds_in(row[4], row[5], row[6]);
    if (bounds != ShieldsBounds{0, open_above})
      sets.back().reached[place_of(text_in(row[2]), number_in(row[3]))].push_back(bounds);
  }
  return sets;
}

void read_flux_laws(const Database& database, std::vector<OfSeeds>& sets) {
  const Rows found =
      database.query(fmt::format("SELECT s.parameter_set, f.exponent, f.threshold, f.threshold_error "
                                 "FROM flux_laws f JOIN scenes s USING (case_id) WHERE {} ORDER BY s.seed",
                                 counted_cases(database)));
  for (const auto& row : found.rows) {
    const auto of = std::ranges::find(sets, text_in(row[0]), &OfSeeds::set);
    if (of == sets.end()) continue;
    of->exponent = number_in(row[1]);
    of->flux_threshold.push_back({number_in(row[2]), number_in(row[2])});
    of->flux_error.push_back(number_in(row[3]));
  }
}

MotionMeasures summary_of(const OfSeeds& of) {
  MotionMeasures motion{.set = of.set,
                        .label = of.label,
                        .first_grain = over_seeds(of.reached[0]),
                        .one_percent = over_seeds(of.reached[1]),
                        .ten_percent = over_seeds(of.reached[2]),
                        .reference_transport = over_seeds(of.reached[3]),
                        .flux_law = {}};
  if (!of.flux_threshold.empty())
    motion.flux_law = {of.exponent, over_seeds(of.flux_threshold), median_of(of.flux_error)};
  return motion;
}

std::string median_in_words(ShieldsBounds b) {
  if (b.lower == b.upper) return fmt::format("{:.4f}", b.lower);
  if (b.lower == 0) return fmt::format("< {:.4f}", b.upper);
  if (std::isinf(b.upper)) return fmt::format("> {:.4f}", b.lower);
  return fmt::format("{:.4f} to {:.4f}", b.lower, b.upper);
}

std::string range_in_words(const OverSeeds& of) {
  if (of.seeds < 2) return {};
  const auto least =
      of.least.lower == 0 ? fmt::format("<{:.4f}", of.least.upper) : fmt::format("{:.4f}", of.least.lower);
  const auto greatest = std::isinf(of.greatest.upper) ? fmt::format(">{:.4f}", of.greatest.lower)
                                                      : fmt::format("{:.4f}", of.greatest.upper);
  return fmt::format(" ({}-{})", least, greatest);
}

}   // namespace

OverSeeds over_seeds(const std::vector<ShieldsBounds>& seeds) {
  if (seeds.empty()) return {};
  std::vector<double> lower, upper;
  for (const ShieldsBounds& seed : seeds) lower.push_back(seed.lower), upper.push_back(seed.upper);
  return {{median_of(lower), median_of(upper)},
          {std::ranges::min(lower), std::ranges::min(upper)},
          {std::ranges::max(lower), std::ranges::max(upper)},
          seeds.size()};
}

std::vector<MotionMeasures> motion_measures(const Database& database) {
  std::vector<MotionMeasures> all;
  if (!has_table(database, "thresholds")) return all;
  std::vector<OfSeeds> sets = read_thresholds(database);
  read_flux_laws(database, sets);
  for (const OfSeeds& of : sets) all.push_back(summary_of(of));
  return all;
}

std::string in_words(const OverSeeds& of) {
  return of.seeds == 0 ? "-" : median_in_words(of.median) + range_in_words(of);
}

std::string in_words(const FluxLaws& law) {
  return fmt::format("{} +- {:.2g}{}", median_in_words(law.threshold.median), law.threshold_error,
                     range_in_words(law.threshold));
}

std::string motion_as_table(const std::vector<MotionMeasures>& all) {
  if (all.empty()) return {};
  std::vector<std::array<std::string, 6>> lines{
      {"scene", "first grain", "1 % moved", "10 % moved", "W* = 0.002", "flux law: n, theta_0"}};
  for (const MotionMeasures& m : all)
    lines.push_back({m.label, in_words(m.first_grain), in_words(m.one_percent), in_words(m.ten_percent),
                     in_words(m.reference_transport),
                     m.flux_law ? fmt::format("{:g}, {}", m.flux_law->exponent, in_words(*m.flux_law)) : "-"});
  std::array<std::size_t, 6> widths{};
  for (const auto& line : lines)
    for (std::size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], line[c].size());
  std::string text = "\nmotion, Shields numbers: median over the seeds (lowest-highest)\n";
  for (const auto& line : lines) {
    std::string row;
    for (std::size_t c = 0; c < line.size(); ++c) row += fmt::format("{:<{}}  ", line[c], widths[c]);
    text += row.substr(0, row.find_last_not_of(' ') + 1) + "\n";
  }
  return text +
         "flux law: q* = k (theta - theta_0)^n over the holds that move; -: no seed has three of them that fit\n";
}

}   // namespace bedload

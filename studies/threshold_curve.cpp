// From the thresholds of cases to one point per parameter set.
#include "studies/threshold_curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/dimensionless.hpp"
#include "studies/database_values.hpp"
#include "studies/error_budget.hpp"

namespace bedload {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// The threshold of one seed.
struct SeedThreshold {
  std::uint64_t seed;
  std::string status;
  double lower, upper, stop_lower, stop_upper;
};

/// The least (or greatest) of bounds; open as soon as one of them is.
template <class Better>
double extreme(const std::vector<SeedThreshold>& seeds, double SeedThreshold::*bound, Better better) {
  double found = seeds.front().*bound;
  for (const SeedThreshold& seed : seeds) {
    if (std::isnan(seed.*bound)) return unknown;
    if (better(seed.*bound, found)) found = seed.*bound;
  }
  return found;
}

std::string_view name_of(ThresholdStatus status) {
  switch (status) {
    case ThresholdStatus::bracketed: return "bracketed";
    case ThresholdStatus::only_upper_bound: return "censored_below";
    case ThresholdStatus::only_lower_bound: return "censored_above";
    case ThresholdStatus::none: return "noisy";
  }
  return "noisy";
}

/// 0 and infinity are the open ends of a fit; in a table they are not known.
double known(double end) { return end > 0 && std::isfinite(end) ? end : unknown; }

/// theta_50 by the fit, and its interval.
void fit_onset(const std::vector<SeedThreshold>& seeds, ThresholdPoint& point) {
  std::vector<SeedBracket> brackets;
  for (const SeedThreshold& seed : seeds) brackets.push_back(seed_bracket(seed.seed, seed.lower, seed.upper));
  const ThresholdFit fit = fit_threshold(brackets);
  point.status = name_of(fit.status);
  point.shields = fit.theta_50, point.shields_16 = fit.theta_16, point.shields_84 = fit.theta_84;
  const ThresholdInterval interval = interval_of_threshold(brackets);
  point.confidence = interval.confidence;
  point.interval_lower = interval.confidence > 0 ? known(interval.lower) : unknown;
  point.interval_upper = interval.confidence > 0 ? known(interval.upper) : unknown;
  if (fit.status == ThresholdStatus::only_lower_bound) point.lower = fit.lower;   // holds for every seed that has one
  if (fit.status == ThresholdStatus::only_upper_bound) point.upper = fit.upper;
}

/// theta_stop by the same fit.
void fit_stop(const std::vector<SeedThreshold>& seeds, ThresholdPoint& point) {
  std::vector<SeedBracket> brackets;
  for (const SeedThreshold& seed : seeds) brackets.push_back(seed_bracket(seed.seed, seed.stop_lower, seed.stop_upper));
  const ThresholdFit fit = fit_threshold(brackets);
  const ThresholdInterval interval = interval_of_threshold(brackets);
  const bool says = fit.status == ThresholdStatus::bracketed && interval.confidence > 0;
  point.stop = fit.theta_50;
  point.stop_interval_lower = says ? known(interval.lower) : unknown;
  point.stop_interval_upper = says ? known(interval.upper) : unknown;
  point.hysteresis = 1 - point.stop / point.shields;
}

void summarise(const std::vector<SeedThreshold>& seeds, ThresholdPoint& point) {
  point.seeds = seeds.size();
  for (const SeedThreshold& seed : seeds)
    ++(seed.status == "bracketed"        ? point.bracketed
       : seed.status == "censored_below" ? point.censored_below
       : seed.status == "censored_above" ? point.censored_above
                                         : point.noisy);
  point.lower = extreme(seeds, &SeedThreshold::lower, std::less<>());
  point.upper = extreme(seeds, &SeedThreshold::upper, std::greater<>());
  fit_onset(seeds, point);
  fit_stop(seeds, point);
  const double quoted = std::isfinite(point.shields) ? point.shields
                        : std::isfinite(point.lower) ? point.lower
                                                     : point.upper;
  point.reynolds = friction_reynolds_number(quoted, point.galileo);
}

/// Every finished seed that counts, in the curve's order.
Rows seeds_in_order(const Database& database) {
  return database.query(fmt::format(
      "SELECT s.parameter_set, s.set_label, s.diameter_m, s.density_ratio, s.viscosity_m2_per_s, s.galileo, "
      "s.cell_z_m / s.diameter_m, t.criterion, t.value, t.method, s.seed, t.status, t.shields_lower, t.shields_upper, "
      "t.stop_lower, t.stop_upper FROM scenes s JOIN thresholds t USING (case_id) WHERE t.decides = 1 AND {} "
      "AND case_id NOT IN (SELECT case_id FROM variations) "
      "ORDER BY s.diameter_m, s.density_ratio, s.viscosity_m2_per_s, s.parameter_set, s.seed",
      in_study(database)));
}

std::vector<ThresholdPoint> curve_from_thresholds(const Database& database) {
  std::vector<ThresholdPoint> curve;
  std::vector<std::vector<SeedThreshold>> seeds;
  for (const auto& row : seeds_in_order(database).rows) {
    const std::string set = text_in(row[0]);
    if (curve.empty() || curve.back().set != set) {
      seeds.emplace_back();
      ThresholdPoint& point = curve.emplace_back();
      point.set = set;
      point.label = text_in(row[1]);
      point.diameter = number_in(row[2]);
      point.density_ratio = number_in(row[3]);
      point.viscosity = number_in(row[4]);
      point.galileo = number_in(row[5]);
      point.cell_z = number_in(row[6]);
      point.criterion = text_in(row[7]);
      point.criterion_value = number_in(row[8]);
      point.method = text_in(row[9]);
    }
    seeds.back().push_back({static_cast<std::uint64_t>(std::get<std::int64_t>(row[10])), text_in(row[11]),
                            number_in(row[12]), number_in(row[13]), number_in(row[14]), number_in(row[15])});
  }
  const double systematic = systematic_error(error_budget(database));
  for (std::size_t n = 0; n < curve.size(); ++n) {
    summarise(seeds[n], curve[n]);
    curve[n].systematic = systematic;
  }
  return curve;
}

Value value_of(const std::string& word) { return word; }
Value value_of(double number) { return real_or_null(number); }
Value value_of(std::uint64_t number) { return static_cast<std::int64_t>(number); }

void read(const Value& value, std::string& word) { word = text_in(value); }
void read(const Value& value, double& number) { number = number_in(value); }
void read(const Value& value, std::uint64_t& number) {
  number = static_cast<std::uint64_t>(std::get<std::int64_t>(value));
}

/// The table's columns, a comma between.
std::string columns() {
  const ThresholdPoint any;
  std::string names;
  ThresholdPoint::each(
      any, [&](std::string_view name, const auto&) { names.append(names.empty() ? "" : ", ").append(name); });
  return names;
}

void insert(Database& database, const ThresholdPoint& point) {
  std::vector<Value> values;
  std::string places;
  ThresholdPoint::each(point, [&](std::string_view, const auto& member) {
    places += values.empty() ? "?" : ", ?";
    values.push_back(value_of(member));
  });
  database.execute(fmt::format("INSERT INTO threshold_curve ({}) VALUES ({})", columns(), places), values);
}

}   // namespace

SeedBracket seed_bracket(std::uint64_t seed, double lower, double upper) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  if (lower > upper) std::swap(lower, upper);
  if (lower == upper) upper = std::nextafter(upper, infinite);
  return {seed, std::isnan(lower) ? 0 : lower, std::isnan(upper) ? infinite : upper};
}

void update_threshold_curve(Database& database) {
  Database::Transaction transaction(database);
  database.execute("DELETE FROM threshold_curve");
  for (const ThresholdPoint& point : curve_from_thresholds(database)) insert(database, point);
  store_error_sources(database);
  transaction.commit();
}

std::vector<ThresholdPoint> threshold_curve(const Database& database) {
  std::vector<ThresholdPoint> curve;
  if (!has_table(database, "threshold_curve")) return curve;
  const Rows found = database.query(fmt::format(
      "SELECT {} FROM threshold_curve ORDER BY diameter_m, density_ratio, viscosity_m2_per_s, parameter_set",
      columns()));
  for (const auto& row : found.rows) {
    std::size_t column = 0;
    ThresholdPoint::each(curve.emplace_back(), [&](std::string_view, auto& member) { read(row[column++], member); });
  }
  return curve;
}

}   // namespace bedload

// From the thresholds of cases to one point per parameter set.
#include "studies/threshold_curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/dimensionless.hpp"
#include "studies/database_values.hpp"

namespace bedload {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

/// The threshold of one seed.
struct SeedThreshold {
  std::string status;
  double shields, lower, upper;

  /// Where it stands among the others: a censored seed lies beyond every value that was found.
  double rank() const {
    if (std::isfinite(shields)) return shields;
    return status == "censored_below" ? -infinite : infinite;
  }
};

double median_of(std::vector<double> ranks) {
  std::sort(ranks.begin(), ranks.end());
  const std::size_t n = ranks.size();
  const double below = ranks[(n - 1) / 2], above = ranks[n / 2];
  return below == above ? below : (below + above) / 2;   // equal infinities stay what they are
}

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

/// Of the seed at the median: bracketed when theta_c is known from a bracket, else how it is censored.
std::string status_of(const ThresholdPoint& point, double median) {
  if (std::isfinite(median)) return point.bracketed > 0 ? "bracketed" : "noisy";
  if (median < 0) return "censored_below";
  return point.censored_above > 0 || point.noisy == 0 ? "censored_above" : "noisy";
}

void summarise(const std::vector<SeedThreshold>& seeds, ThresholdPoint& point) {
  std::vector<double> ranks;
  for (const SeedThreshold& seed : seeds) {
    ranks.push_back(seed.rank());
    ++(seed.status == "bracketed"        ? point.bracketed
       : seed.status == "censored_below" ? point.censored_below
       : seed.status == "censored_above" ? point.censored_above
                                         : point.noisy);
  }
  const double median = median_of(ranks);
  point.seeds = seeds.size();
  point.status = status_of(point, median);
  point.shields = std::isfinite(median) ? median : unknown;
  point.lower = extreme(seeds, &SeedThreshold::lower, std::less<>());
  point.upper = extreme(seeds, &SeedThreshold::upper, std::greater<>());
  if (!std::isfinite(median)) {   // the bound that holds for every seed beyond which it lies
    if (point.status == "censored_above" && std::isnan(point.lower))
      for (const SeedThreshold& seed : seeds) point.lower = std::fmin(point.lower, seed.lower);
    if (point.status == "censored_below" && std::isnan(point.upper))
      for (const SeedThreshold& seed : seeds) point.upper = std::fmax(point.upper, seed.upper);
  }
  const double quoted = std::isfinite(point.shields) ? point.shields
                        : std::isfinite(point.lower) ? point.lower
                                                     : point.upper;
  point.reynolds = friction_reynolds_number(quoted, point.galileo);
}

/// Every finished seed that counts, in the curve's order.
Rows seeds_in_order(const Database& database) {
  return database.query(fmt::format(
      "SELECT s.parameter_set, s.set_label, s.diameter_m, s.density_ratio, s.viscosity_m2_per_s, s.galileo, "
      "s.cell_z_m / s.diameter_m, t.criterion, t.value, t.status, t.shields, t.shields_lower, t.shields_upper, "
      "t.method FROM "
      "scenes s JOIN thresholds t USING (case_id) WHERE t.decides = 1 AND {} "
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
      point.method = text_in(row[13]);
    }
    seeds.back().push_back({text_in(row[9]), number_in(row[10]), number_in(row[11]), number_in(row[12])});
  }
  for (std::size_t n = 0; n < curve.size(); ++n) summarise(seeds[n], curve[n]);
  return curve;
}

Value count(std::uint64_t number) { return static_cast<std::int64_t>(number); }

}   // namespace

void update_threshold_curve(Database& database) {
  Database::Transaction transaction(database);
  database.execute("DELETE FROM threshold_curve");
  for (const ThresholdPoint& p : curve_from_thresholds(database))
    database.execute("INSERT INTO threshold_curve VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
                     {p.set,
                      p.label,
                      p.diameter,
                      p.density_ratio,
                      p.viscosity,
                      p.cell_z,
                      p.criterion,
                      p.criterion_value,
                      real_or_null(p.galileo),
                      real_or_null(p.reynolds),
                      real_or_null(p.shields),
                      real_or_null(p.lower),
                      real_or_null(p.upper),
                      p.status,
                      count(p.seeds),
                      count(p.bracketed),
                      count(p.censored_below),
                      count(p.censored_above),
                      count(p.noisy),
                      p.method});
  transaction.commit();
}

std::vector<ThresholdPoint> threshold_curve(const Database& database) {
  std::vector<ThresholdPoint> curve;
  if (!has_table(database, "threshold_curve")) return curve;
  const Rows found = database.query(
      "SELECT parameter_set, label, diameter_m, density_ratio, viscosity_m2_per_s, cell_z_d, criterion, "
      "criterion_value, "
      "galileo, friction_reynolds, shields, shields_lower, shields_upper, status, seeds, bracketed, censored_below, "
      "censored_above, noisy, method FROM "
      "threshold_curve "
      "ORDER BY diameter_m, density_ratio, viscosity_m2_per_s, parameter_set");
  const auto whole = [](const Value& value) { return static_cast<std::uint64_t>(std::get<std::int64_t>(value)); };
  for (const auto& row : found.rows)
    curve.push_back({.set = text_in(row[0]),
                     .label = text_in(row[1]),
                     .diameter = number_in(row[2]),
                     .density_ratio = number_in(row[3]),
                     .viscosity = number_in(row[4]),
                     .cell_z = number_in(row[5]),
                     .criterion = text_in(row[6]),
                     .criterion_value = number_in(row[7]),
                     .galileo = number_in(row[8]),
                     .reynolds = number_in(row[9]),
                     .shields = number_in(row[10]),
                     .lower = number_in(row[11]),
                     .upper = number_in(row[12]),
                     .status = text_in(row[13]),
                     .seeds = whole(row[14]),
                     .bracketed = whole(row[15]),
                     .censored_below = whole(row[16]),
                     .censored_above = whole(row[17]),
                     .noisy = whole(row[18]),
                     .method = text_in(row[19])});
  return curve;
}

}   // namespace bedload

// From the thresholds of cases to one point per parameter set, and that curve as text.
#include "studies/threshold_curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "solver/dimensionless.hpp"
#include "studies/database_values.hpp"
#include "studies/published_curves.hpp"

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
  const double quoted = std::isfinite(point.shields) ? point.shields : std::isfinite(point.lower) ? point.lower : point.upper;
  point.reynolds = friction_reynolds_number(quoted, point.galileo);
}

/// Every finished seed that counts, in the curve's order.
Rows seeds_in_order(const Database& database) {
  return database.query(fmt::format(
      "SELECT s.parameter_set, s.set_label, s.diameter_m, s.density_ratio, s.viscosity_m2_per_s, s.galileo, t.status, t.shields, "
      "t.shields_lower, t.shields_upper FROM scenes s JOIN thresholds t USING (case_id) WHERE t.decides = 1 AND {} "
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
    }
    seeds.back().push_back({text_in(row[6]), number_in(row[7]), number_in(row[8]), number_in(row[9])});
  }
  for (std::size_t n = 0; n < curve.size(); ++n) summarise(seeds[n], curve[n]);
  return curve;
}

Value count(std::uint64_t number) { return static_cast<std::int64_t>(number); }

}  // namespace

void update_threshold_curve(Database& database) {
  Database::Transaction transaction(database);
  database.execute("DELETE FROM threshold_curve");
  for (const ThresholdPoint& p : curve_from_thresholds(database))
    database.execute("INSERT INTO threshold_curve VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
                     {p.set, p.label, p.diameter, p.density_ratio, p.viscosity, real_or_null(p.galileo), real_or_null(p.reynolds),
                      real_or_null(p.shields), real_or_null(p.lower), real_or_null(p.upper), p.status, count(p.seeds),
                      count(p.bracketed), count(p.censored_below), count(p.censored_above), count(p.noisy)});
  transaction.commit();
}

std::vector<ThresholdPoint> threshold_curve(const Database& database) {
  std::vector<ThresholdPoint> curve;
  if (!has_table(database, "threshold_curve")) return curve;
  const Rows found = database.query(
      "SELECT parameter_set, label, diameter_m, density_ratio, viscosity_m2_per_s, galileo, friction_reynolds, shields, "
      "shields_lower, shields_upper, status, seeds, bracketed, censored_below, censored_above, noisy FROM threshold_curve "
      "ORDER BY diameter_m, density_ratio, viscosity_m2_per_s, parameter_set");
  const auto whole = [](const Value& value) { return static_cast<std::uint64_t>(std::get<std::int64_t>(value)); };
  for (const auto& row : found.rows)
    curve.push_back({.set = text_in(row[0]), .label = text_in(row[1]), .diameter = number_in(row[2]),
                     .density_ratio = number_in(row[3]), .viscosity = number_in(row[4]), .galileo = number_in(row[5]),
                     .reynolds = number_in(row[6]), .shields = number_in(row[7]), .lower = number_in(row[8]),
                     .upper = number_in(row[9]), .status = text_in(row[10]), .seeds = whole(row[11]), .bracketed = whole(row[12]),
                     .censored_below = whole(row[13]), .censored_above = whole(row[14]), .noisy = whole(row[15])});
  return curve;
}

namespace {

/// theta_c, or the bound beyond which it lies.
std::string shields_or_bound(const ThresholdPoint& p) {
  if (std::isfinite(p.shields)) return fmt::format("{:.4f}", p.shields);
  if (p.status == "censored_below" && std::isfinite(p.upper)) return fmt::format("< {:.4f}", p.upper);
  if (std::isfinite(p.lower)) return fmt::format("> {:.4f}", p.lower);
  return "-";
}

std::string or_dash(double number, int digits) { return std::isfinite(number) ? fmt::format("{:.{}f}", number, digits) : "-"; }

std::string or_empty(double number) { return std::isfinite(number) ? fmt::format("{}", number) : ""; }

std::size_t widest_label(const std::vector<ThresholdPoint>& curve) {
  std::size_t width = 5;
  for (const ThresholdPoint& p : curve) width = std::max(width, p.label.size());
  return width;
}

}  // namespace

std::string curve_as_table(const std::vector<ThresholdPoint>& curve) {
  const std::size_t width = widest_label(curve);
  std::string text = fmt::format("{:<{}} {:>7} {:>7} {:>9} {:>8} {:>8}  {:<14} {:>5}", "scene", width, "Ga", "Re*", "theta_c",
                                 "lower", "upper", "status", "seeds");
  for (const PublishedCurve& published : curves_for_tables()) text += fmt::format(" {:>14}", published.name);
  text += '\n';
  for (const ThresholdPoint& p : curve) {
    text += fmt::format("{:<{}} {:>7.3g} {:>7.3g} {:>9} {:>8} {:>8}  {:<14} {:>5}", p.label, width, p.galileo, p.reynolds,
                        shields_or_bound(p), or_dash(p.lower, 4), or_dash(p.upper, 4), p.status, p.seeds);
    for (const PublishedCurve& published : curves_for_tables()) text += fmt::format(" {:>14.4f}", published.shields(p.galileo));
    text += '\n';
  }
  return text + fmt::format("laminar beds, measured: {} +- {} ({})\n", laminar_band.shields, laminar_band.half_width,
                            laminar_band.source);
}

std::string curve_as_csv(const std::vector<ThresholdPoint>& curve) {
  std::string text = "label,diameter_m,density_ratio,viscosity_m2_per_s,galileo,friction_reynolds,shields,shields_lower,"
                     "shields_upper,status,seeds,bracketed,censored_below,censored_above,noisy,parameter_set\n";
  for (const ThresholdPoint& p : curve)
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", p.label, p.diameter, p.density_ratio, p.viscosity,
                        or_empty(p.galileo), or_empty(p.reynolds), or_empty(p.shields), or_empty(p.lower), or_empty(p.upper),
                        p.status, p.seeds, p.bracketed, p.censored_below, p.censored_above, p.noisy, p.set);
  return text;
}

std::string curve_as_json(const std::vector<ThresholdPoint>& curve) {
  auto points = nlohmann::ordered_json::array();
  for (const ThresholdPoint& p : curve) {
    nlohmann::ordered_json published;
    for (const PublishedCurve& known : published_curves()) published[std::string(known.name)] = known.shields(p.galileo);
    points.push_back({{"label", p.label}, {"diameter_m", p.diameter}, {"density_ratio", p.density_ratio},
                      {"viscosity_m2_per_s", p.viscosity}, {"galileo", p.galileo}, {"friction_reynolds", p.reynolds},
                      {"shields", p.shields}, {"shields_lower", p.lower}, {"shields_upper", p.upper}, {"status", p.status},
                      {"seeds", p.seeds}, {"bracketed", p.bracketed}, {"censored_below", p.censored_below},
                      {"censored_above", p.censored_above}, {"noisy", p.noisy}, {"parameter_set", p.set}, {"published", published}});
  }
  return points.dump(2) + "\n";   // a number that is not known becomes null
}

}  // namespace bedload

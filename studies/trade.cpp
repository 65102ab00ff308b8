// Pairs of cases to differences, and differences to a frontier.
#include "studies/trade.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>

#include "base/error.hpp"
#include "solver/scene_numbers.hpp"
#include "studies/database_values.hpp"
#include "studies/plan.hpp"
#include "studies/results.hpp"
#include "studies/study_keys.hpp"
#include "studies/threshold_curve.hpp"

namespace bedload {

namespace {

/// A stair or a level of a ramp.
struct Stair {
  double level, flux, flux_error, height, porosity;   // [-], [-], [-], [d], [-]
};

/// What a finished case says.
struct Outcome {
  double shields, lower, upper;   // theta_c and its bracket [-]
  std::vector<Stair> stairs;
  double core_seconds;
  std::string bed_id;
};

std::optional<Outcome> outcome_of(const Database& database, const std::string& id) {
  const auto thresholds = database.query(
      "SELECT shields, shields_lower, shields_upper FROM thresholds WHERE decides = 1 AND case_id = ?", {id});
  if (thresholds.rows.empty()) return {};
  const auto& row = thresholds.rows.front();
  Outcome found{number_in(row[0]), number_in(row[1]), number_in(row[2]), {}, 0, {}};
  const auto stairs = database.query(
      "SELECT shields_nominal, event_flux, event_flux_error, bed_height_m / diameter_m, porosity FROM ramp_points "
      "JOIN scenes USING (case_id) WHERE purpose IN ('ramp', 'staircase') AND case_id = ? ORDER BY hold",
      {id});
  for (const auto& s : stairs.rows)
    found.stairs.push_back({number_in(s[0]), number_in(s[1]), number_in(s[2]), number_in(s[3]), number_in(s[4])});
  if (has_table(database, "attempts"))
    found.core_seconds = number_in(
        database.query("SELECT coalesce(sum(core_time_s), 0.0) FROM attempts WHERE case_id = ?", {id}).rows[0][0]);
  return found;
}

using Measure = std::function<std::optional<SingleDifference>(const Outcome& finest, const Outcome& other)>;

std::optional<SingleDifference> theta_difference(const Outcome& finest, const Outcome& other) {
  const auto found = log_ratio(finest.shields, finest.lower, finest.upper, other.shields, other.lower, other.upper);
  return std::isfinite(found.difference) ? std::optional(found) : std::nullopt;
}

std::optional<SingleDifference> flux_difference(const Outcome& finest, const Outcome& other) {
  for (std::size_t k = std::min(finest.stairs.size(), other.stairs.size()); k-- > 0;) {
    const Stair &a = finest.stairs[k], &b = other.stairs[k];
    if (a.level == b.level && a.flux + b.flux > 0)
      return symmetric_difference(a.flux, a.flux_error, b.flux, b.flux_error);
  }
  return {};
}

std::optional<SingleDifference> first_stair(const Outcome& finest, const Outcome& other, double Stair::*what) {
  if (finest.stairs.empty() || other.stairs.empty()) return {};
  return SingleDifference{other.stairs[0].*what - finest.stairs[0].*what, 0};
}

struct NamedMeasure {
  PairedDifference TradeSetting::*member;
  Measure of;
};

const std::vector<NamedMeasure>& measures() {
  static const std::vector<NamedMeasure> all{
      {&TradeSetting::theta, theta_difference},
      {&TradeSetting::flux, flux_difference},
      {&TradeSetting::height, [](const Outcome& a, const Outcome& b) { return first_stair(a, b, &Stair::height); }},
      {&TradeSetting::porosity,
       [](const Outcome& a, const Outcome& b) { return first_stair(a, b, &Stair::porosity); }}};
  return all;
}

/// The packings of a setting, by the case of the finest one that each is compared with.
using Packings = std::map<std::string, Outcome>;

/// One setting's differences to the finest, packing by packing.
Differences differences_of(const Packings& setting, const Packings& finest, const Measure& of) {
  Differences singles;
  for (const auto& [base, outcome] : setting)
    if (const auto found = finest.find(base); found != finest.end())
      if (const auto single = of(found->second, outcome)) singles.push_back({single->difference, single->error, base});
  return singles;
}

bool on_the_same_beds(const Packings& setting, const Packings& finest) {
  return std::ranges::all_of(setting, [&](const auto& one) {
    const auto found = finest.find(one.first);
    return found == finest.end() || found->second.bed_id == one.second.bed_id;
  });
}

/// The wider of two intervals around the same mean.
PairedDifference wider(const PairedDifference& a, const PairedDifference& b) {
  return a.known() && b.known() && a.high > b.high ? a : b;
}

/// A fall knows no packing: what scatters is where in a cell the grain falls.
PairedDifference fall_difference(const TradeSetting& setting, const TradeSetting& finest) {
  Differences places;
  for (std::size_t n = 0; n < finest.fall_speeds.size(); ++n)
    places.push_back({std::log(setting.fall_speeds[n] / finest.fall_speeds[n]), 0, std::to_string(n)});
  return relative(paired(places, scatter_of({places})));
}

/// How far packings scatter is taken from all settings that begin on the finest's beds; where a setting has beds of its own, from those that
/// have, but never as less: other beds scatter more.
void compare(const std::vector<Packings>& outcomes, std::vector<TradeSetting>& settings) {
  const Packings& finest = outcomes.front();
  for (const auto& [member, of] : measures()) {
    std::vector<Differences> all, same_beds, other_beds;
    for (std::size_t n = 1; n < settings.size(); ++n) {
      all.push_back(differences_of(outcomes[n], finest, of));
      (on_the_same_beds(outcomes[n], finest) ? same_beds : other_beds).push_back(all.back());
    }
    const Scatter same = scatter_of(same_beds), other = scatter_of(other_beds);
    for (std::size_t n = 1; n < settings.size(); ++n) {
      const auto by_same = paired(all[n - 1], same), by_other = paired(all[n - 1], other);
      settings[n].*member = on_the_same_beds(outcomes[n], finest) || !by_other.known() ? by_same
                            : by_same.known()                                          ? wider(by_same, by_other)
                                                                                       : by_other;
    }
  }
  for (TradeSetting& setting : settings)
    setting.theta = relative(setting.theta), setting.flux = relative_of_symmetric(setting.flux);
}

/// Among settings that have a theta_c in every packing: one that failed in some is good for nothing.
void mark_frontier(std::vector<TradeSetting>& settings) {
  const auto beats = [](const TradeSetting& a, const TradeSetting& b) {
    return a.core_seconds <= b.core_seconds && a.theta.worst() <= b.theta.worst() &&
           (a.core_seconds < b.core_seconds || a.theta.worst() < b.theta.worst());
  };
  const auto whole = [&](const TradeSetting& one) {
    return one.thresholds == settings.front().packings && std::isfinite(one.theta.worst());
  };
  for (TradeSetting& one : settings)
    one.frontier = whole(one) && std::ranges::none_of(settings, [&](const TradeSetting& other) {
                     return whole(other) && beats(other, one);
                   });
}

/// The value that a key has in the study itself.
Setting value_in(const Study& study, const std::string& key) {
  if (const auto found = study.settings.find(key); found != study.settings.end()) return found->second;
  if (const auto fallback = fallback_of(*find_key(key))) return *fallback;
  throw Error(ErrorKind::study_invalid, fmt::format("trade: {} is changed, and the study gives it no value", key),
              "give it in the study: the value of the finest setting");
}

std::string name_in_trade(const Case& one) { return one.base_id.empty() ? "finest" : one.variation; }

void add_case(const Database& database, const Case& one, Packings& packings, TradeSetting& setting) {
  auto outcome = outcome_of(database, one.id);
  if (!outcome) return;
  outcome->bed_id = one.bed_id;
  packings[one.base_id.empty() ? one.id : one.base_id] = *outcome;
  ++setting.packings, setting.thresholds += std::isfinite(outcome->shields);
  setting.core_seconds += outcome->core_seconds;
  setting.predicted_seconds += predicted_cost(one.scene).core_seconds;
}

}   // namespace

void refuse_without_trades(const Study& study) {
  if (study.trades.empty())
    throw Error(ErrorKind::study_invalid, fmt::format("{} has no [[trade]]", study.file.string()),
                "write [[trade]] and below it what is to be changed, for example box.cell.z = \"1 d\"");
}

Trade measured_trade(const Database& database, const Study& study, const std::vector<Case>& cases) {
  refuse_without_trades(study);
  Trade trade{.study = study.name, .settings = {{.name = "finest"}}};
  std::vector<Packings> outcomes(1);
  for (const Case& one : cases) {
    const std::string name = name_in_trade(one);
    auto known = std::ranges::find(trade.settings, name, &TradeSetting::name);
    if (known == trade.settings.end()) {
      trade.settings.push_back({.name = name, .changes = one.changes});
      outcomes.emplace_back();
      known = trade.settings.end() - 1;
    }
    add_case(database, one, outcomes[static_cast<std::size_t>(known - trade.settings.begin())], *known);
  }
  if (outcomes.front().empty())
    throw Error(ErrorKind::not_found, fmt::format("{}: no case of the finest setting has finished", study.name),
                "bedload trade runs what is left");
  for (TradeSetting& setting : trade.settings) {
    setting.core_seconds /= static_cast<double>(setting.packings),
        setting.predicted_seconds /= static_cast<double>(setting.packings);
    for (const auto& [key, value] : setting.changes) trade.finest[key] = value_in(study, key);
  }
  compare(outcomes, trade.settings);
  mark_frontier(trade.settings);
  for (const ThresholdPoint& point : threshold_curve(database)) {
    trade.galileo = point.galileo, trade.density_ratio = point.density_ratio, trade.diameter = point.diameter;
    trade.shields = std::isfinite(point.shields) ? point.shields
                    : std::isfinite(point.lower) ? point.lower
                                                 : point.upper;
  }
  trade.grain_time = numbers_of(cases.front().scene).grain_time;
  return trade;
}

void add_lone_falls(Trade& trade, const std::vector<Case>& cases) {
  for (TradeSetting& setting : trade.settings) {
    if (setting.packings == 0) continue;
    setting.fall_speeds = lone_fall_speeds(std::ranges::find(cases, setting.name, name_in_trade)->scene);
    setting.fall = fall_difference(setting, trade.settings.front());
  }
}

void store_trade(Database& database, const Trade& trade) {
  create_result_tables(database);
  Database::Transaction transaction(database);
  database.execute("DELETE FROM trades");
  for (const TradeSetting& one : trade.settings) {
    std::vector<Value> row{one.name, static_cast<std::int64_t>(one.packings), static_cast<std::int64_t>(one.thresholds),
                           real_or_null(one.core_seconds), std::int64_t{one.frontier}};
    std::string places = "?, ?, ?, ?, ?";
    for (const PairedDifference& d : {one.theta, one.flux, one.height, one.porosity, one.fall})
      for (const double number : {d.mean, d.low, d.high}) row.push_back(real_or_null(number)), places += ", ?";
    database.execute("INSERT INTO trades VALUES (" + places + ")", row);
  }
  transaction.commit();
}

}   // namespace bedload

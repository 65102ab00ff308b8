// A trade as a table, as JSON, as a figure.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "solver/state.hpp"
#include "studies/setting_text.hpp"
#include "studies/svg_plot.hpp"
#include "studies/trade.hpp"

namespace bedload {

namespace {

/// Two digits, or the whole part where it has more: "0.031", "3.1", "140".
std::string in_two_digits(double number) {
  return std::abs(number) < 99.5 ? fmt::format("{:.2g}", number) : fmt::format("{:.0f}", number);
}

std::string signed_in_two_digits(double number) { return (number < 0 ? "" : "+") + in_two_digits(number); }

/// "+3.1 %", or "< 4 %" where it is not seen; in brackets where it may be anything; "-" where it was not measured.
std::string difference_in_words(const PairedDifference& d, double unit, std::string_view sign) {
  if (!std::isfinite(d.mean)) return "-";
  const double scale = 1 / unit;
  if (d.mean == 0 && d.worst() == 0) return "0";
  if (!d.seen() && !std::isfinite(d.worst())) return fmt::format("({}{})", signed_in_two_digits(scale * d.mean), sign);
  return (d.seen() ? signed_in_two_digits(scale * d.mean) : "< " + in_two_digits(scale * d.worst())) += sign;
}

std::vector<const TradeSetting*> cheapest_first(const Trade& trade) {
  std::vector<const TradeSetting*> all;
  for (const TradeSetting& one : trade.settings) all.push_back(&one);
  std::ranges::stable_sort(all, {}, [](const TradeSetting* one) {
    return one->packings > 0 ? one->core_seconds : std::numeric_limits<double>::infinity();
  });
  return all;
}

nlohmann::ordered_json as_json(const PairedDifference& d) {
  return {{"difference", d.mean}, {"low", d.low}, {"high", d.high}, {"seen", d.seen()}};
}

double mean_of(const std::array<double, 4>& speeds) {
  return std::accumulate(speeds.begin(), speeds.end(), 0.0) / static_cast<double>(speeds.size());
}

nlohmann::ordered_json as_json(const Settings& settings) {
  auto json = nlohmann::ordered_json::object();
  for (const auto& [key, setting] : settings) json[key] = as_toml(setting);
  return json;
}

}   // namespace

std::vector<std::vector<std::string>> trade_cells(const Trade& trade) {
  std::vector<std::vector<std::string>> rows{
      {"setting", "packings", "core s", "cost", "theta_c", "flux", "height/d", "porosity"}};
  const TradeSetting& finest = trade.settings.front();
  const bool falls = std::isfinite(finest.fall_speeds[0]);
  if (falls) rows[0].push_back("fall");
  for (const TradeSetting* one : cheapest_first(trade)) {
    auto& row = rows.emplace_back(std::vector{(one->frontier ? "* " : "  ") + one->name});
    if (one->packings == 0) {
      row.push_back("no result");
      continue;
    }
    const auto words = [&](const PairedDifference& d, double unit, std::string_view sign) {
      return one == &finest ? "-" : difference_in_words(d, unit, sign);
    };
    row.insert(row.end(),
               {std::to_string(one->packings), in_two_digits(one->core_seconds),
                fmt::format("{:.0f}%", 100 * one->core_seconds / finest.core_seconds), words(one->theta, 0.01, "%"),
                words(one->flux, 0.01, "%"), words(one->height, 1, ""), words(one->porosity, 1, "")});
    if (falls) row.push_back(words(one->fall, 0.01, "%"));
  }
  return rows;
}

std::string trade_as_table(const Trade& trade) {
  auto rows = trade_cells(trade);
  rows[0][0] = "  " + rows[0][0];
  std::size_t width = 0;
  for (const auto& row : rows) width = std::max(width, row[0].size());
  std::string text;
  for (const auto& row : rows) {
    text += fmt::format("{:<{}}", row[0], width);
    for (std::size_t n = 1; n < row.size(); ++n) text += fmt::format(" {:>{}}", row[n], n == 2 ? 10 : n < 4 ? 8 : 9);
    text += "\n";
  }
  return text + fmt::format(
                    "differences to the finest setting, same beds, mean over the packings; < : not seen, may be as "
                    "much (95 %);\n"
                    "in brackets: how far it scatters is not known; fall: speed of a lone grain in the same box "
                    "without bed\n* no other setting is as cheap "
                    "and as good in theta_c. core s: of one packing\n"
                    "scene: Ga = {:.3g}, s = {:.3g}, theta_50 = {:.4f}\n",
                    trade.galileo, trade.density_ratio, trade.shields);
}

std::string trade_as_json(const Trade& trade) {
  auto settings = nlohmann::ordered_json::array();
  for (const TradeSetting& one : trade.settings)
    settings.push_back({{"name", one.name},
                        {"changes", as_json(one.changes)},
                        {"packings", one.packings},
                        {"thresholds", one.thresholds},
                        {"core_seconds", one.core_seconds},
                        {"predicted_seconds", one.predicted_seconds},
                        {"frontier", one.frontier},
                        {"lone_fall_m_per_s", mean_of(one.fall_speeds)},
                        {"theta", as_json(one.theta)},
                        {"flux", as_json(one.flux)},
                        {"height_d", as_json(one.height)},
                        {"porosity", as_json(one.porosity)},
                        {"lone_fall", as_json(one.fall)}});
  const nlohmann::ordered_json json = {{"format", trade_format},
                                       {"physics_version", physics_version},
                                       {"study", trade.study},
                                       {"scene",
                                        {{"galileo", trade.galileo},
                                         {"density_ratio", trade.density_ratio},
                                         {"shields", trade.shields},
                                         {"diameter_m", trade.diameter},
                                         {"grain_time_s", trade.grain_time}}},
                                       {"finest", as_json(trade.finest)},
                                       {"settings", settings}};
  return json.dump(2) + "\n";
}

namespace {

std::vector<const TradeSetting*> measured_cheapest_first(const Trade& trade) {
  std::vector<const TradeSetting*> all = cheapest_first(trade);
  std::erase_if(all, [](const auto* one) {
    return one->packings == 0 || !(one->theta.seen() || std::isfinite(one->theta.worst()));
  });
  return all;
}

double highest_bar(const std::vector<const TradeSetting*>& settings) {
  double highest = 0.02;
  for (const TradeSetting* one : settings)
    if (std::isfinite(one->theta.worst())) highest = std::max(highest, one->theta.worst());
  return highest;
}

/// Where the number of a point without a bar stands: above it, or, where the one before stands near, below; at the foot of the picture higher.
class NumberPlaces {
 public:
  /// Places and answer as shares of the axes.
  double above(double x, double y) {
    const bool near = x - last_x_ < 0.035 && std::abs(y - last_y_) < 0.08;
    up_ = !(near && up_), last_x_ = x, last_y_ = y;
    return up_ ? 0.02 : y > 0.05 ? -0.045 : 0.065;
  }

 private:
  double last_x_ = -1, last_y_ = -1;
  bool up_ = false;
};

}   // namespace

/// Settings are numbered by their cost: names beside the points would lie on each other.
std::string trade_figure(const Trade& trade) {
  const auto settings = measured_cheapest_first(trade);
  if (settings.empty()) return {};
  const double low = settings.front()->core_seconds / 1.5, high = settings.back()->core_seconds * 1.5,
               top = 110 * highest_bar(settings);
  SvgPlot plot(900, std::max(440.0, 150 + 18.0 * static_cast<double>(settings.size())),
               {"core seconds of one packing", low, high, true},
               {"error of θc against the finest setting  [%]", 0, top, false}, 260);
  plot.legend_heading("settings, cheapest first");
  NumberPlaces places;
  for (std::size_t n = 0; n < settings.size(); ++n) {
    const TradeSetting& one = *settings[n];
    const bool finest = &one == &trade.settings.front(), filled = finest || one.theta.seen();
    const std::string_view colour = one.frontier ? "var(--blue)" : "var(--frame)";
    const std::string difference = finest ? "" : difference_in_words(one.theta, 0.01, "%"),
                      number = std::to_string(n + 1);
    const double cost = one.core_seconds,
                 error = 100 * (one.theta.seen() ? std::abs(one.theta.mean) : one.theta.worst());
    if (one.theta.seen())
      plot.vertical_bar(cost, 100 * std::min(std::abs(one.theta.low), std::abs(one.theta.high)),
                        100 * one.theta.worst(), colour);
    plot.marker({cost, error}, Marker::circle, colour, filled,
                fmt::format("{} {}: {} at {:.3g} core s", number, one.name, difference, cost));
    const double up = places.above(std::log(cost / low) / std::log(high / low), error / top);
    if (filled) plot.note({cost * std::pow(high / low, 0.013), error + 0.02 * top}, number, colour);
    else plot.note({cost, error + up * top}, number, colour, "middle");
    plot.legend_marker(fmt::format("{} {} {}", number, one.name, difference), Marker::circle, colour, filled);
  }
  plot.legend_heading("blue: on the frontier");
  plot.legend_heading("open: a bound, not seen");
  return plot.svg();
}

}   // namespace bedload

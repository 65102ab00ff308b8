// The threshold curve as text: for people, as CSV, as JSON.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "studies/published_curves.hpp"
#include "studies/threshold_curve.hpp"

namespace bedload {

namespace {

/// theta_50, or the bound beyond which it lies.
std::string shields_or_bound(const ThresholdPoint& p) {
  if (std::isfinite(p.shields)) return fmt::format("{:.4f}", p.shields);
  if (p.status == "censored_below" && std::isfinite(p.upper)) return fmt::format("< {:.4f}", p.upper);
  if (std::isfinite(p.lower)) return fmt::format("> {:.4f}", p.lower);
  return "-";
}

std::string or_dash(double number, int digits) {
  return std::isfinite(number) ? fmt::format("{:.{}f}", number, digits) : "-";
}

/// Of an error of either sign.
std::string percent_or_dash(double part) { return std::isfinite(part) ? fmt::format("+-{:.2g}%", 100 * part) : "-"; }

std::string as_csv(const std::string& word) { return word; }
std::string as_csv(std::uint64_t number) { return fmt::format("{}", number); }
std::string as_csv(double number) { return std::isfinite(number) ? fmt::format("{}", number) : ""; }

/// [lower, upper] each; an end that is open becomes null.
nlohmann::ordered_json as_json(const OverSeeds& of) {
  const auto bounds = [](ShieldsBounds b) {
    return nlohmann::ordered_json{b.lower > 0 ? b.lower : std::numeric_limits<double>::quiet_NaN(), b.upper};
  };
  return {{"median", bounds(of.median)},
          {"least", bounds(of.least)},
          {"greatest", bounds(of.greatest)},
          {"seeds", of.seeds}};
}

nlohmann::ordered_json motion_as_json(const MotionMeasures& motion) {
  nlohmann::ordered_json json{{"first_grain", as_json(motion.first_grain)},
                              {"moved_1_percent", as_json(motion.one_percent)},
                              {"moved_10_percent", as_json(motion.ten_percent)},
                              {"reference_transport", as_json(motion.reference_transport)}};
  if (const auto& law = motion.flux_law)
    json["flux_law"] = {
        {"exponent", law->exponent}, {"threshold", as_json(law->threshold)}, {"threshold_error", law->threshold_error}};
  return json;
}

std::size_t widest_label(const std::vector<ThresholdPoint>& curve) {
  std::size_t width = 5;
  for (const ThresholdPoint& p : curve) width = std::max(width, p.label.size());
  return width;
}

/// Of a number over the curve: "0.5", "0.5 to 1"; rounded as cells are that fill a box in whole numbers.
std::string range_of(const std::vector<ThresholdPoint>& curve, double ThresholdPoint::*member) {
  const auto [low, high] = std::ranges::minmax(curve, {}, member);
  const auto from = fmt::format("{:.2g}", low.*member), to = fmt::format("{:.2g}", high.*member);
  return from == to ? from : fmt::format("{} to {}", from, to);
}

/// What people may ask about the columns.
std::string remarks(const std::vector<ThresholdPoint>& curve) {
  const auto any = [&](auto&& is) { return std::ranges::any_of(curve, is); };
  std::string text;
  if (any([](const ThresholdPoint& p) { return !std::isfinite(p.lower); }))
    text +=
        "lower -: a seed whose first hold moves already, or stirs; a ramp or staircase that begins lower finds the "
        "bound\n";
  if (any([](const ThresholdPoint& p) { return !std::isfinite(p.upper); }))
    text +=
        "upper -: a seed whose ramp or staircase ends before its bed moves for good; a higher end finds the bound\n";
  if (any([](const ThresholdPoint& p) { return p.noisy > 0; }))
    text +=
        "noisy: a hold moved and the next one did not; lower lies before that first stir. Longer holds, or a larger "
        "bed\n";
  return text;
}

}   // namespace

std::string interval_in_words(const ThresholdPoint& p) {
  if (!std::isfinite(p.interval_lower) && !std::isfinite(p.interval_upper)) return "-";
  const auto confidence = p.confidence < 0.95 ? fmt::format(" {:.3g}%", 100 * p.confidence) : std::string();
  if (!std::isfinite(p.interval_upper)) return fmt::format("> {:.4f}", p.interval_lower) + confidence;
  if (!std::isfinite(p.interval_lower)) return fmt::format("< {:.4f}", p.interval_upper) + confidence;
  return fmt::format("{:.4f}-{:.4f}", p.interval_lower, p.interval_upper) + confidence;
}

std::string onset_in_words(const std::vector<ThresholdPoint>& curve) {
  const auto& first = curve.front();
  return fmt::format("onset: {} >= {:g} per surface grain{}, {}; cells {} d high",
                     first.criterion == "flux" ? "flux" : "moving fraction", first.criterion_value,
                     first.criterion == "flux" ? " and td" : "",
                     first.method == "ramp" ? "by a ramp (screening)" : "by bisection from the settled bed",
                     range_of(curve, &ThresholdPoint::cell_z));
}

std::string curve_as_table(const std::vector<ThresholdPoint>& curve, const std::vector<BudgetEntry>& budget) {
  const std::size_t width = widest_label(curve);
  std::string text =
      fmt::format("{:<{}} {:>7} {:>7} {:>9} {:>18} {:>8} {:>8} {:>8} {:>7}  {:<14} {:>5}", "scene", width, "Ga", "Re*",
                  "theta_50", "95 % interval", "lower", "upper", "stop", "syst.", "status", "seeds");
  for (const PublishedCurve& published : curves_for_tables()) text += fmt::format(" {:>14}", published.name);
  text += '\n';
  for (const ThresholdPoint& p : curve) {
    text += fmt::format("{:<{}} {:>7.3g} {:>7.3g} {:>9} {:>18} {:>8} {:>8} {:>8} {:>7}  {:<14} {:>5}", p.label, width,
                        p.galileo, p.reynolds, shields_or_bound(p), interval_in_words(p), or_dash(p.lower, 4),
                        or_dash(p.upper, 4), or_dash(p.stop, 4), percent_or_dash(p.systematic), p.status, p.seeds);
    for (const PublishedCurve& published : curves_for_tables())
      text += fmt::format(" {:>14.4f}", published.shields(p.galileo));
    text += '\n';
  }
  if (!curve.empty())
    text += onset_in_words(curve) + "\nsystematic: " + budget_in_words(budget) + "\n" + remarks(curve);
  return text + fmt::format("laminar beds, measured: {} +- {} ({})\n", laminar_band.shields, laminar_band.half_width,
                            laminar_band.source);
}

std::string curve_as_csv(const std::vector<ThresholdPoint>& curve) {
  const ThresholdPoint any;
  std::string text, separator;
  const auto cell = [&](const std::string& words) { text += separator + words, separator = ","; };
  ThresholdPoint::each(any, [&](std::string_view name, const auto&) { cell(std::string(name)); });
  for (const ThresholdPoint& p : curve) {
    text += '\n', separator.clear();
    ThresholdPoint::each(p, [&](std::string_view, const auto& member) { cell(as_csv(member)); });
  }
  return text + "\n";
}

std::string curve_as_json(const std::vector<ThresholdPoint>& curve, const std::vector<MotionMeasures>& motion) {
  auto points = nlohmann::ordered_json::array();
  for (const ThresholdPoint& p : curve) {
    nlohmann::ordered_json point;
    ThresholdPoint::each(p, [&](std::string_view name, const auto& member) { point[std::string(name)] = member; });
    for (const PublishedCurve& known : published_curves())
      point["published"][std::string(known.name)] = known.shields(p.galileo);
    if (const auto of = std::ranges::find(motion, p.set, &MotionMeasures::set); of != motion.end())
      point["motion"] = motion_as_json(*of);
    points.push_back(std::move(point));
  }
  return points.dump(2) + "\n";   // a number that is not known becomes null
}

}   // namespace bedload

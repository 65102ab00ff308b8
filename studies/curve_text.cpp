// The threshold curve as text: for people, as CSV, as JSON.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "studies/published_curves.hpp"
#include "studies/threshold_curve.hpp"

namespace bedload {

namespace {

/// theta_c, or the bound beyond which it lies.
std::string shields_or_bound(const ThresholdPoint& p) {
  if (std::isfinite(p.shields)) return fmt::format("{:.4f}", p.shields);
  if (p.status == "censored_below" && std::isfinite(p.upper)) return fmt::format("< {:.4f}", p.upper);
  if (std::isfinite(p.lower)) return fmt::format("> {:.4f}", p.lower);
  return "-";
}

std::string or_dash(double number, int digits) {
  return std::isfinite(number) ? fmt::format("{:.{}f}", number, digits) : "-";
}

std::string or_empty(double number) { return std::isfinite(number) ? fmt::format("{}", number) : ""; }

std::size_t widest_label(const std::vector<ThresholdPoint>& curve) {
  std::size_t width = 5;
  for (const ThresholdPoint& p : curve) width = std::max(width, p.label.size());
  return width;
}

}   // namespace

std::string curve_as_table(const std::vector<ThresholdPoint>& curve) {
  const std::size_t width = widest_label(curve);
  std::string text = fmt::format("{:<{}} {:>7} {:>7} {:>9} {:>8} {:>8}  {:<14} {:>5}", "scene", width, "Ga", "Re*",
                                 "theta_c", "lower", "upper", "status", "seeds");
  for (const PublishedCurve& published : curves_for_tables()) text += fmt::format(" {:>14}", published.name);
  text += '\n';
  for (const ThresholdPoint& p : curve) {
    text += fmt::format("{:<{}} {:>7.3g} {:>7.3g} {:>9} {:>8} {:>8}  {:<14} {:>5}", p.label, width, p.galileo,
                        p.reynolds, shields_or_bound(p), or_dash(p.lower, 4), or_dash(p.upper, 4), p.status, p.seeds);
    for (const PublishedCurve& published : curves_for_tables())
      text += fmt::format(" {:>14.4f}", published.shields(p.galileo));
    text += '\n';
  }
  return text + fmt::format("laminar beds, measured: {} +- {} ({})\n", laminar_band.shields, laminar_band.half_width,
                            laminar_band.source);
}

std::string curve_as_csv(const std::vector<ThresholdPoint>& curve) {
  std::string text =
      "label,diameter_m,density_ratio,viscosity_m2_per_s,galileo,friction_reynolds,shields,shields_lower,"
      "shields_upper,status,seeds,bracketed,censored_below,censored_above,noisy,parameter_set\n";
  for (const ThresholdPoint& p : curve)
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", p.label, p.diameter, p.density_ratio,
                        p.viscosity, or_empty(p.galileo), or_empty(p.reynolds), or_empty(p.shields), or_empty(p.lower),
                        or_empty(p.upper), p.status, p.seeds, p.bracketed, p.censored_below, p.censored_above, p.noisy,
                        p.set);
  return text;
}

std::string curve_as_json(const std::vector<ThresholdPoint>& curve) {
  auto points = nlohmann::ordered_json::array();
  for (const ThresholdPoint& p : curve) {
    nlohmann::ordered_json published;
    for (const PublishedCurve& known : published_curves())
      published[std::string(known.name)] = known.shields(p.galileo);
    points.push_back({{"label", p.label},
                      {"diameter_m", p.diameter},
                      {"density_ratio", p.density_ratio},
                      {"viscosity_m2_per_s", p.viscosity},
                      {"galileo", p.galileo},
                      {"friction_reynolds", p.reynolds},
                      {"shields", p.shields},
                      {"shields_lower", p.lower},
                      {"shields_upper", p.upper},
                      {"status", p.status},
                      {"seeds", p.seeds},
                      {"bracketed", p.bracketed},
                      {"censored_below", p.censored_below},
                      {"censored_above", p.censored_above},
                      {"noisy", p.noisy},
                      {"parameter_set", p.set},
                      {"published", published}});
  }
  return points.dump(2) + "\n";   // a number that is not known becomes null
}

}   // namespace bedload

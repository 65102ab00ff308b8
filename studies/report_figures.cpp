// Queries to plots.
#include "studies/report_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/counted.hpp"
#include "solver/dimensionless.hpp"
#include "studies/database_values.hpp"
#include "studies/published_curves.hpp"
#include "studies/svg_plot.hpp"

namespace bedload {

namespace {

constexpr std::array<std::string_view, 6> palette{"var(--blue)",   "var(--red)",   "var(--green)",
                                                  "var(--purple)", "var(--ochre)", "var(--text)"};
constexpr std::array<Marker, 4> shapes{Marker::circle, Marker::square, Marker::triangle, Marker::diamond};
constexpr std::array<Stroke, 6> published_strokes{{{"var(--known)", 1.8, ""},
                                                   {"var(--known)", 1.6, "7 3"},
                                                   {"var(--known)", 1.6, "2 3"},
                                                   {"var(--known-pale)", 1.8, ""},
                                                   {"var(--known-pale)", 1.6, "7 3"},
                                                   {"var(--known-pale)", 1.6, "2 3"}}};
constexpr std::string_view ours = "var(--blue)", other = "var(--red)", still = "var(--still)", band = "var(--band)";
constexpr double small_width = 472, small_height = 300;

/// Place of a value among the distinct values, in rising order; the palettes repeat after their last.
std::size_t rank_among(const std::vector<double>& distinct, double value) {
  return static_cast<std::size_t>(std::find(distinct.begin(), distinct.end(), value) - distinct.begin());
}

/// In rising order.
std::vector<double> distinct(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

std::vector<double> distinct_values(const std::vector<ThresholdPoint>& curve, double ThresholdPoint::*member) {
  std::vector<double> values;
  for (const ThresholdPoint& p : curve) values.push_back(p.*member);
  return distinct(values);
}

std::string scene_in_words(double diameter, double density_ratio) {
  return fmt::format("d = {:.4g} mm, s = {:.4g}", diameter * 1e3, density_ratio);
}

void draw_published(SvgPlot& plot, double low, double high) {
  plot.legend_heading("turbulent flow, published");
  for (std::size_t n = 0; n < published_curves().size(); ++n) {
    const PublishedCurve& known = published_curves()[n];
    std::vector<PlotPoint> points;
    for (double ga = low; ga < high; ga *= 1.08) {
      const double shields = known.shields(ga);
      points.push_back({friction_reynolds_number(shields, ga), shields});
    }
    plot.line(points, published_strokes[n % published_strokes.size()]);
    plot.legend_line(known.name, published_strokes[n % published_strokes.size()]);
  }
}

std::string bounds_of(const ThresholdPoint& p) {
  const bool from = std::isfinite(p.lower), to = std::isfinite(p.upper);
  if (from && to) return fmt::format(", between {:.4f} and {:.4f}", p.lower, p.upper);
  return to ? fmt::format(", below {:.4f}", p.upper) : from ? fmt::format(", above {:.4f}", p.lower) : "";
}

struct Bar {
  double low, high;   // nan: open
};

/// The 95 % interval where there is one, else from the lowest bound of any seed to the highest.
Bar bar_of(const ThresholdPoint& p) {
  const bool fitted = p.confidence >= 0.95 && std::isfinite(p.interval_lower) && std::isfinite(p.interval_upper);
  return fitted ? Bar{p.interval_lower, p.interval_upper} : Bar{p.lower, p.upper};
}

void draw_point(SvgPlot& plot, const ThresholdPoint& p, Marker shape, std::string_view colour) {
  const auto about = [&](std::string_view value) {
    return fmt::format("{}: theta_c {} at Re* = {:.3g}, {} ({}{})", p.label, value, p.reynolds, p.status,
                       counted(p.seeds, "seed"), is_screening(p) ? ", screening" : "");
  };
  if (std::isfinite(p.shields)) {
    const auto [from, to] = bar_of(p);
    const bool known_below = std::isfinite(from), known_above = std::isfinite(to);
    if (known_below || known_above)
      plot.vertical_bar(p.reynolds, known_below ? from : p.shields, known_above ? to : p.shields, colour);
    if (known_below != known_above) plot.vertical_arrow(p.reynolds, p.shields, known_below, colour);
    if (p.systematic > 0)
      plot.thin_bar(p.reynolds, p.shields * std::max(0.0, 1 - p.systematic), p.shields * (1 + p.systematic), colour);
    plot.marker({p.reynolds, p.shields}, shape, colour, true,
                about(fmt::format("= {:.4f}{}", p.shields, bounds_of(p))));
    return;
  }
  const bool above = std::isfinite(p.lower);
  const double bound = above ? p.lower : p.upper;
  plot.vertical_arrow(p.reynolds, bound, above, colour);
  plot.marker({p.reynolds, bound}, shape, colour, false, about(fmt::format("{} {:.4f}", above ? ">" : "<", bound)));
}

}   // namespace

bool is_screening(const ThresholdPoint& p) { return p.method == "ramp"; }

std::string threshold_figure(const std::vector<ThresholdPoint>& curve) {
  SvgPlot plot(940, 520, {"Re* = u* d/ν  [–]", 0.1, 1000, true}, {"Shields number at onset θc  [–]", 0.01, 1, true},
               210);
  plot.shade({0.1, laminar_band.shields - laminar_band.half_width}, {5, laminar_band.shields + laminar_band.half_width},
             band, 0.25);
  const auto diameters = distinct_values(curve, &ThresholdPoint::diameter);
  const auto densities = distinct_values(curve, &ThresholdPoint::density_ratio);
  const auto colour_of = [&](double d) { return palette[rank_among(diameters, d) % palette.size()]; };
  const auto shape_of = [&](double s) { return shapes[rank_among(densities, s) % shapes.size()]; };
  for (const bool screening : {false, true}) {
    const auto has = [&](auto&& more) {
      return std::ranges::any_of(curve,
                                 [&](const ThresholdPoint& p) { return is_screening(p) == screening && more(p); });
    };
    if (!has([](const ThresholdPoint&) { return true; })) continue;
    plot.legend_heading(screening ? "this study: ramp (screening)" : "this study: bisection");
    for (const double d : diameters)
      for (const double s : densities)
        if (has([&](const ThresholdPoint& p) { return p.diameter == d && p.density_ratio == s; }))
          plot.legend_marker(scene_in_words(d, s), shape_of(s), colour_of(d), true);
  }
  plot.legend_heading("laminar beds, measured");
  plot.legend_shade(fmt::format("{} ± {}", laminar_band.shields, laminar_band.half_width), band, 0.35);
  draw_published(plot, 0.1, 2e4);
  for (const ThresholdPoint& p : curve) draw_point(plot, p, shape_of(p.density_ratio), colour_of(p.diameter));
  return plot.svg();
}

bool of_one_grain(const std::vector<ThresholdPoint>& curve) {
  const auto one = [&](double ThresholdPoint::*member) { return distinct_values(curve, member).size() == 1; };
  return curve.size() > 1 && one(&ThresholdPoint::diameter) && one(&ThresholdPoint::density_ratio) &&
         one(&ThresholdPoint::viscosity);
}

namespace {

/// From the lowest bar to the highest, on an axis of logarithms.
PlotAxis axis_of_shields(const std::vector<ThresholdPoint>& curve) {
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (const ThresholdPoint& p : curve)
    for (const double at : {p.shields, p.lower, p.upper, p.stop})
      if (at > 0) low = std::fmin(low, at), high = std::fmax(high, at);
  return {"Shields number at onset θc  [–]", low / 1.3, high * 1.3, true};
}

void draw_row(SvgPlot& plot, const ThresholdPoint& p, double row) {
  const bool found = std::isfinite(p.shields);
  const Bar bar = bar_of(p);
  const double from = std::isfinite(bar.low) ? bar.low : p.shields, to = std::isfinite(bar.high) ? bar.high : p.shields;
  if (found) plot.line({{from, row}, {to, row}}, {ours, 1.6});
  if (p.stop > 0)
    plot.marker({p.stop, row}, Marker::square, other, false, fmt::format("{}: theta_stop = {:.4f}", p.label, p.stop));
  const bool above = std::isfinite(p.lower);
  const double at = found ? p.shields : above ? p.lower : p.upper;
  plot.marker({at, row}, Marker::circle, ours, found,
              fmt::format("{}: theta_c {} {:.4f}{}", p.label,
                          found   ? "="
                          : above ? ">"
                                  : "<",
                          at, bounds_of(p)));
  if (!found) plot.note({at, row}, above ? "   →" : "←   ", ours, above ? "start" : "end");
}

}   // namespace

std::string side_by_side_figure(const std::vector<ThresholdPoint>& curve) {
  PlotAxis rows{.label = "", .low = 0, .high = static_cast<double>(curve.size())};
  for (const ThresholdPoint& p : curve) rows.rows.push_back(p.label);
  SvgPlot plot(940, 90 + 26.0 * rows.high, axis_of_shields(curve), rows, 210);
  for (std::size_t n = 0; n < curve.size(); ++n) draw_row(plot, curve[n], rows.high - static_cast<double>(n) - 0.5);
  plot.legend_marker(std::ranges::any_of(curve, is_screening) ? "θc, screening" : "θc", Marker::circle, ours, true);
  plot.legend_marker("a bound", Marker::circle, ours, false);
  plot.legend_marker("θ stop", Marker::square, other, false);
  return plot.svg();
}

std::vector<FinishedCase> finished_cases(const Database& database) {
  std::vector<FinishedCase> cases;
  if (!has_table(database, "scenes")) return cases;
  const Rows found =
      database.query(fmt::format("SELECT case_id, label, diameter_m FROM scenes WHERE {} ORDER BY diameter_m, "
                                 "density_ratio, viscosity_m2_per_s, parameter_set, seed",
                                 in_study(database)));
  for (const auto& row : found.rows) cases.push_back({text_in(row[0]), text_in(row[1]), number_in(row[2])});
  return cases;
}

namespace {

struct Onsets {
  double value = 1e-2, shields = NAN, lower = NAN, upper = NAN;
  std::string activity = "event_flux";
};

Onsets onset_of(const Database& database, const std::string& id) {
  const Rows found = database.query(
      "SELECT value, shields, shields_lower, shields_upper, criterion FROM thresholds WHERE case_id = ? AND decides = "
      "1",
      {id});
  if (found.rows.empty()) return {};
  const auto& row = found.rows[0];
  return {number_in(row[0]), number_in(row[1]), number_in(row[2]), number_in(row[3]),
          text_in(row[4]) == "flux" ? "event_flux" : "moving_fraction"};
}

Marker marker_of(const std::string& purpose) {
  if (purpose == "staircase") return Marker::square;
  if (purpose == "stir") return Marker::diamond;
  return purpose == "stop" ? Marker::triangle : Marker::circle;
}

}   // namespace

std::string flux_figure(const Database& database, const FinishedCase& of) {
  const Onsets onset = onset_of(database, of.id);
  const Rows holds = database.query(
      "SELECT shields, event_flux, event_flux_error, moving_fraction, purpose FROM ramp_points WHERE case_id = ? "
      "ORDER BY hold",
      {of.id});
  if (holds.rows.empty()) return {};
  double low = 1e9, high = 0;
  for (const auto& row : holds.rows) low = std::min(low, number_in(row[0])), high = std::max(high, number_in(row[0]));
  if (!(low > 0)) return {};
  constexpr double least = 1e-4, most = 10;   // what is still stands on the lower edge
  SvgPlot plot(small_width, small_height, {"measured Shields number θ  [–]", low / 1.12, high * 1.12, true},
               {"event flux  [–]", least, most, true});
  if (std::isfinite(onset.lower) && std::isfinite(onset.upper))
    plot.shade({onset.lower, least}, {onset.upper, most}, ours, 0.12);
  if (std::isfinite(onset.shields)) {
    plot.line({{onset.shields, least}, {onset.shields, most}}, {ours, 1.4, ""});
    plot.note({onset.shields, most * 0.5}, fmt::format(" θc = {:.3f}", onset.shields), ours,
              onset.shields > std::sqrt(low * high) * 1.2 ? "end" : "start");
  }
  const bool by_flux = onset.activity == "event_flux";
  if (by_flux) plot.line({{low / 1.12, onset.value}, {high * 1.12, onset.value}}, {"var(--dash)", 1.2, "5 4"});
  for (const auto& row : holds.rows) {
    const double shields = number_in(row[0]), flux = number_in(row[1]), error = number_in(row[2]);
    if (flux > least) plot.vertical_bar(shields, std::max(least, flux - error), flux + error, ours);
    const bool moves = flux >= onset.value;
    const std::string purpose = text_in(row[4]);
    plot.marker({shields, std::max(flux, least)}, marker_of(purpose), flux > 0 ? ours : still, moves,
                fmt::format("{}, theta = {:.4f}: flux {:.3g} ± {:.2g}, moving fraction {:.3g}", purpose, shields, flux,
                            error, number_in(row[3])));
  }
  return plot.svg();
}

namespace {

struct Profile {
  std::vector<PlotPoint> porosity, fluid, grains;   // value over z/d
};

Profile profile_of(const Database& database, const FinishedCase& of, std::int64_t hold) {
  Profile profile;
  const Rows found = database.query(
      "SELECT z_m, porosity, fluid_velocity_m_per_s, grain_velocity_m_per_s FROM bed_statistics WHERE case_id = ? AND "
      "hold = ? ORDER BY z_m",
      {of.id, hold});
  for (const auto& row : found.rows) {
    const double z = number_in(row[0]) / of.diameter, porosity = number_in(row[1]);
    profile.porosity.push_back({porosity, z});
    profile.fluid.push_back({number_in(row[2]), z});
    if (porosity < 1) profile.grains.push_back({number_in(row[3]), z});
  }
  return profile;
}

std::int64_t last_hold(const Database& database, const FinishedCase& of) {
  const Rows found = database.query("SELECT max(hold) FROM bed_statistics WHERE case_id = ?", {of.id});
  return found.rows.empty() || std::holds_alternative<std::monostate>(found.rows[0][0])
             ? -1
             : std::get<std::int64_t>(found.rows[0][0]);
}

/// For people holds count from 1; -1 in the database is the settled bed.
std::string hold_in_words(std::int64_t hold) { return hold < 0 ? "settling" : fmt::format("hold {}", hold + 1); }

double top_of(const Profile& profile) { return profile.porosity.empty() ? 1 : profile.porosity.back().y; }

}   // namespace

std::string porosity_figure(const Database& database, const FinishedCase& of) {
  const std::int64_t last = last_hold(database, of);
  const Profile before = profile_of(database, of, -1), after = profile_of(database, of, last);
  if (after.porosity.empty()) return {};
  SvgPlot plot(small_width, small_height, {"porosity  [–]", 0.2, 1.02},
               {"height z/d  [–]", 0, std::ceil(top_of(after))});
  if (!before.porosity.empty()) plot.line(before.porosity, {still, 1.8, ""});
  plot.line(after.porosity, {ours, 1.8, ""});
  plot.note({0.24, 0.93 * top_of(after)}, "settled", "var(--still)");
  plot.note({0.24, 0.86 * top_of(after)}, fmt::format("after {}", hold_in_words(last)), ours);
  return plot.svg();
}

std::string velocity_figure(const Database& database, const FinishedCase& of) {
  const std::int64_t last = last_hold(database, of);
  const Profile after = profile_of(database, of, last);
  if (after.fluid.empty()) return {};
  double fastest = 1e-12;
  for (const PlotPoint p : after.fluid) fastest = std::max(fastest, p.x);
  SvgPlot plot(small_width, small_height, {"streamwise velocity  [m/s]", 0, 1.06 * fastest},
               {"height z/d  [–]", 0, std::ceil(top_of(after))});
  plot.line(after.fluid, {ours, 1.8, ""});
  plot.line(after.grains, {other, 1.8, ""});
  plot.note({0.5 * fastest, 0.17 * top_of(after)}, fmt::format("fluid, {}", hold_in_words(last)), ours);
  plot.note({0.5 * fastest, 0.10 * top_of(after)}, "grains", other);
  return plot.svg();
}

namespace {

/// A quantity of table samples over time, the holds behind it; empty where nothing was sampled.
std::string figure_in_time(const Database& database, const FinishedCase& of, const std::vector<PlotPoint>& points,
                           const PlotAxis& axis) {
  const Rows holds = database.query("SELECT start_s, end_s FROM ramp_points WHERE case_id = ? ORDER BY hold", {of.id});
  if (points.empty() || holds.rows.empty()) return {};
  SvgPlot plot(small_width, small_height, {"time since the first hold began  [s]", 0, number_in(holds.rows.back()[1])},
               axis);
  for (std::size_t k = 1; k < holds.rows.size(); k += 2)
    plot.shade({number_in(holds.rows[k][0]), axis.low}, {number_in(holds.rows[k][1]), axis.high}, "var(--known)", 0.12);
  plot.line(points, {ours, 1.4, ""});
  return plot.svg();
}

std::vector<PlotPoint> samples_of(const Database& database, const FinishedCase& of, std::string_view column) {
  std::vector<PlotPoint> points;
  const Rows found =
      database.query(fmt::format("SELECT time_s, {} FROM samples WHERE case_id = ? ORDER BY time_s", column), {of.id});
  for (const auto& row : found.rows) points.push_back({number_in(row[0]), number_in(row[1])});
  return points;
}

}   // namespace

std::string history_figure(const Database& database, const FinishedCase& of) {
  constexpr double least = 1e-3, most = 3;
  auto points = samples_of(database, of, "moving_fraction");
  for (PlotPoint& p : points) p.y = std::max(least / 2, p.y);
  return figure_in_time(database, of, points, {"moving grains per surface grain  [–]", least, most, true});
}

std::string height_figure(const Database& database, const FinishedCase& of) {
  auto points = samples_of(database, of, "bed_height_m");
  if (points.empty()) return {};
  for (PlotPoint& p : points) p.y /= of.diameter;
  const auto [low, high] = std::ranges::minmax(points, {}, &PlotPoint::y);
  constexpr double margin = 0.05;   // [d]: a bed that rests is a line in the middle
  return figure_in_time(database, of, points, {"bed height z_b/d  [–]", low.y - margin, high.y + margin});
}

std::string transport_figure(const Database& database) {
  if (!has_table(database, "transport_curve")) return {};
  const Rows found = database.query(fmt::format(
      "SELECT diameter_m, density_ratio, shields, transport, transport_error, label FROM transport_curve WHERE "
      "transport > 0 AND shields > 0 AND {} AND case_id NOT IN (SELECT case_id FROM variations)",
      in_study(database)));
  if (found.rows.empty()) return {};
  std::vector<double> diameters, densities, shields, transport;
  for (const auto& row : found.rows) {
    diameters.push_back(number_in(row[0])), densities.push_back(number_in(row[1]));
    shields.push_back(number_in(row[2])), transport.push_back(number_in(row[3]));
  }
  const auto distinct_diameters = distinct(diameters), distinct_densities = distinct(densities);
  const auto [low, high] = std::ranges::minmax(shields);
  const auto [least, most] = std::ranges::minmax(transport);
  SvgPlot plot(940, 400, {"measured Shields number θ  [–]", low / 1.12, high * 1.12, true},
               {"transport q*  [–]", least / 2, most * 2, true}, 210);
  plot.legend_heading("this study");
  for (const double d : distinct_diameters)
    for (const double s : distinct_densities)
      if (std::ranges::any_of(found.rows,
                              [&](const auto& row) { return number_in(row[0]) == d && number_in(row[1]) == s; }))
        plot.legend_marker(scene_in_words(d, s), shapes[rank_among(distinct_densities, s) % shapes.size()],
                           palette[rank_among(distinct_diameters, d) % palette.size()], true);
  for (std::size_t n = 0; n < found.rows.size(); ++n) {
    const auto colour = palette[rank_among(distinct_diameters, diameters[n]) % palette.size()];
    const double error = number_in(found.rows[n][4]);
    plot.vertical_bar(shields[n], std::max(least / 2, transport[n] - error), transport[n] + error, colour);
    plot.marker({shields[n], transport[n]}, shapes[rank_among(distinct_densities, densities[n]) % shapes.size()],
                colour, true,
                fmt::format("{}: q* = {:.3g} ± {:.2g} at theta = {:.4f}", text_in(found.rows[n][5]), transport[n],
                            error, shields[n]));
  }
  return plot.svg();
}

namespace {

/// A hold with the curve fitted to the grains that move in it.
struct DecayingHold {
  std::int64_t hold;
  std::string purpose;
  double start, shields;                // [s], [-]
  double time, error, first, last;      // of last + (first - last) exp(-t/time)
  std::vector<PlotPoint> moving = {};   // grains over the time since `start`
};

/// The first ones, those of a bed that is being stopped last: there a stir dies, and not the bed's own motion.
std::vector<DecayingHold> decaying_holds(const Database& database, const FinishedCase& of, std::size_t most) {
  const Rows found = database.query(
      "SELECT d.hold, r.purpose, r.start_s, r.shields, d.decay_time_s, d.decay_time_error_s, d.first, d.last "
      "FROM motion_decay d JOIN ramp_points r USING (case_id, hold) WHERE d.case_id = ? "
      "ORDER BY r.purpose = 'stop', d.hold LIMIT ?",
      {of.id, static_cast<std::int64_t>(most)});
  std::vector<DecayingHold> holds;
  for (const auto& row : found.rows) {
    DecayingHold& hold = holds.emplace_back(DecayingHold{std::get<std::int64_t>(row[0]), text_in(row[1]),
                                                         number_in(row[2]), number_in(row[3]), number_in(row[4]),
                                                         number_in(row[5]), number_in(row[6]), number_in(row[7])});
    const Rows samples = database.query(
        "SELECT time_s, moving_fraction * surface_grains FROM samples JOIN scenes USING (case_id) WHERE case_id = ? "
        "AND hold = ? ORDER BY time_s",
        {of.id, hold.hold});
    for (const auto& sample : samples.rows)
      hold.moving.push_back({number_in(sample[0]) - hold.start, number_in(sample[1])});
  }
  return holds;
}

constexpr double fewest_moving = 0.3;   // lower end of the figure's axis; samples are means over their interval

std::vector<PlotPoint> fitted_curve(const DecayingHold& hold) {
  constexpr int points = 100;
  std::vector<PlotPoint> curve;
  for (int n = 0; n <= points; ++n) {
    const double t = hold.moving.back().x * n / points;
    const double moving = hold.last + (hold.first - hold.last) * std::exp(-t / hold.time);
    curve.push_back({t, std::max(moving, fewest_moving / 2)});
  }
  return curve;
}

}   // namespace

std::string decay_figure(const Database& database, const FinishedCase& of) {
  constexpr std::size_t most = 4;
  auto holds = decaying_holds(database, of, most);
  double end = 0, highest = 1;
  for (DecayingHold& hold : holds)
    for (PlotPoint& p : hold.moving) {
      end = std::max(end, p.x), highest = std::max(highest, p.y);
      p.y = std::max(p.y, fewest_moving / 2);
    }
  if (!(end > 0)) return {};
  SvgPlot plot(740, small_height, {"time since the hold began  [s]", 0, end},
               {"moving grains  [–]", fewest_moving, 1.3 * highest, true}, 268);
  for (std::size_t n = 0; n < holds.size(); ++n) {
    const DecayingHold& hold = holds[n];
    const auto colour = palette[n % palette.size()];
    plot.line(hold.moving, {colour, 1, ""});
    plot.line(fitted_curve(hold), {colour, 2, "7 4"});
    plot.legend_line(fmt::format("{} ({}), θ = {:.3g}", hold_in_words(hold.hold), hold.purpose, hold.shields),
                     {colour, 1, ""});
    plot.legend_line(fmt::format("T = {:.2g} ± {:.1g} s", hold.time, hold.error), {colour, 2, "7 4"});
  }
  return plot.svg();
}

}   // namespace bedload

// The page: sections of figures and tables, and the style they share.
#include "studies/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/counted.hpp"
#include "studies/attempt_figure.hpp"
#include "studies/bed_picture.hpp"
#include "studies/case_warnings.hpp"
#include "studies/database_values.hpp"
#include "studies/html_table.hpp"
#include "studies/published_curves.hpp"
#include "studies/report_figures.hpp"
#include "studies/report_style.hpp"
#include "studies/results.hpp"
#include "studies/svg_plot.hpp"
#include "studies/theme.hpp"

namespace bedload {

namespace {

std::string section(std::string_view title, std::string_view caption, std::string_view body) {
  if (body.empty()) return {};
  return fmt::format("<section><h2>{}</h2>\n<p class='caption'>{}</p>\n{}</section>\n", title, caption, body);
}

std::string status_tag(const std::string& status) {
  std::string words = status;
  std::replace(words.begin(), words.end(), '_', ' ');
  return fmt::format("<td><span class='tag {}'>{}</span></td>", status == "bracketed" ? "good" : "open",
                     escaped(words));
}

std::string curve_table(const std::vector<ThresholdPoint>& curve) {
  std::string rows = header_row({"scene", "d [mm]", "s [–]", "ν [mm²/s]", "Ga [–]", "Re* [–]", "θ50 [–]", "interval",
                                 "lower", "upper", "stop", "Soulsby", "seeds", "status"},
                                1, 12);
  for (const ThresholdPoint& p : curve)
    rows += "<tr>" + text_cell(p.label) + number_cell(p.diameter * 1e3) + number_cell(p.density_ratio) +
            number_cell(p.viscosity * 1e6) + number_cell(p.galileo, "{:.3g}") + number_cell(p.reynolds, "{:.3g}") +
            number_cell(p.shields, "{:.4f}") + number_cell(interval_in_words(p)) + number_cell(p.lower, "{:.4f}") +
            number_cell(p.upper, "{:.4f}") + number_cell(p.stop, "{:.4f}") +
            number_cell(published_curves()[0].shields(p.galileo), "{:.3f}") + number_cell(fmt::format("{}", p.seeds)) +
            status_tag(p.status) + "</tr>\n";
  return html_table(rows);
}

std::string threshold_section(const std::vector<ThresholdPoint>& curve, const std::vector<BudgetEntry>& budget,
                              const std::string& unsteady, std::size_t finished) {
  const auto none = finished == 0 ? "<p>No case has finished yet.</p>" : "<p>No finished case seeks an onset.</p>";
  const std::string body =
      curve.empty()
          ? scrolling(threshold_figure(curve)) + none
          : scrolling(threshold_figure(curve)) + (of_one_grain(curve) ? scrolling(side_by_side_figure(curve)) : "") +
                curve_table(curve) + "<p class='caption'>" +
                escaped(onset_in_words(curve) + "; systematic: " + budget_in_words(budget)) + "</p>\n" +
                (unsteady.empty() ? "" : "<p class='caption'>" + escaped(unsteady) + "</p>\n");
  return section(
      std::ranges::any_of(curve, is_screening) ? "Threshold of motion: screening by ramps" : "Threshold of motion",
      "θ = τ<sub>b</sub>/((ρ<sub>p</sub> − ρ<sub>f</sub>) g d) above which half of all packings begin to move, by a "
      "fit to "
      "the brackets of the seeds. Bars: its 95 % interval where there are six seeds or more, else from the lowest "
      "to the highest bound of any seed; the thin pale bar around it, with wider caps, is the systematic error that "
      "pairs "
      "of runs of one packing measured (bracket, hold, mesh, area), and missing where there are no pairs. A ramp is "
      "screening: it says where to look. Open markers with an arrow are one-sided bounds; an arrow at a filled one: a "
      "seed knows no bound on that side. The published "
      "curves are fits to turbulent flow; "
      "a laminar model that knows drag alone is expected near the laminar band or above it, not on them.",
      body);
}

std::string trade_section(const std::optional<Trade>& trade) {
  if (!trade) return {};
  auto rows = trade_cells(*trade);
  std::string html = header_row(rows.front(), 1, rows.front().size() - 1);
  for (std::size_t n = 1; n < rows.size(); ++n) {
    html += "<tr>" + text_cell(rows[n][0]);
    for (std::size_t k = 1; k < rows[n].size(); ++k) html += number_cell(rows[n][k]);
    html += "</tr>\n";
  }
  return section("Trade of speed against accuracy",
                 "Differences to the finest setting, of the same packings from the same settled beds, mean over the "
                 "packings. &lt;: not seen, but may be as much (95 %); in brackets: how far it scatters is not known. "
                 "Starred and blue: no other setting is as cheap and as good in θc. core s: of one packing. How a "
                 "lone grain falls is in what <code>bedload trade</code> prints.",
                 scrolling(trade_figure(*trade)) + html_table(html));
}

/// `figure` of every case, titled with its label; cases without one are left out. On paper two stand side by side unless they
/// are `wide`.
template <class Figure>
std::string for_each_case(const std::vector<FinishedCase>& cases, Figure&& figure, bool wide = false) {
  std::string all;
  for (const FinishedCase& of : cases) {
    const std::string drawn = figure(of);
    if (!drawn.empty())
      all +=
          fmt::format("<div{}><h3>{}</h3>{}</div>\n", wide ? " class='wide'" : "", escaped(of.label), scrolling(drawn));
  }
  return all.empty() ? all : "<div class='row'>" + all + "</div>\n";
}

std::string flux_section(const Database& database, const std::vector<FinishedCase>& cases) {
  return section(
      "Flux of every hold",
      "Events are passages of half a diameter downstream, counted per surface grain and grain time: one "
      "point per hold, over its last half; bars are standard errors. Filled: at or above the onset "
      "criterion (dashed); grey: no event was counted. Circles: holds of a ramp, which is screening, or from "
      "the settled bed of a bisection; squares: its staircase; diamonds: a stir; triangles: towards rest. "
      "The shaded strip is the bracket of the threshold.",
      for_each_case(cases, [&](const FinishedCase& of) { return flux_figure(database, of); }));
}

/// The median, and below it the range of the seeds.
std::string stacked_cell(const std::string& words) {
  const auto range = words.find(" (");
  if (range == words.npos) return number_cell(words);
  return fmt::format("<td class='n'>{}<br>{}</td>", escaped(words.substr(0, range)), escaped(words.substr(range + 1)));
}

std::string motion_table(const std::vector<MotionMeasures>& all) {
  if (all.empty()) return {};
  std::string rows = header_row({"scene", "first grain", "1 % moved", "10 % moved", "W* = 0.002", "n", "θ0"}, 1, 6);
  for (const MotionMeasures& m : all)
    rows += "<tr>" + text_cell(m.label) + stacked_cell(in_words(m.first_grain)) +
            stacked_cell(in_words(m.one_percent)) + stacked_cell(in_words(m.ten_percent)) +
            stacked_cell(in_words(m.reference_transport)) +
            number_cell(m.flux_law ? m.flux_law->exponent : NAN, "{:g}") +
            stacked_cell(m.flux_law ? in_words(*m.flux_law) : "–") + "</tr>\n";
  return html_table(rows);
}

std::string motion_section(const Database& database, const std::vector<FinishedCase>& cases) {
  return section(
      "Movers, flux law and the decay of motion",
      "Shields numbers at which the first grain, 1 % and 10 % of the surface grains had gone half a diameter "
      "within a hold, and at the reference transport W* = q*/θ<sup>1.5</sup> = 0.002; q* = k (θ − θ0)<sup>n</sup> "
      "over the holds that move. Medians over the seeds, in brackets the lowest and highest; &lt; and &gt; where "
      "a seed knows a bound alone. Figures: moving grains since a hold began (thin) and last + (first − last) "
      "exp(−t/T) fitted to them (dashed), for the first holds whose motion decays.",
      motion_table(motion_measures(database)) +
          for_each_case(
              cases, [&](const FinishedCase& of) { return decay_figure(database, of); }, true));
}

std::string history_section(const Database& database, const std::vector<FinishedCase>& cases) {
  return section(
      "Motion and height in time",
      "Grains faster than 0.01 √((s − 1) g d), per surface grain, and the height of the bed in diameters. Every "
      "other hold is shaded.",
      for_each_case(cases, [&](const FinishedCase& of) {
        const std::string motion = history_figure(database, of), height = height_figure(database, of);
        return motion.empty() ? motion : "<div class='row'>" + scrolling(motion) + scrolling(height) + "</div>";
      }));
}

std::string transport_section(const Database& database) {
  const std::string figure = transport_figure(database);
  return section(
      "Transport",
      "q* = q/√((s − 1) g d<sup>3</sup>) over the measured Shields number: every hold of every packing in which "
      "anything was transported, with its standard error.",
      figure.empty() ? figure : scrolling(figure));
}

std::string bed_section(const std::vector<CaseViews>& beds) {
  if (beds.empty()) return {};
  std::string body = scrolling(speed_scale_bar());
  for (const CaseViews& of : beds) {
    std::string pictures;
    for (const BedView& bed : of.views)
      pictures +=
          fmt::format("<div><p class='moment'>{}</p>{}</div>\n", escaped(bed.moment), scrolling(bed_picture(bed, 468)));
    body += fmt::format("<h3>{}</h3>\n<div class='row'>{}</div>\n", escaped(of.label), pictures);
  }
  return section(
      "The bed",
      "Side view of the bed at rest, before its first hold, and at onset: at the end of the first hold of a ramp "
      "that moved it, or of the weakest flow of a bisection that did (where none has yet: in its newest "
      "checkpoint). The grains of the front five diameters, farther ones through haze, coloured by speed.",
      body);
}

std::string profile_section(const Database& database, const std::vector<FinishedCase>& cases) {
  return section("Profiles",
                 "Means over x and y: porosity of the settled bed and after the last hold; velocity of fluid and "
                 "grains in the last hold.",
                 for_each_case(cases, [&](const FinishedCase& of) {
                   const std::string porosity = porosity_figure(database, of), velocity = velocity_figure(database, of);
                   return porosity.empty() && velocity.empty()
                              ? std::string()
                              : "<div class='row'>" + scrolling(porosity) + scrolling(velocity) + "</div>";
                 }));
}

/// What the cases of the study were told, each text once.
std::string warning_table(const Database& database) {
  if (!has_table(database, "warnings") || !has_table(database, "cases")) return {};
  const Rows found = database.query(
      "SELECT label, text FROM warnings w JOIN cases c USING (case_id) WHERE in_study ORDER BY c.position, w.position");
  if (found.rows.empty()) return {};
  std::vector<CaseWarning> all;
  for (const auto& row : found.rows) all.push_back({text_in(row[0]), text_in(row[1])});
  std::string rows = header_row({"cases", "warning"}, 99, 0);
  for (const auto& warning : shared_warnings(all))
    rows += "<tr>" + text_cell(cases_in_words(warning)) + text_cell(warning.text) + "</tr>\n";
  return "<h3>Range and missing terms</h3>" + html_table(rows);
}

/// One row per term and decision; a term that cases decide differently has several.
std::string model_section(const Database& database) {
  if (!has_table(database, "models")) return {};
  const Rows found = database.query(
      fmt::format("SELECT term, is_on, is_wanted, min(ratio), max(ratio), min(reason), count(*) FROM models WHERE {} "
                  "GROUP BY term, is_on, is_wanted ORDER BY min(position), is_on DESC",
                  in_study(database)));
  if (found.rows.empty()) return {};
  std::string rows = header_row({"term", "", "deciding number", "cases", "reason (of one of the cases)"}, 2, 3);
  for (const auto& row : found.rows) {
    const bool on = number_in(row[1]) != 0, wanted = number_in(row[2]) != 0;
    const double low = number_in(row[3]), high = number_in(row[4]);
    std::string term = text_in(row[0]);
    std::replace(term.begin(), term.end(), '_', ' ');
    rows += "<tr>" + text_cell(term) +
            fmt::format("<td><span class='tag {}'>{}</span></td>",
                        on       ? "good"
                        : wanted ? "open"
                                 : "",
                        on       ? "on"
                        : wanted ? "off, wanted"
                                 : "off") +
            number_cell(!std::isfinite(low) ? "–"
                        : low == high       ? fmt::format("{:.3g}", low)
                                            : fmt::format("{:.3g} … {:.3g}", low, high)) +
            number_cell(number_in(row[6]), "{:.0f}") + text_cell(text_in(row[5])) + "</tr>\n";
  }
  return section("Models and why",
                 "Which terms the scenes require, the number that decided, and what leaving a term out costs.",
                 html_table(rows) + warning_table(database));
}

std::string health_section(const Database& database) {
  if (!has_table(database, "attempts")) return {};
  const Rows found =
      database.query("SELECT cause, count(*), sum(core_time_s) FROM attempts GROUP BY cause ORDER BY cause");
  if (found.rows.empty()) return {};
  std::string rows = header_row({"attempts that ended by", "count", "core hours"}, 1, 2);
  for (const auto& row : found.rows) {
    std::string cause = text_in(row[0]);
    std::replace(cause.begin(), cause.end(), '_', ' ');
    rows += "<tr>" + text_cell(cause) + number_cell(number_in(row[1]), "{:.0f}") +
            number_cell(number_in(row[2]) / 3600, "{:.3g}") + "</tr>\n";
  }
  const std::string line = attempt_figure(database);
  return section(
      "Run health",
      "Every attempt at every case and bed, by the cause of its end. Work after the last checkpoint of an attempt "
      "is done again by the next. The time line has one row per bed and case, one bar per attempt.",
      html_table(rows) + (line.empty() ? line : scrolling(line)));
}

std::string provenance_section(const Database& database, const ReportRequest& request) {
  std::string body = "<pre>" + escaped(request.command) + "</pre>\n";
  if (has_table(database, "provenance")) {
    const Rows builds = database.query(fmt::format(
        "SELECT version, physics_version, compiler, flags, libraries, host, count(*) FROM provenance WHERE {} "
        "GROUP BY 1, 2, 3, 4, 5, 6 ORDER BY 1, 2, 3, 4, 5, 6",
        in_study(database)));
    std::string rows = header_row({"version", "physics", "compiler", "flags", "libraries", "host", "cases"}, 99, 0);
    for (const auto& row : builds.rows) {
      rows += "<tr>";
      for (std::size_t n = 0; n < row.size(); ++n)
        rows += n == 1 || n == 6 ? text_cell(fmt::format("{:.0f}", number_in(row[n]))) : text_cell(text_in(row[n]));
      rows += "</tr>\n";
    }
    if (!builds.rows.empty()) body += html_table(rows);
    const Rows digests =
        database.query(fmt::format("SELECT label, p.seed, case_id, state_digest FROM provenance p JOIN scenes USING "
                                   "(case_id) WHERE {} ORDER BY label",
                                   in_study(database)));
    std::string states = header_row({"case", "seed", "id", "SHA-256 of the final state"}, 99, 0);
    for (const auto& row : digests.rows)
      states += "<tr>" + text_cell(text_in(row[0])) + text_cell(fmt::format("{:.0f}", number_in(row[1]))) +
                "<td><code>" + escaped(text_in(row[2]).substr(0, 12)) + "</code></td><td><code>" +
                escaped(text_in(row[3])) + "</code></td></tr>\n";
    if (!digests.rows.empty()) body += "<h3>Final states</h3>" + html_table(states);
  }
  return section(
      "Provenance",
      "The same study gives the same bits. This command reproduces every number, <code>bedload report</code> draws the "
      "page again; the tables behind the figures are <code>threshold_curve</code>, <code>ramp_points</code>, "
      "<code>thresholds</code>, <code>flux_laws</code>, <code>motion_decay</code>, <code>samples</code> and "
      "<code>bed_statistics</code>.",
      body);
}

std::string summary(const std::vector<ThresholdPoint>& curve, std::size_t cases) {
  if (cases == 0) return "no results yet";
  const auto finished = counted(cases, "finished case");
  if (curve.empty()) return finished + ", no onset sought";
  double low = NAN, high = NAN;
  for (const ThresholdPoint& p : curve) low = std::fmin(low, p.shields), high = std::fmax(high, p.shields);
  const auto from = fmt::format("{:.3f}", low), to = fmt::format("{:.3f}", high);
  const auto range = !std::isfinite(low) ? std::string()
                     : from == to        ? ", θc = " + from
                                         : fmt::format(", θc from {} to {}", from, to);
  return fmt::format("{}, {}{}", counted(curve.size(), "parameter set"), finished, range);
}

}   // namespace

std::string report_html(const Database& database, const ReportRequest& request) {
  const std::vector<ThresholdPoint> curve = threshold_curve(database);
  const std::vector<FinishedCase> cases = finished_cases(database);
  const std::string title = escaped(request.study);
  return fmt::format(
             "<!doctype html>\n<html lang='en'><head><meta charset='utf-8'><meta name='viewport' "
             "content='width=device-width'>"
             "<title>{0} – "
             "bedload</title><style>{1}{5}</style></head>\n<body><main>\n<header><h1>{0}</h1><p>{2}{3}{4}</p></"
             "header>\n",
             title, theme_style(), summary(curve, cases.size()), request.written.empty() ? "" : " · ",
             escaped(request.written), report_style) +
         threshold_section(curve, error_budget(database), unsteady_holds(database), cases.size()) +
         trade_section(request.trade) + transport_section(database) + flux_section(database, cases) +
         motion_section(database, cases) + bed_section(request.beds) + history_section(database, cases) +
         profile_section(database, cases) + model_section(database) + health_section(database) +
         provenance_section(database, request) + "</main></body></html>\n";
}

}   // namespace bedload

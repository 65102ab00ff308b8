// Onset: what it takes to move a grain out of its place, and a bed.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "solver/bed/incipient_motion.hpp"
#include "studies/published_curves.hpp"
#include "studies/svg_plot.hpp"
#include "studies/validation.hpp"

namespace bedload {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
const char* beads(double to_saddle) { return to_saddle < 0.5 ? "three" : "four"; }
double degrees(double radians) { return radians * 180 / std::numbers::pi; }

/// Push per submerged weight at which grain 0 went past `x`: between the level under which it did and the one before,
/// which is as near as a staircase tells.
double push_at_departure(const FinishedCase& run, double x) {
  const Trajectory path = trajectory_of(run, 0);
  const auto passed = std::ranges::find_if(path.position, [&](Vec3 p) { return p.x > x; });
  if (passed == path.position.end()) return nan;
  const double time = path.time[static_cast<std::size_t>(passed - path.position.begin())];
  const auto& holds = run.state.record.holds;
  const auto hold = static_cast<std::size_t>(std::ranges::lower_bound(holds.end, time) - holds.end.begin());
  const auto& levels = run.one.scene.drive.levels;
  return hold == 0 || hold >= levels.size() ? nan : 0.5 * (levels[hold] + levels[hold - 1]);
}

std::string departure_figure(const std::vector<FinishedCase>& runs, const std::vector<ValidationRow>& rows,
                             double to_saddle, double height) {
  const auto exact = [&](double slope) { return to_saddle / height * std::cos(slope) - std::sin(slope); };
  SvgPlot plot(640, 300, {"tilt of the bed along the push [deg]", -15, 15}, {"push over submerged weight", 0, 1}, 190);
  std::vector<PlotPoint> curve;
  for (int b = -15; b <= 15; ++b) curve.push_back({double(b), exact(b * std::numbers::pi / 180)});
  plot.line(curve, {"#333", 1.5, ""});
  for (std::size_t n = 0; n < rows.size(); ++n) {
    const bool rolls = runs[n].input("grains.friction") > 0;
    plot.marker({degrees(runs[n].input("box.slope")), rows[n].ours}, rolls ? Marker::square : Marker::circle, "#0b6e99",
                !rolls, fmt::format("{:.4g}", rows[n].ours));
  }
  plot.legend_line("tan a cos b - sin b", {"#333", 1.5, ""});
  plot.legend_marker("bead slides", Marker::circle, "#0b6e99", true);
  plot.legend_marker("bead rolls", Marker::square, "#0b6e99", false);
  return plot.svg();
}

/// Where grain 0 leaves its pocket: at the saddle between two of the beads below, half of the way to the next pocket.
/// `to_saddle` and `height`: from the centres of these beads, per diameter.
Findings departures(const std::vector<FinishedCase>& runs, double to_saddle, double height) {
  Findings found;
  for (const auto& run : runs) {
    const double slope = run.input("box.slope"),
                 saddle = trajectory_of(run, 0).position.front().x + to_saddle * run.input("grains.diameter");
    const bool rolls = run.input("grains.friction") > 0;
    found.rows.push_back({.name = fmt::format("push at departure, pocket of {}, tilted by {:.0f} deg, bead {} [W']",
                                              beads(to_saddle), degrees(slope), rolls ? "rolls" : "slides"),
                          .reference = to_saddle / height * std::cos(slope) - std::sin(slope),
                          .source = "statics: tan a cos b - sin b",
                          .ours = push_at_departure(run, saddle),
                          .band = Band::within(0.01)});
  }
  found.figures.push_back(
      {fmt::format("onset-pocket-of-{}", beads(to_saddle)),
       fmt::format("The push at which a bead leaves a pocket of {}, over the tilt of the bed.", beads(to_saddle)),
       departure_figure(runs, found.rows, to_saddle, height)});
  return found;
}

/// Up to which slope grain 0 stays: between the last slope on which it did and the first on which it did not, the slopes of
/// the study rising. NaN unless both occur, in this order.
double tilt_at_departure(const std::vector<FinishedCase>& runs, double to_saddle) {
  double stays = nan, leaves = nan;
  for (const auto& run : runs) {
    const Trajectory path = trajectory_of(run, 0);
    const bool left = path.position.back().x > path.position.front().x + to_saddle * run.input("grains.diameter");
    const double slope = run.input("box.slope");
    if (left && std::isnan(leaves)) leaves = slope;
    if (!left) stays = slope;
  }
  return stays < leaves ? 0.5 * (stays + leaves) : nan;
}

Findings tilt(const std::vector<FinishedCase>& runs, double to_saddle, double height) {
  return {.rows = {{.name = fmt::format("tilt at departure, pocket of {} [deg]", beads(to_saddle)),
                    .reference = degrees(std::atan(to_saddle / height)),
                    .source = "statics: the pocket's angle a",
                    .ours = degrees(tilt_at_departure(runs, to_saddle)),
                    .band = Band::within(0.01)}},
          .figures = {}};
}

// ---- A bed

/// Threshold of each packing, as a study finds it: where the flux passes the study's value between a hold that rests and one
/// that moves, and whose next does too. NaN without both.
Findings laminar_beds(const std::vector<FinishedCase>& runs) {
  Findings found;
  for (const auto& run : runs) {
    const Onset& onset = run.one.scene.onset;
    found.rows.push_back(
        {.name = fmt::format("critical Shields number of a random bed, packing {} [-]", run.one.scene.bed.source.seed),
         .reference = laminar_band.shields,
         .source = std::string(laminar_band.source),
         .ours = incipient_motion(run.state.record, onset.criterion, onset.value).shields,
         .band = Band::within_absolute(laminar_band.half_width),
         .against = Against::experiment});
  }
  return found;
}

bool level_or_down_and_smooth(const Case& one) {
  return one.inputs.number("box.slope") >= 0 && one.inputs.number("grains.friction") == 0;
}

}   // namespace

std::vector<Rung> onset_rungs() {
  using std::sqrt;
  return {
      {"onset-pocket-triangular",
       "a bead in the pocket of three beads is pushed towards the saddle between two of them",
       [](const auto& runs) { return departures(runs, sqrt(1.0 / 12), sqrt(2.0 / 3)); }, level_or_down_and_smooth},
      {"onset-pocket-quadratic", "a bead in the pocket of four beads is pushed towards the saddle between two of them",
       [](const auto& runs) { return departures(runs, 0.5, sqrt(0.5)); }, level_or_down_and_smooth},
      {"onset-tilt-triangular",
       "a pocket of three beads is tilted towards the saddle between two of them",
       [](const auto& runs) { return tilt(runs, sqrt(1.0 / 12), sqrt(2.0 / 3)); },
       {}},
      {"onset-tilt-quadratic",
       "a pocket of four beads is tilted towards the saddle between two of them",
       [](const auto& runs) { return tilt(runs, 0.5, sqrt(0.5)); },
       {}},
      {"onset-laminar-bed", "a lid shears a viscous liquid over a settled bed, more and more", laminar_beds, {}},
  };
}

}   // namespace bedload

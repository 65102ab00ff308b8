// Onset: what it takes to move a grain out of its place.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "studies/validation.hpp"

namespace bedload {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
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

/// Where grain 0 leaves its pocket: at the saddle between two of the beads below, half of the way to the next pocket.
/// `to_saddle` and `height`: from the centres of these beads, per diameter.
Findings departures(const std::vector<FinishedCase>& runs, double to_saddle, double height) {
  Findings found;
  for (const auto& run : runs) {
    const double slope = run.input("box.slope"),
                 saddle = trajectory_of(run, 0).position.front().x + to_saddle * run.input("grains.diameter");
    const bool rolls = run.input("grains.friction") > 0;
    found.rows.push_back({.name = fmt::format("push at departure, bed tilted by {:.0f} deg, bead {} [W']",
                                              degrees(slope), rolls ? "rolls" : "slides"),
                          .reference = to_saddle / height * std::cos(slope) - std::sin(slope),
                          .source = "statics: tan a cos b - sin b",
                          .ours = push_at_departure(run, saddle),
                          .band = Band::within(0.01)});
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
  };
}

}   // namespace bedload

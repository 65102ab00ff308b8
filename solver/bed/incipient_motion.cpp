// The onset rule: first hold above the criterion, confirmed by the next.
#include "solver/bed/incipient_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "solver/bed/onset_search.hpp"

namespace bedload {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Of the criterion over the finished holds.
struct Crossings {
  std::optional<std::size_t> first;       // hold at or above the value
  std::optional<std::size_t> confirmed;   // the first of them whose next is at or above it too
};

Crossings crossings(const std::vector<double>& activity, double value) {
  Crossings found;
  for (std::size_t k = 0; k < activity.size(); ++k) {
    if (activity[k] < value) continue;
    if (!found.first) found.first = k;
    if (k + 1 < activity.size() && activity[k + 1] >= value) {
      found.confirmed = k;
      break;
    }
  }
  return found;
}

const std::vector<double>& activity_of(const BedRecord& record, Onset::Criterion criterion) {
  return criterion == Onset::Criterion::flux ? record.holds.flux : record.holds.moving_fraction;
}

/// Shields number at which log(activity) passes log(value) on the line between two holds. No event at all says only
/// "below what the hold could count", so that a still hold stands at a hundredth of the value.
double log_linear_crossing(double still_shields, double still, double moving_shields, double moving, double value) {
  const double from = std::log(std::max(still, 0.01 * value)), to = std::log(moving);
  return still_shields + (moving_shields - still_shields) * (std::log(value) - from) / (to - from);
}

}   // namespace

std::string_view name_of(OnsetStatus status) {
  switch (status) {
    case OnsetStatus::none: return "none";
    case OnsetStatus::bracketed: return "bracketed";
    case OnsetStatus::censored_below: return "censored_below";
    case OnsetStatus::censored_above: return "censored_above";
    case OnsetStatus::noisy: return "noisy";
  }
  return "none";
}

IncipientMotion incipient_motion(const BedRecord& record, Onset::Criterion criterion, double value) {
  const std::vector<double>& activity = activity_of(record, criterion);
  const std::vector<double>& shields = record.holds.shields_measured;
  if (activity.empty()) return {OnsetStatus::none, unknown, unknown, unknown};
  const auto [first, confirmed] = crossings(activity, value);
  if (!first) return {OnsetStatus::censored_above, unknown, shields.back(), unknown};

  const double lower = *first > 0 ? shields[*first - 1] : unknown;
  if (!confirmed) {   // what stirs last is not confirmed; what stirs and rests again is noise
    const bool on_last = *first + 1 == activity.size();
    return {on_last ? OnsetStatus::censored_above : OnsetStatus::noisy, unknown, lower, unknown};
  }
  const std::size_t k = *confirmed;
  if (k == 0) return {OnsetStatus::censored_below, unknown, unknown, shields[0]};
  const double onset = log_linear_crossing(shields[k - 1], activity[k - 1], shields[k], activity[k], value);
  return {k == *first ? OnsetStatus::bracketed : OnsetStatus::noisy, onset, lower, shields[k]};
}

IncipientMotion lowest_reached(std::span<const double> shields, std::span<const double> motion, double value) {
  constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  if (shields.empty()) return {OnsetStatus::none, unknown, unknown, unknown};
  std::size_t upper = none, lower = none;
  for (std::size_t k = 0; k < shields.size(); ++k)
    if (motion[k] >= value && (upper == none || shields[k] < shields[upper])) upper = k;
  for (std::size_t k = 0; k < shields.size(); ++k)
    if (motion[k] < value && (upper == none || shields[k] < shields[upper]) &&
        (lower == none || shields[k] > shields[lower]))
      lower = k;
  if (upper == none) return {OnsetStatus::censored_above, unknown, shields[lower], unknown};
  if (lower == none) return {OnsetStatus::censored_below, unknown, unknown, shields[upper]};
  const double between = log_linear_crossing(shields[lower], motion[lower], shields[upper], motion[upper], value);
  return {OnsetStatus::bracketed, between, shields[lower], shields[upper]};
}

namespace {

/// Measured in the last hold of a purpose at a level [-].
double measured_at(const BedRecord::Holds& holds, HoldPurpose purpose, double level) {
  for (std::size_t k = holds.hold.size(); k-- > 0;)
    if (holds.purpose[k] == static_cast<double>(purpose) && holds.level[k] == level) return holds.shields_measured[k];
  return unknown;
}

OnsetStatus status_of(LevelBracket levels, const IncipientMotion& found) {
  if (!std::isfinite(levels.upper)) return OnsetStatus::censored_above;
  if (levels.lower == 0) return OnsetStatus::censored_below;
  return found.lower < found.upper ? OnsetStatus::bracketed : OnsetStatus::noisy;
}

}   // namespace

SearchedMotion searched_motion(const BedRecord& record) {
  const BedRecord::Holds& holds = record.holds;
  if (holds.hold.empty()) return {{OnsetStatus::none, unknown, unknown, unknown}, unknown, unknown};
  const auto done = judged_holds(holds);
  const LevelBracket begins = bracket_of(done, HoldPurpose::onset), stops = bracket_of(done, HoldPurpose::stop);
  SearchedMotion found;
  IncipientMotion& onset = found.onset;
  onset.lower = measured_at(holds, HoldPurpose::onset, begins.lower);
  onset.upper = measured_at(holds, HoldPurpose::onset, begins.upper);
  if (std::isnan(onset.lower) && std::isnan(onset.upper))
    onset.lower = holds.shields_measured.back();   // a staircase alone
  onset.shields = std::sqrt(onset.lower * onset.upper);
  onset.status = status_of(begins, onset);
  found.stop_lower = measured_at(holds, HoldPurpose::stop, stops.lower);
  found.stop_upper = std::isfinite(stops.upper)     ? measured_at(holds, HoldPurpose::stop, stops.upper)
                     : std::isnan(found.stop_lower) ? unknown
                                                    : onset.upper;   // what moves a bed at rest keeps one in motion
  return found;
}

bool ramp_is_over(const BedRecord& record, const Onset& onset, std::size_t ramp_levels) {
  const std::size_t done = record.holds.hold.size();
  if (done >= std::max<std::size_t>(ramp_levels, 1)) return true;
  if (onset.method == Onset::Method::none) return false;
  const auto confirmed = crossings(activity_of(record, onset.criterion), onset.value).confirmed;
  return confirmed && done > *confirmed + 3;
}

std::uint64_t count_events(Grains& grains, std::span<const double> x_before, double period, double diameter) noexcept {
  std::uint64_t events = 0;
  for (std::size_t p = 0; p < grains.size(); ++p) {
    double& travel = grains.travel[p];
    travel += way_along_x(x_before[p], grains.position[p].x, period);
    for (; travel >= diameter / 2; travel -= diameter / 2) ++events, grains.moved[p] = 1;
  }
  return events;
}

std::uint64_t count_moved(const Grains& grains) noexcept {
  return static_cast<std::uint64_t>(std::count(grains.moved.begin(), grains.moved.end(), 1));
}

std::uint64_t count_moving(const Grains& grains, double speed_scale) noexcept {
  const double limit = moving_speed(speed_scale);
  return static_cast<std::uint64_t>(
      std::count_if(grains.velocity.begin(), grains.velocity.end(), [&](Vec3 v) { return norm2(v) > limit * limit; }));
}

double surface_grains(const Scene& scene) {
  constexpr double coverage = 0.8;   // phi_A
  const double d = scene.bed.grains.diameter;
  return coverage * scene.bed.length.x * scene.bed.length.y / (std::numbers::pi / 4 * d * d);
}

double grain_time(double diameter, double density_ratio, double gravity, double terminal_speed) {
  const double reduced = (density_ratio - 1) * gravity;
  const double inertial = reduced > 0 ? std::sqrt(diameter / reduced) : 0;
  const double viscous = terminal_speed > 0 ? diameter / terminal_speed : 0;
  return std::max(inertial, viscous);
}

}   // namespace bedload

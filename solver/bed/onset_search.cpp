// Staircase, then bisection from the settled bed upwards, then from a moving one downwards. Nothing is remembered: every
// answer is read off the holds that are done.
#include "solver/bed/onset_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bedload {
namespace {

constexpr double endless = std::numeric_limits<double>::infinity();
constexpr double left_of_middle = 0.3;     // of the flux of the middle third: less is a flux that dies away
constexpr double hardly_any = 0.1;         // of the criterion's value: less is rest
constexpr double longer = 2;               // by which an undecided hold goes on, once
constexpr double usual_step = 1.2;         // beyond levels that all moved, or all rested, after a staircase of one step
constexpr double lowest_level = 1.0 / 8;   // of the staircase's first: a bed that still moves there has no threshold
constexpr double highest_level = 2;        // of the staircase's last
constexpr double stirring = 2;             // times the level at which the bed began to move ...
constexpr double stir_of_hold = 0.3;       // ... for so much of the time of a hold

/// Levels that holds of one purpose have tried, and how that ended: the last word on a level counts.
struct Tried {
  struct Level {
    double level;
    HoldVerdict verdict;
  };
  std::vector<Level> levels;   // rising

  void add(double level, HoldVerdict verdict) {
    const auto at = std::ranges::lower_bound(levels, level, {}, &Level::level);
    if (at != levels.end() && at->level == level) at->verdict = verdict;
    else levels.insert(at, {level, verdict});
  }
  bool any() const { return !levels.empty(); }
};

Tried tried(std::span<const JudgedHold> done, HoldPurpose purpose) {
  Tried all;
  for (const JudgedHold& hold : done)
    if (hold.purpose == purpose) all.add(hold.level, hold.verdict);
  return all;
}

LevelBracket bracket_of(const Tried& all) {
  LevelBracket found{0, endless};
  for (const auto& one : all.levels)
    if (one.verdict == HoldVerdict::mobile) {
      found.upper = one.level;
      break;
    }
  for (const auto& one : all.levels)
    if (one.verdict == HoldVerdict::arrested && one.level < found.upper) found.lower = one.level;
  return found;
}

/// The middle, by ratio, of the widest gap between neighbouring levels within the bracket; none if all are narrow enough.
/// A level that stayed undecided is the threshold as nearly as it can be known, and bounds a gap on both sides.
std::optional<double> middle_of_widest_gap(const Tried& all, LevelBracket bracket, double narrow) {
  double widest = 1 + narrow, middle = 0, last = bracket.lower;
  for (const auto& one : all.levels) {
    if (one.level <= bracket.lower || one.level > bracket.upper) continue;
    if (one.level / last > widest) widest = one.level / last, middle = std::sqrt(one.level * last);
    last = one.level;
  }
  return middle > 0 ? std::optional(middle) : std::nullopt;
}

/// Where levels are tried, and how far from those before while all moved or all rested.
struct Reach {
  explicit Reach(const std::vector<double>& staircase, std::size_t climbed)
      : lowest(staircase.front() * lowest_level),
        highest(staircase.back() * highest_level),
        step(climbed > 1 ? staircase[climbed - 1] / staircase[climbed - 2] : usual_step) {}
  double lowest, highest, step;
};

/// The next level to try; none when the bracket is narrow, or nothing is left to try.
std::optional<double> next_level(const Tried& all, double narrow, const Reach& reach) {
  const LevelBracket bracket = bracket_of(all);
  if (bracket.upper == endless) {
    const double higher = all.levels.back().level * reach.step;
    return higher <= reach.highest ? std::optional(higher) : std::nullopt;
  }
  if (bracket.lower == 0) {
    const double lower = all.levels.front().level / reach.step;
    return lower >= reach.lowest ? std::optional(lower) : std::nullopt;
  }
  return middle_of_widest_gap(all, bracket, narrow);
}

/// The last hold went on for longer already if it is not the first on its level.
bool goes_on(std::span<const JudgedHold> done, HoldPurpose purpose) {
  if (done.empty() || done.back().purpose != purpose || done.back().verdict != HoldVerdict::undecided) return false;
  return done.size() < 2 || done[done.size() - 2].purpose != purpose ||
         done[done.size() - 2].level != done.back().level;
}

}   // namespace

std::string_view name_of(HoldPurpose purpose) {
  switch (purpose) {
    case HoldPurpose::ramp: return "ramp";
    case HoldPurpose::staircase: return "staircase";
    case HoldPurpose::onset: return "onset";
    case HoldPurpose::stir: return "stir";
    case HoldPurpose::stop: return "stop";
    case HoldPurpose::shear: return "shear";
  }
  return "ramp";
}

std::string_view name_of(HoldVerdict verdict) {
  switch (verdict) {
    case HoldVerdict::none: return "none";
    case HoldVerdict::arrested: return "arrested";
    case HoldVerdict::undecided: return "undecided";
    case HoldVerdict::mobile: return "mobile";
  }
  return "none";
}

std::vector<JudgedHold> judged_holds(const BedRecord::Holds& h) {
  std::vector<JudgedHold> holds;
  for (std::size_t k = 0; k < h.hold.size(); ++k)
    holds.push_back({static_cast<HoldPurpose>(h.purpose[k]), h.level[k], static_cast<HoldVerdict>(h.verdict[k])});
  return holds;
}

LevelBracket bracket_of(std::span<const JudgedHold> done, HoldPurpose purpose) {
  return bracket_of(tried(done, purpose));
}

std::optional<PlannedHold> next_hold(const OnsetSearchPlan& plan, std::span<const JudgedHold> done) {
  const Tried stairs = tried(done, HoldPurpose::staircase);
  const bool moved = stairs.any() && stairs.levels.back().verdict == HoldVerdict::mobile;
  if (!moved) {
    if (stairs.levels.size() == plan.staircase.size()) return std::nullopt;   // never moved
    return PlannedHold{HoldPurpose::staircase, plan.staircase[stairs.levels.size()], plan.stair, !stairs.any()};
  }

  const PlannedHold longer_hold{done.back().purpose, done.back().level, longer * plan.hold, false};
  const Reach reach(plan.staircase, stairs.levels.size());
  const Tried onset = tried(done, HoldPurpose::onset);
  const double first = stairs.levels.back().level * std::pow(reach.step, plan.shift);
  if (!onset.any()) return PlannedHold{HoldPurpose::onset, first, plan.hold, true};
  if (goes_on(done, HoldPurpose::onset)) return longer_hold;
  if (const auto level = next_level(onset, plan.bracket, reach))
    return PlannedHold{HoldPurpose::onset, *level, plan.hold, true};

  const LevelBracket begins = bracket_of(onset);
  if (begins.lower == 0 || begins.upper == endless) return std::nullopt;
  if (goes_on(done, HoldPurpose::stop)) return longer_hold;
  Tried stop = tried(done, HoldPurpose::stop);
  stop.add(begins.upper, HoldVerdict::mobile);   // what moves a bed at rest keeps one in motion
  const auto level = next_level(stop, plan.bracket, reach);
  if (!level) return std::nullopt;
  const JudgedHold& last = done.back();
  const bool still_moves =
      last.purpose == HoldPurpose::stop && last.verdict == HoldVerdict::mobile && *level < last.level;
  if (last.purpose == HoldPurpose::stir || still_moves) return PlannedHold{HoldPurpose::stop, *level, plan.hold, false};
  return PlannedHold{HoldPurpose::stir, stirring * begins.upper, stir_of_hold * plan.hold, true};
}

HoldVerdict judge_hold(double middle_flux, double last_flux, double value) {
  if (last_flux < hardly_any * value) return HoldVerdict::arrested;
  const bool lasts = last_flux >= left_of_middle * middle_flux;
  return last_flux >= value && lasts ? HoldVerdict::mobile : HoldVerdict::undecided;
}

Thirds thirds_of(std::span<const double> time, std::span<const double> flux, double start, double end) {
  double sums[3] = {}, lengths[3] = {};
  double began = start;
  for (std::size_t k = 0; k < time.size(); ++k) {
    const double into = (time[k] - start) / (end - start) * 3;
    const auto third = std::min<std::size_t>(2, static_cast<std::size_t>(std::max(0.0, std::ceil(into) - 1)));
    sums[third] += flux[k] * (time[k] - began), lengths[third] += time[k] - began;
    began = time[k];
  }
  const auto mean = [&](int third) { return lengths[third] > 0 ? sums[third] / lengths[third] : 0; };
  return {mean(1), mean(2)};
}

}   // namespace bedload

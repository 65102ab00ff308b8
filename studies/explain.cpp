#include "studies/explain.hpp"

#include <cmath>

#include <fmt/format.h>

#include "base/durable_file.hpp"
#include "checkpoint/checkpoint_series.hpp"
#include "scheduler/attempt.hpp"
#include "scheduler/bed_sharing.hpp"
#include "scheduler/heartbeat.hpp"
#include "scheduler/judgement.hpp"
#include "scheduler/request.hpp"
#include "solver/expected_bed.hpp"
#include "solver/required_models.hpp"
#include "studies/database_values.hpp"

namespace bedload {

namespace fs = std::filesystem;

namespace {

std::string attempt_in_words(const Attempt& a) {
  auto text = fmt::format("attempt {} on {} at {}: {}", a.number, a.host, a.start, word(a.cause));
  if (a.step) text += fmt::format(", steps {}-{}", a.from_step.value_or(0), *a.step);
  text += fmt::format(", {:.0f} core-seconds", a.core_seconds);
  return a.message.empty() ? text : fmt::format("{}: {}", text, a.message);
}

/// What the next `bedload run` does.
std::string prospect(const Position& position, const std::vector<Attempt>& attempts, const fs::path& directory) {
  if (const auto request = read_request(directory); request == Request::hold)
    return "it is on hold: `bedload retry` lets it go on";
  const auto judgement = judge(position, attempts);
  switch (judgement.verdict) {
    case Verdict::done: return "it is done and is reused: the same physics gives the same bits";
    case Verdict::failed: return fmt::format("it failed ({}); `bedload retry` tries again", judgement.reason);
    case Verdict::set_aside:
      return fmt::format("it is set aside ({}); the next `bedload run` tries again", judgement.reason);
    case Verdict::again: break;
  }
  return position.step > 0 ? fmt::format("the next `bedload run` continues it from step {}", position.step)
                           : "the next `bedload run` starts it";
}

}   // namespace

Rows scene_numbers(const Scene& scene) {
  const auto n = numbers_of(scene);
  const auto& bed = scene.bed;
  const bool lid = scene.drive.kind == FlowRamp::Kind::lid;
  const auto at = std::isnan(n.shields) ? std::string() : fmt::format(" at theta = {:.2g}", n.shields);
  Rows rows{{"number", "value", "unit"}, {}};
  const auto add = [&](const std::string& name, double value, const char* unit) {
    if (std::isfinite(value)) rows.rows.push_back({name, value, std::string(unit)});
  };
  add("density ratio s", n.density_ratio, "");
  add("Galileo number Ga", n.galileo, "");
  add("grain time td", n.grain_time, "s");
  add("settling speed of a lone grain", n.settling_speed, "m/s");
  add("settling Reynolds number", n.settling_reynolds, "");
  add("largest grain Reynolds number expected", n.grain_reynolds, "");
  add("solid fraction of bed or suspension", n.solid_fraction, "");
  add("cell edge, mean / d", std::cbrt(scene.grid.cell_volume()) / bed.grains.diameter, "");
  add("kappa, own drag that comes back to a lone grain", n.self_response, "");
  add("bed depth, expected", n.bed_depth, "d");
  add("gap above it", n.gap / bed.grains.diameter, "d");
  add("lowest Shields number", n.lowest_shields, "");
  add("highest Shields number", n.highest_shields, "");
  add("Re*" + at, n.friction_reynolds, "");
  add("shear Reynolds number Re_g" + at, n.shear_reynolds, "");
  add((scene.terms.turbulence ? "laminar " : "") + std::string(lid ? "lid speed" : "mean speed") + at, n.flow_speed,
      "m/s");
  add("gap Reynolds number" + at, n.gap_reynolds, "");
  add("impact speed" + at, n.impact_speed, "m/s");
  add("impact Stokes number" + at, n.impact_stokes, "");
  add("Young's modulus", bed.grains.young_modulus, "Pa");
  add("DEM step", bed.dem_step, "s");
  add("DEM step / Rayleigh time of the smallest grain", bed.dem_step / smallest_rayleigh_time(bed), "");
  add("fluid step, at most", scene.steps.fluid_interval, "s");
  add("coupling interval, at most", std::ceil(scene.steps.fluid_interval / bed.dem_step - 1e-9), "DEM steps");
  return rows;
}

Rows scene_models(const Scene& scene) {
  Rows rows{{"term", "on", "wanted", "ratio", "reason"}, {}};
  const auto yes = [](bool is) { return std::string(is ? "yes" : "no"); };
  for (const auto& m : decisions_of(scene))
    rows.rows.push_back({m.term, yes(m.on), yes(m.wanted), real_or_null(m.ratio), m.reason});
  return rows;
}

std::vector<std::string> story_of(const CaseEntry& entry, const fs::path& directory) {
  if (!fs::exists(directory / "case.toml"))
    return {"it is new: the next `bedload run` makes its directory and starts it"};
  std::vector<std::string> story;
  const auto attempts = read_attempts(directory);
  for (const auto& a : attempts) story.push_back(attempt_in_words(a));
  if (const auto holder = FileLock::holder(directory / "lock")) {
    const auto beat = read_heartbeat(directory);
    story.push_back(fmt::format("it is running now: pid {} on {}{}", holder->pid, holder->host,
                                beat ? fmt::format(", step {}", beat->step) : ""));
    return story;
  }
  if (!entry.bed.empty() && !has_bed(directory))
    story.push_back(fmt::format("its bed {} has not settled yet", entry.bed.substr(0, 12)));
  const auto newest = newest_position(directory);
  if (const auto state = newest_whole(directory, [](const std::string&) {}); state && state->clock.retries > 0)
    story.push_back(fmt::format("{} step{} taken again shorter", state->clock.retries,
                                state->clock.retries == 1 ? " was" : "s were"));
  story.push_back(prospect({newest ? newest->step : 0, newest && newest->finished}, attempts, directory));
  if (!entry.in_study) story.push_back("it is no longer in the study file: its results are kept, out of the curve");
  return story;
}

}   // namespace bedload

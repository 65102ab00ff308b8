#include "studies/plan.hpp"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/log.hpp"
#include "checkpoint/checkpoint_series.hpp"
#include "solver/bed/incipient_motion.hpp"
#include "solver/experiment.hpp"
#include "studies/case_file.hpp"
#include "studies/case_identity.hpp"
#include "studies/study_directory.hpp"

namespace bedload {

namespace fs = std::filesystem;

namespace {

/// What ends a ramp: no part of a case's identity, so it may differ from what the directory was made with.
bool same_end(const CaseInputs& a, const CaseInputs& b) {
  const std::string steps = fmt::format("{}.steps", staircase_of(a));
  const auto same = [&](std::string_view key) {
    return a.has(key) == b.has(key) && (!a.has(key) || a.values.find(key)->second == b.values.find(key)->second);
  };
  return same(steps) && same("onset.criterion") && same("onset.value");
}

bool ramp_goes_on(const fs::path& directory, const Scene& scene) {
  const auto state = newest_whole(directory, [](const std::string& line) { log_warning(line); });
  return state && !ramp_is_over(state->record, scene.onset, scene.drive.levels.size());
}

PlannedCase planned(Case one, const fs::path& results) {
  PlannedCase made{std::move(one)};
  const auto directory = case_directory(results, made.one.id);
  if (!fs::exists(directory / "case.toml")) return made;
  made.fate = Fate::kept;
  const auto newest = newest_position(directory);
  made.done = newest && newest->finished;
  if (!made.done || same_end(read_case_directory(directory).inputs, made.one.inputs)) return made;
  made.results_change = true;
  if (!ramp_goes_on(directory, made.one.scene)) return made;
  made.fate = Fate::extended;
  made.done = false;
  return made;
}

int physics_version_of(const CaseEntry& entry) {
  const auto parameters = nlohmann::json::parse(entry.parameters, nullptr, false);
  return parameters.is_object() ? parameters.value("physics_version", physics_version) : physics_version;
}

}   // namespace

std::string_view word(Fate fate) { return fate == Fate::fresh ? "new" : fate == Fate::kept ? "kept" : "extended"; }

Plan make_plan(std::vector<Case> cases, const std::vector<CaseEntry>& known, const fs::path& results) {
  Plan plan;
  std::set<std::string> ids, beds;
  for (auto& one : cases) {
    ids.insert(one.id);
    if (!one.bed_id.empty() && beds.insert(one.bed_id).second) plan.beds.push_back(bed_inputs(one.inputs));
    plan.cases.push_back(planned(std::move(one), results));
  }
  for (const auto& entry : known) {
    if (entry.is_bed || !entry.in_study || ids.contains(entry.id)) continue;
    plan.dropped.push_back(entry);
    if (physics_version_of(entry) != physics_version) plan.other_physics.push_back(entry);
  }
  return plan;
}

Cost predicted_cost(const Case& one) {
  Cost cost = predicted_cost(one.scene);
  cost.core_seconds *= one.pace;
  return cost;
}

Cost predicted_cost(const Scene& scene) {
  constexpr double grain_steps_per_second = 3.5e6, seconds_per_cell_step = 300e-9;   // coupled; packing is no slower
  constexpr double packing_steps = 8000;   // DEM steps: 6600 to 9500 for the beds of the quickstart
  constexpr double bytes_per_grain = 121, contacts_per_grain = 3, bytes_per_contact = 32, bytes_per_cell = 32,
                   bytes_per_sample = 1250;   // in two checkpoints, and as a row of the database
  const double grains = static_cast<double>(scene.bed.source.count),
               cells = static_cast<double>(scene.grid.cell_count());
  const double checkpoint =
      grains * (bytes_per_grain + contacts_per_grain * bytes_per_contact) + cells * bytes_per_cell;
  if (scene.bed_only) return {grains * packing_steps / grain_steps_per_second, 2 * checkpoint};
  const double time = planned_time(scene) + scene.shear.time;
  Cost cost;
  cost.core_seconds = grains * time / scene.bed.dem_step / grain_steps_per_second +
                      cells * time / scene.steps.fluid_interval * seconds_per_cell_step;
  cost.bytes = 2 * checkpoint + time / scene.record.every * bytes_per_sample;
  return cost;
}

}   // namespace bedload

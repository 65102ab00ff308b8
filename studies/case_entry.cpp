#include "studies/case_entry.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "solver/state.hpp"
#include "studies/case_identity.hpp"
#include "studies/study_directory.hpp"

namespace bedload {

namespace {

/// Every input, in SI, under its key.
std::string as_json(const CaseInputs& inputs) {
  nlohmann::ordered_json json;
  for (const auto& [key, value] : inputs.values) std::visit([&, k = key](const auto& v) { json[k] = v; }, value);
  json["physics_version"] = physics_version;
  return json.dump();
}

std::vector<std::pair<std::string, Value>> columns_of(const CaseInputs& inputs) {
  const auto scene = scene_of(inputs);
  const auto& bed = scene.bed;
  const auto whole = [](std::uint64_t n) { return static_cast<std::int64_t>(n); };
  return {{"diameter_m", bed.grains.diameter},
          {"grain_density_kg_per_m3", bed.grains.density},
          {"fluid_density_kg_per_m3", bed.fluid.density},
          {"viscosity_m2_per_s", bed.fluid.viscosity},
          {"spread", bed.grains.spread},
          {"friction", bed.grains.friction},
          {"restitution", bed.grains.restitution},
          {"young_modulus_pa", bed.grains.young_modulus},
          {"grains", whole(bed.source.count)},
          {"seed", whole(bed.source.seed)},
          {"length_m", bed.length.x},
          {"width_m", bed.length.y},
          {"height_m", bed.length.z},
          {"cell_x_m", scene.grid.h.x},
          {"cell_y_m", scene.grid.h.y},
          {"cell_z_m", scene.grid.h.z},
          {"drag_law", inputs.word("models.drag")},
          {"dem_step_s", bed.dem_step},
          {"fluid_step_s", scene.steps.fluid_interval},
          {"physics_version", std::int64_t{physics_version}}};
}

CaseEntry entry(const CaseInputs& inputs, const std::string& label) {
  CaseEntry made;
  made.id = case_id(inputs);
  made.label = label;
  made.is_bed = inputs.bed_only;
  made.directory = inputs.bed_only ? bed_directory({}, made.id) : case_directory({}, made.id);
  if (!inputs.bed_only) made.bed = bed_id(inputs);
  made.parameters = as_json(inputs);
  made.columns = columns_of(inputs);
  return made;
}

/// The label without its seed: "d0.5mm-s3" -> "d0.5mm".
std::string without_seed(const std::string& label, std::uint64_t seed) {
  const auto ending = fmt::format("-s{}", seed);
  return label.ends_with(ending) ? label.substr(0, label.size() - ending.size()) : label;
}

}   // namespace

CaseEntry case_entry(const Case& one) { return entry(one.inputs, one.label); }
CaseEntry bed_entry(const CaseInputs& bed) { return entry(bed, "bed-" + short_id(case_id(bed))); }
CaseEntry entry_of(const CaseDirectory& directory) { return entry(directory.inputs, directory.label); }

CaseIdentity identity_of(const CaseDirectory& directory) {
  const auto seed = directory.scene.bed.source.seed;
  const bool seeded = directory.inputs.has("bed.seed");
  return {case_id(directory.inputs), directory.label, parameter_set_id(directory.inputs),
          seeded ? without_seed(directory.label, seed) : directory.label, seed};
}

}   // namespace bedload

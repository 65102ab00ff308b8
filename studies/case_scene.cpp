// From inputs to the scene that the solver runs.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.hpp"
#include "solver/coupling/drag_laws.hpp"
#include "studies/case_inputs.hpp"
#include "studies/study_keys.hpp"

namespace bedload {

namespace {

/// The number, or zero while inputs are still being resolved.
double number_or_zero(const CaseInputs& inputs, std::string_view key) {
  return inputs.has(key) ? inputs.number(key) : 0;
}

/// Rows of a table below its heading.
std::uint64_t rows_of(const std::string& csv) {
  if (csv.empty()) return 0;
  const auto lines = std::ranges::count(csv, '\n') + (csv.back() == '\n' ? 0 : 1);
  return static_cast<std::uint64_t>(std::max<std::ptrdiff_t>(0, lines - 1));
}

BedSource source_of(const CaseInputs& inputs) {
  using Kind = BedSource::Kind;
  const auto& source = inputs.word("bed.source");
  const Kind kind = source == "poured"       ? Kind::poured
                    : source == "lattice"    ? Kind::lattice
                    : source == "suspension" ? Kind::suspension
                    : source == "file"       ? Kind::file
                                             : Kind::none;
  BedSource made{.kind = kind, .csv = inputs.csv};
  made.count =
      kind == Kind::file ? rows_of(inputs.csv) : static_cast<std::uint64_t>(number_or_zero(inputs, "bed.count"));
  made.fixed = inputs.has("bed.motion");
  if (inputs.has("bed.seed")) made.seed = static_cast<std::uint64_t>(inputs.number("bed.seed"));
  return made;
}

Side side_of(const CaseInputs& inputs, std::string_view key) {
  return inputs.word(key) == "periodic" ? Side::periodic : Side::wall;
}

/// A slope tilts gravity about y: a positive one drives along +x.
Vec3 gravity_of(const CaseInputs& inputs) {
  const double g = inputs.number("box.gravity"), slope = inputs.number("box.slope");
  return {g * std::sin(slope), 0, -g * std::cos(slope)};
}

BedScene bed_scene_of(const CaseInputs& inputs) {
  BedScene bed;
  bed.fluid = {inputs.number("fluid.density"), inputs.number("fluid.viscosity")};
  bed.grains = {.diameter = inputs.number("grains.diameter"),
                .density = inputs.number("grains.density"),
                .spread = inputs.number("grains.spread"),
                .friction = inputs.number("grains.friction"),
                .restitution = inputs.number("grains.restitution"),
                .poisson = inputs.number("grains.poisson"),
                .young_modulus = number_or_zero(inputs, "grains.stiffness"),
                .rolling_friction = number_or_zero(inputs, "grains.rolling_friction")};
  bed.source = source_of(inputs);
  bed.length = {inputs.number("box.length"), inputs.number("box.width"), inputs.number("box.height")};
  bed.sides = {side_of(inputs, "box.x"), side_of(inputs, "box.y"), side_of(inputs, "box.z")};
  bed.top = inputs.word("box.top") == "lid" ? Top::lid : Top::free_slip;
  bed.gravity = gravity_of(inputs);
  bed.dem_step = number_or_zero(inputs, "steps.dem");
  return bed;
}

FluidRung rung_of(const CaseInputs& inputs) {
  const std::string& word = inputs.word("models.fluid");
  return word == "profile" ? FluidRung::profile : word == "column" ? FluidRung::column : FluidRung::box;
}

/// Cells of about the size asked for, a whole number of them along each edge; layers are cells as wide as the box.
StaggeredGrid grid_of(const CaseInputs& inputs, const BedScene& bed) {
  StaggeredGrid grid{.sides = bed.sides, .top = bed.top};
  const bool layers = rung_of(inputs) != FluidRung::box;
  const double asked[] = {layers ? bed.length.x : inputs.number("box.cell.xy"),
                          layers ? bed.length.y : inputs.number("box.cell.xy"), inputs.number("box.cell.z")};
  for (int c = 0; c < 3; ++c) {
    grid.cells[c] = std::max(1, static_cast<int>(std::lround(bed.length[c] / asked[c])));
    grid.h[c] = bed.length[c] / grid.cells[c];
  }
  return grid;
}

std::vector<double> levels_of(const CaseInputs& inputs, const std::string& table) {
  double level = inputs.number(table + ".from");
  std::vector<double> levels;
  for (int k = 0; k < inputs.number(table + ".steps"); ++k) {
    levels.push_back(level);
    if (inputs.has(table + ".ratio")) level *= inputs.number(table + ".ratio");
    else level = inputs.number(table + ".from") + (k + 1) * number_or_zero(inputs, table + ".step");
  }
  return levels;
}

FlowRamp drive_of(const CaseInputs& inputs) {
  FlowRamp ramp{.levels = {0}, .dwell = inputs.number("drive.dwell")};
  const auto& kind = inputs.word("drive.kind");
  const std::string table(staircase_of(inputs));
  if (kind == "none" || table.empty()) return ramp;
  ramp.kind = kind == "lid"        ? FlowRamp::Kind::lid
              : kind == "pressure" ? FlowRamp::Kind::pressure
              : kind == "push"     ? FlowRamp::Kind::push
                                   : FlowRamp::Kind::through_flow;
  ramp.quantity = table == "drive.shields"    ? FlowRamp::Quantity::shields
                  : table == "drive.speed"    ? FlowRamp::Quantity::lid_speed
                  : table == "drive.gradient" ? FlowRamp::Quantity::gradient
                  : table == "drive.push"     ? FlowRamp::Quantity::push
                                              : FlowRamp::Quantity::through_flow;
  ramp.levels = levels_of(inputs, table);
  return ramp;
}

Terms terms_of(const CaseInputs& inputs) {
  const auto& names = std::get<std::vector<std::string>>(inputs.values.at("models.terms"));
  const auto on = [&](const char* term) { return std::ranges::find(names, term) != names.end(); };
  Terms terms;
  for (const auto& [name, term] : named_terms) terms.*term = on(name.data());
  if (inputs.has("models.crowded")) terms.crowded = inputs.number("models.crowded");
  return terms;
}

}   // namespace

DragLawName drag_law_named(std::string_view name) {
  for (const auto law : drag_law_names)
    if (name_of(law) == name) return law;
  throw Error(ErrorKind::internal, fmt::format("\"{}\" is a drag law of study files, but not of the solver", name));
}

Scene scene_of(const CaseInputs& inputs) {
  Scene scene;
  scene.bed = bed_scene_of(inputs);
  scene.bed_only = inputs.bed_only;
  scene.fluid = rung_of(inputs);
  scene.grid = grid_of(inputs, scene.bed);
  scene.drive = drive_of(inputs);
  scene.developed = !inputs.has("drive.start");
  if (inputs.has("fluid.start")) scene.fluid_start = FluidStart::taylor_green;
  scene.start_speed = number_or_zero(inputs, "fluid.start_speed");
  scene.bottom_roughness = number_or_zero(inputs, "box.roughness");
  const std::string& method = inputs.word("onset.method");
  scene.onset.method = method == "ramp"     ? Onset::Method::ramp
                       : method == "bisect" ? Onset::Method::bisect
                                            : Onset::Method::none;
  scene.onset.criterion =
      inputs.word("onset.criterion") == "flux" ? Onset::Criterion::flux : Onset::Criterion::moving_fraction;
  scene.onset.value = inputs.number("onset.value");
  if (inputs.has("onset.bracket")) scene.onset.bracket = inputs.number("onset.bracket");
  scene.onset.hold = number_or_zero(inputs, "onset.hold");
  scene.shear = {.shields = number_or_zero(inputs, "bed.shear.shields"),
                 .time = number_or_zero(inputs, "bed.shear.time")};
  scene.drag = drag_law_named(inputs.word("models.drag"));
  scene.terms = terms_of(inputs);
  scene.smoothing = {.xy = number_or_zero(inputs, "models.smoothing.xy"),
                     .z = number_or_zero(inputs, "models.smoothing.z")};
  scene.steps.fluid_interval = number_or_zero(inputs, "steps.fluid");
  scene.frozen_depth = number_or_zero(inputs, "models.frozen_depth");
  scene.steps.beyond_limit = inputs.has("steps.beyond_limit");
  scene.record.every = inputs.number("record.every");
  scene.record.tracks = std::get<std::vector<std::uint64_t>>(inputs.values.at("record.tracks"));
  return scene;
}

}   // namespace bedload

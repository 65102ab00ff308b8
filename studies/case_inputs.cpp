// From settings to SI: defaults, grain diameters and grain times, "auto".
#include "studies/case_inputs.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "base/durable_file.hpp"
#include "base/error.hpp"
#include "solver/bed/incipient_motion.hpp"
#include "solver/coupling/drag_laws.hpp"
#include "solver/expected_bed.hpp"
#include "solver/grains/bed_packing.hpp"
#include "solver/grains/grain_dynamics.hpp"
#include "studies/study_keys.hpp"

namespace bedload {

namespace {

/// Rounded to so many significant digits. What comes out of powers and roots is rounded before it becomes an input, so
/// that the last bit of a mathematical library renames no case.
double significant(double value, int digits) {
  return std::strtod(fmt::format("{:.{}e}", value, digits - 1).c_str(), nullptr);
}
constexpr int exact_digits = 12;   // of products such as 20 d: hides 0.0077999999999999996
constexpr int time_digits = 6;     // of grain times
constexpr int auto_digits = 4;     // of a step that bedload chose

constexpr std::string_view ramp_parts[] = {"from", "ratio", "step", "steps"};
constexpr std::string_view staircases[] = {"drive.shields", "drive.speed", "drive.gradient"};

std::string joined(std::string_view table, std::string_view key) { return fmt::format("{}.{}", table, key); }

/// Resolves one case, key by key, in the order in which keys depend on each other.
class Resolver {
 public:
  Resolver(const Settings& settings, const std::filesystem::path& directory, Problems& problems)
      : settings_(settings), directory_(directory), problems_(problems) {}

  CaseInputs run();

 private:
  bool given(std::string_view key) const { return settings_.find(key) != settings_.end(); }
  Place place(std::string_view key) const;
  void problem(std::string_view key, const std::string& message, const std::string& hint = {});
  void refuse(std::string_view key, const std::string& why);

  std::optional<Setting> setting(std::string_view key, bool required = true);
  bool is_auto(std::string_view key);
  void take(std::string_view key);
  void take_all(std::initializer_list<std::string_view> keys);
  void quantity(std::string_view key, const Quantity&);
  bool complete() const;

  void measure_in_grains();
  void box();
  void bed();
  void bed_table();
  void count_from_depth();
  void drive();
  void staircase(std::string_view table);
  void onset();
  void models();
  void stiffness();
  void dem_step();
  double rayleigh_time_of_smallest() const;
  double number(std::string_view key) const { return inputs_.number(key); }
  const std::string& word(std::string_view key) const { return inputs_.word(key); }

  const Settings& settings_;
  const std::filesystem::path& directory_;
  Problems& problems_;
  CaseInputs inputs_;
  GrainScales scales_;
  Grains table_grains_;   // of bed.file
};

Place Resolver::place(std::string_view key) const {
  const auto found = settings_.find(key);
  return found == settings_.end() ? Place{} : found->second.place;
}

void Resolver::problem(std::string_view key, const std::string& message, const std::string& hint) {
  problems_.add(place(key), fmt::format("{}: {}", key, message), hint);
}

/// A key that makes no sense beside the others.
void Resolver::refuse(std::string_view key, const std::string& why) {
  if (given(key)) problem(key, why, "leave it out");
}

std::optional<Setting> Resolver::setting(std::string_view key, bool required) {
  if (const auto found = settings_.find(key); found != settings_.end()) return found->second;
  if (auto fallback = fallback_of(*find_key(key))) return fallback;
  if (required)
    problems_.add({}, fmt::format("{} is missing", key), "docs/study_files.md shows every key with an example");
  return std::nullopt;
}

bool Resolver::is_auto(std::string_view key) {
  const auto one = setting(key, false);
  const auto* text = one ? std::get_if<std::string>(&one->value) : nullptr;
  return text && *text == "auto";
}

void Resolver::quantity(std::string_view key, const Quantity& value) {
  if (value.grain_times != 0 && !scales_.time) {
    return problem(
        key, fmt::format("\"{}\" counts grain times, which only grains that settle in the fluid have", value.text),
        "heavier grains, or a time in s");
  }
  try {
    const int digits = value.grain_times != 0 ? time_digits : exact_digits;
    const double si = value.si(scales_);
    inputs_.values.insert_or_assign(std::string(key), value.relative() ? significant(si, digits) : si);
  } catch (const UnitError& error) {
    problem(key, error.what(), error.hint);
  }
}

void Resolver::take(std::string_view key) {
  const auto one = setting(key);
  if (!one) return;
  if (const auto* q = std::get_if<Quantity>(&one->value)) return quantity(key, *q);
  std::visit(
      [&](const auto& value) {
        if constexpr (!std::is_same_v<std::decay_t<decltype(value)>, Quantity>)
          inputs_.values.insert_or_assign(std::string(key), Input(value));
      },
      one->value);
}

void Resolver::take_all(std::initializer_list<std::string_view> keys) {
  for (const auto key : keys) take(key);
}

/// True while nothing that the next steps compute with is missing.
bool Resolver::complete() const {
  constexpr std::string_view needed[] = {"fluid.density", "fluid.viscosity", "grains.diameter", "grains.density",
                                         "box.gravity",   "box.length",      "box.width",       "box.height"};
  return std::ranges::all_of(needed, [&](std::string_view key) { return inputs_.has(key); });
}

/// What "d" and "td" are in this case. Grains no heavier than the fluid, or without weight, have no time of their own.
void Resolver::measure_in_grains() {
  if (inputs_.has("grains.diameter")) scales_.diameter = number("grains.diameter");
  for (const auto key : {"fluid.density", "fluid.viscosity", "grains.diameter", "grains.density", "box.gravity"})
    if (!inputs_.has(key)) return;
  const double d = number("grains.diameter"), s = number("grains.density") / number("fluid.density"),
               g = number("box.gravity");
  if (s <= 1 || g <= 0) return;
  const auto law = drag_law_named(word("models.drag"));
  scales_.time = grain_time(d, s, g, terminal_speed(law, number("fluid.viscosity"), s, d, g));
}

void Resolver::box() {
  take_all(
      {"box.length", "box.width", "box.height", "box.cell.xy", "box.cell.z", "box.x", "box.y", "box.z", "box.top"});
  for (const auto& [cell, edge] :
       {std::pair{"box.cell.xy", "box.length"}, {"box.cell.xy", "box.width"}, {"box.cell.z", "box.height"}}) {
    if (!inputs_.has(cell) || !inputs_.has(edge) || number(cell) <= number(edge)) continue;
    problem(cell,
            fmt::format("a cell of {:.4g} m is larger than the box ({} is {:.4g} m)", number(cell), edge, number(edge)),
            "at least 3 cells must fit along every edge");
  }
}

void Resolver::bed() {
  take("bed.source");
  const auto& source = word("bed.source");
  const bool packed = source == "poured" || source == "lattice";
  if (!packed) {
    for (const auto key : {"bed.count", "bed.depth", "bed.seed"})
      refuse(key, fmt::format("nothing is packed with bed.source = \"{}\"", source));
  }
  if (source != "file") refuse("bed.file", fmt::format("no file is read with bed.source = \"{}\"", source));
  if (packed) {
    take("bed.seed");
    if (given("bed.count") && given("bed.depth"))
      return problem("bed.depth", "both count and depth say how much is poured", "keep one of them");
    if (given("bed.depth")) return count_from_depth();
    if (!given("bed.count"))
      return problems_.add({}, "bed.count is missing", "say how many grains: count = 1500, or depth = \"6 d\"");
    return take("bed.count");
  }
  if (source == "file") bed_table();
}

/// Grains that fill the box to a depth, at the solid fraction of a loose packing.
void Resolver::count_from_depth() {
  quantity("bed.depth", std::get<Quantity>(setting("bed.depth")->value));
  if (!inputs_.has("bed.depth") || !inputs_.has("grains.spread") || !complete()) return;
  const double spread = number("grains.spread");
  const double volume = sphere_volume(number("grains.diameter")) * (1 + 3 * spread * spread);   // mean of d^3
  const double count =
      std::round(number("bed.depth") * number("box.length") * number("box.width") * loose_packing / volume);
  inputs_.values.erase("bed.depth");
  if (count < 1) return problem("bed.depth", "not one grain fits into so thin a bed");
  inputs_.values["bed.count"] = count;
}

void Resolver::bed_table() {
  take("bed.file");
  if (!problems_.empty() || !inputs_.has("bed.file") || !complete()) return;
  try {
    inputs_.csv = read_text(directory_ / word("bed.file"));
    table_grains_ = place_grains(scene_of(inputs_).bed);
  } catch (const Error& error) {
    problem("bed.file", error.what(), error.hint);
  }
}

void Resolver::drive() {
  take_all({"drive.kind", "drive.dwell"});
  const auto& kind = word("drive.kind");
  std::vector<std::string_view> found;
  for (const auto table : staircases) {
    const bool any = std::ranges::any_of(ramp_parts, [&](std::string_view part) { return given(joined(table, part)); });
    if (any) found.push_back(table);
  }
  if (kind == "none") {
    for (const auto table : found) refuse(joined(table, "from"), "drive.kind = \"none\" leaves the fluid alone");
    return;
  }
  const std::string_view other = kind == "lid" ? "drive.speed" : "drive.gradient";
  if (found.size() == 1 && (found[0] == "drive.shields" || found[0] == other)) return staircase(found[0]);
  problem("drive.kind", fmt::format("\"{}\" wants one of drive.shields and {}", kind, other),
          "for example: shields = { from = 0.06, ratio = 1.2, steps = 12 }");
}

void Resolver::staircase(std::string_view table) {
  const auto from = joined(table, "from"), ratio = joined(table, "ratio"), step = joined(table, "step"),
             steps = joined(table, "steps");
  take(from);
  if (!given(steps)) inputs_.values[steps] = 1.0;
  else take(steps);
  if (given(ratio) && given(step))
    return problem(step, "levels grow by a ratio or by a step, not both", "keep one of them");
  if (given(ratio)) take(ratio);
  if (given(step)) take(step);
  if (inputs_.has(ratio) && number(ratio) <= 1)
    problem(ratio, "levels must rise: the ratio of one to the one before is above 1");
  if (number(steps) > 1 && !given(ratio) && !given(step))
    problem(steps, "how the levels grow is missing", "add ratio = 1.2, or step");
}

void Resolver::onset() {
  take_all({"onset.criterion", "onset.value"});
  const bool driven = word("drive.kind") != "none";
  if (!given("onset.method")) {
    inputs_.values["onset.method"] = driven ? "ramp" : "none";
    return;
  }
  take("onset.method");
  if (!driven && word("onset.method") == "ramp")
    problem("onset.method", "a ramp needs a drive", "set drive.kind, or onset.method = \"none\"");
}

void Resolver::models() {
  inputs_.values["models.fluid"] = "box";
  take("models.drag");
  if (is_auto("models.terms")) {
    inputs_.values["models.terms"] =
        std::vector<std::string>{"buoyancy", "drag", "pressure_gradient", "viscous_stress"};
  } else {
    take("models.terms");
  }
}

void Resolver::stiffness() {
  if (!is_auto("grains.stiffness")) return take("grains.stiffness");
  const auto bed = scene_of(inputs_).bed;
  inputs_.values["grains.stiffness"] = automatic_young_modulus(bed, bed_layers(bed));
}

double Resolver::rayleigh_time_of_smallest() const {
  const auto bed = scene_of(inputs_).bed;
  if (bed.source.kind != BedSource::Kind::file) return smallest_rayleigh_time(bed);
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < table_grains_.size(); ++n) {
    smallest = std::min(smallest, rayleigh_time(table_grains_.diameter[n], table_grains_.density[n],
                                                bed.grains.young_modulus, bed.grains.poisson));
  }
  return table_grains_.size() == 0 ? smallest_rayleigh_time(bed) : smallest;
}

/// 0.2 Rayleigh times changes nothing, 0.3 is measured to be safe, beyond lies silent compaction of the bed.
void Resolver::dem_step() {
  const double rayleigh = rayleigh_time_of_smallest();
  if (is_auto("steps.dem")) {
    inputs_.values["steps.dem"] = significant(0.2 * rayleigh, auto_digits);
  } else {
    take("steps.dem");
  }
  if (!inputs_.has("steps.dem")) return;
  const double dem = number("steps.dem");
  if (dem > 0.3 * rayleigh) {
    problem(
        "steps.dem",
        fmt::format("{:.4g} s is {:.2g} Rayleigh times of the smallest grain ({:.3g} s)", dem, dem / rayleigh,
                    rayleigh),
        fmt::format("at most 0.3 of them: \"{:.2g} s\", or \"auto\" for 0.2", std::floor(0.3 * rayleigh * 1e8) / 1e8));
  }
  if (is_auto("steps.fluid")) {
    inputs_.values["steps.fluid"] = significant(10 * dem, exact_digits);
  } else {
    take("steps.fluid");
  }
  if (inputs_.has("steps.fluid") && number("steps.fluid") < dem)
    problem("steps.fluid", fmt::format("{:.4g} s is shorter than the DEM step of {:.4g} s", number("steps.fluid"), dem),
            "make it a multiple, or \"auto\"");
}

CaseInputs Resolver::run() {
  take_all({"fluid.density", "fluid.viscosity", "grains.diameter", "grains.density", "box.gravity", "box.slope"});
  models();
  measure_in_grains();
  take_all({"grains.spread", "grains.friction", "grains.restitution", "grains.poisson"});
  box();
  if (const auto rolling = setting("grains.rolling_friction"); std::get<double>(rolling->value) != 0)
    problem("grains.rolling_friction",
            fmt::format("{} asks for rolling friction, which is not in this version", rolling->text),
            "rolling_friction = 0.0");
  drive();
  onset();
  take("record.every");
  if (given("record.tracks")) take("record.tracks");
  else inputs_.values["record.tracks"] = std::vector<std::uint64_t>{};
  bed();
  if (problems_.empty() && complete()) {
    stiffness();
    if (inputs_.has("grains.stiffness")) dem_step();
  }
  return inputs_;
}

}   // namespace

double CaseInputs::number(std::string_view key) const { return std::get<double>(values.find(key)->second); }
const std::string& CaseInputs::word(std::string_view key) const {
  return std::get<std::string>(values.find(key)->second);
}

CaseInputs resolve(const Settings& settings, const std::filesystem::path& directory, Problems& problems) {
  return Resolver(settings, directory, problems).run();
}

std::string_view staircase_of(const CaseInputs& inputs) {
  for (const auto table : staircases)
    if (inputs.has(joined(table, "from"))) return table;
  return {};
}

CaseInputs bed_inputs(const CaseInputs& inputs) {
  CaseInputs bed{.values = {}, .csv = inputs.csv, .bed_only = true};
  for (const auto& [key, value] : inputs.values) {
    const bool felt = key.starts_with("fluid.") || key.starts_with("grains.") || key.starts_with("bed.") ||
                      key.starts_with("box.") || key == "steps.dem";
    if (felt && !key.starts_with("box.cell.")) bed.values.emplace(key, value);
  }
  const double d = inputs.number("grains.diameter"), dem = inputs.number("steps.dem");
  bed.values["box.cell.xy"] = std::min({2 * d, inputs.number("box.length"), inputs.number("box.width")});
  bed.values["box.cell.z"] = std::min(0.5 * d, inputs.number("box.height"));
  bed.values["drive.kind"] = "none";
  bed.values["drive.dwell"] = bed.values["record.every"] = bed.values["steps.fluid"] =
      significant(10 * dem, exact_digits);
  bed.values["record.tracks"] = std::vector<std::uint64_t>{};
  bed.values["onset.method"] = "none";
  bed.values["onset.criterion"] = "flux";
  bed.values["onset.value"] = 1e-2;
  bed.values["models.fluid"] = "box";
  bed.values["models.drag"] = "di_felice";
  bed.values["models.terms"] = std::vector<std::string>{"buoyancy", "drag", "pressure_gradient", "viscous_stress"};
  return bed;
}

}   // namespace bedload

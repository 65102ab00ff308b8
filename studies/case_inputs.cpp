// From settings to SI: defaults, grain diameters and grain times, "auto".
#include "studies/case_inputs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "base/error.hpp"
#include "solver/bed/incipient_motion.hpp"
#include "solver/coupling/drag_laws.hpp"
#include "solver/expected_bed.hpp"
#include "solver/grains/bed_packing.hpp"
#include "solver/grains/grain_dynamics.hpp"
#include "solver/required_models.hpp"
#include "studies/input_list.hpp"
#include "studies/properties_by_groups.hpp"
#include "studies/study_keys.hpp"

namespace bedload {

namespace {

constexpr std::string_view ramp_parts[] = {"from", "ratio", "step", "steps"};
constexpr double most_levels = 10'000, most_steps = 0x1p53, most_holds = 100;
constexpr std::string_view staircases[] = {"drive.shields", "drive.speed", "drive.gradient", "drive.push",
                                           "drive.through_flow"};

/// What else than a Shields number the levels of a drive may count.
std::string_view own_staircase(std::string_view kind) {
  return kind == "lid"        ? "drive.speed"
         : kind == "pressure" ? "drive.gradient"
         : kind == "push"     ? "drive.push"
                              : "drive.through_flow";
}
bool takes_shields(std::string_view kind) { return kind == "lid" || kind == "pressure"; }

std::string joined(std::string_view table, std::string_view key) { return fmt::format("{}.{}", table, key); }

/// Resolves one case, key by key, in the order in which keys depend on each other.
class Resolver : InputList {
 public:
  Resolver(const Settings& settings, const std::filesystem::path& directory, Problems& problems,
           const TableReader& read_table)
      : InputList(settings, problems), directory_(directory), read_table_(read_table) {}

  CaseInputs run();

 private:
  bool complete() const;
  void measure_in_grains();
  void box();
  void bed();
  void bed_table();
  void count_from_depth();
  void shear();
  void suspension();
  double mean_grain_volume() const;
  void drive();
  void staircase(std::string_view table);
  void start();
  void take_unless_default(std::string_view key);
  void onset();
  void bisection();
  void models();
  void lengths_or_none();
  void wanted();
  void grains();
  void stiffness();
  void dem_step();
  void duration();
  void samples_of_holds();
  double rayleigh_time_of_smallest() const;

  const std::filesystem::path& directory_;
  const TableReader& read_table_;
  Grains table_grains_;   // of bed.file
};

/// True while nothing that the next steps compute with is missing.
bool Resolver::complete() const {
  constexpr std::string_view needed[] = {"fluid.density", "fluid.viscosity", "grains.diameter", "grains.density",
                                         "box.gravity",   "box.length",      "box.width",       "box.height"};
  return std::ranges::all_of(needed, [&](std::string_view key) { return inputs.has(key); });
}

/// What "d" and "td" are in this case. Grains no heavier than the fluid, or without weight, have no time of their own.
void Resolver::measure_in_grains() {
  diameter_missing = !inputs.has("grains.diameter");
  if (!diameter_missing) scales.diameter = number("grains.diameter");
  for (const auto key : {"fluid.density", "fluid.viscosity", "grains.diameter", "grains.density", "box.gravity"}) {
    if (inputs.has(key)) continue;
    no_grain_time = NoGrainTime{};
    return;
  }
  const double d = number("grains.diameter"), s = number("grains.density") / number("fluid.density"),
               g = number("box.gravity");
  if (s <= 1)
    no_grain_time = {
        given("grains.density_ratio") ? "grains.density_ratio" : "grains.density",
        fmt::format("grains of {} kg/m3 do not settle in a fluid of {} kg/m3 and have no grain time \"td\"",
                    number("grains.density"), number("fluid.density"))};
  else if (g <= 0) no_grain_time = {"box.gravity", "without gravity there is no grain time \"td\""};
  if (no_grain_time) return;
  const auto law = drag_law_named(word("models.drag"));
  scales.time = grain_time(d, s, g, terminal_speed(law, number("fluid.viscosity"), s, d, g));
}

/// A key at the value that stands for its absence is left out: a new key renames no case.
void Resolver::take_unless_default(std::string_view key) {
  const auto fallback = fallback_of(*find_key(key));
  if (given(key) && !(fallback && same_value(*setting(key), *fallback))) take(key);
}

void Resolver::start() {
  take_unless_default("fluid.start");
  const bool vortices = inputs.has("fluid.start");
  if (!vortices) return refuse("fluid.start_speed", "a fluid that starts at rest has no speed");
  if (!given("fluid.start_speed")) return missing("fluid.start_speed", "for example start_speed = \"1 mm/s\"");
  take("fluid.start_speed");
}

void Resolver::box() {
  take_all({"box.length", "box.width", "box.height", "box.cell.z", "box.x", "box.y", "box.z", "box.top"});
  if (word("models.fluid") == "box") take("box.cell.xy");   // layers are as wide as the box
  take_unless_default("box.roughness");
  for (const auto& [cell, edge] :
       {std::pair{"box.cell.xy", "box.length"}, {"box.cell.xy", "box.width"}, {"box.cell.z", "box.height"}}) {
    if (!inputs.has(cell) || !inputs.has(edge) || number(cell) <= number(edge)) continue;
    problem(cell,
            fmt::format("a cell of {:.4g} m is larger than the box ({} is {:.4g} m)", number(cell), edge, number(edge)),
            "at least 3 cells must fit along every edge");
  }
}

void Resolver::bed() {
  take("bed.source");
  const auto& source = word("bed.source");
  const bool packed = source == "poured" || source == "lattice", suspended = source == "suspension";
  if (!packed) refuse("bed.depth", fmt::format("nothing settles with bed.source = \"{}\"", source));
  if (!packed && !suspended)
    for (const auto key : {"bed.count", "bed.seed"})
      refuse(key, fmt::format("nothing is placed with bed.source = \"{}\"", source));
  if (!suspended)
    for (const auto key : {"bed.solid_fraction", "bed.motion"})
      refuse(key, fmt::format("only a suspension has one, and bed.source is \"{}\"", source));
  if (source != "file") refuse("bed.file", fmt::format("no file is read with bed.source = \"{}\"", source));
  if (suspended) suspension();
  if (packed) {
    take("bed.seed");
    if (given("bed.count") && given("bed.depth"))
      return problem("bed.depth", "both count and depth say how much is poured", "keep one of them");
    if (given("bed.depth")) return count_from_depth();
    if (!given("bed.count")) return missing("bed.count", "say how many grains: count = 1500, or depth = \"6 d\"");
    return take("bed.count");
  }
  if (source == "file") bed_table();
}

/// A shear of zero is none, and leaves the case as it is; as an axis it may stand beside others, which have a time.
void Resolver::shear() {
  if (!given("bed.shear.shields")) return refuse("bed.shear.time", "bed.shear.shields is missing, and 0 is no shear");
  take("bed.shear.shields");
  if (number("bed.shear.shields") == 0) inputs.values.erase("bed.shear.shields");
  else take("bed.shear.time");
}

void Resolver::suspension() {
  take("bed.seed");
  take_unless_default("bed.motion");
  if (given("bed.count") == given("bed.solid_fraction"))
    return problem("bed.source", "a suspension wants one of count and solid_fraction",
                   "for example: solid_fraction = 0.2");
  if (given("bed.count")) return take("bed.count");
  take("bed.solid_fraction");
  if (!inputs.has("bed.solid_fraction") || !inputs.has("grains.spread") || !complete()) return;
  const double box = number("box.length") * number("box.width") * number("box.height");
  const double count = std::round(number("bed.solid_fraction") * box / mean_grain_volume());
  inputs.values.erase("bed.solid_fraction");
  if (count < 1) return problem("bed.solid_fraction", "not one grain is so little");
  inputs.values["bed.count"] = count;
}

/// Of a normal distribution of diameters: the mean of d^3 is that of the mean diameter times 1 + 3 spread^2.
double Resolver::mean_grain_volume() const {
  const double spread = number("grains.spread");
  return sphere_volume(number("grains.diameter")) * (1 + 3 * spread * spread);
}

/// Grains that fill the box to a depth, at the solid fraction of a loose packing.
void Resolver::count_from_depth() {
  take("bed.depth");
  if (!inputs.has("bed.depth") || !inputs.has("grains.spread") || !complete()) return;
  const double count = std::round(number("bed.depth") * number("box.length") * number("box.width") * loose_packing /
                                  mean_grain_volume());
  inputs.values.erase("bed.depth");
  if (count < 1) return problem("bed.depth", "not one grain fits into so thin a bed");
  inputs.values["bed.count"] = count;
}

void Resolver::bed_table() {
  take("bed.file");
  if (!no_problems() || !inputs.has("bed.file") || !complete()) return;
  try {
    inputs.csv = read_table_(directory_ / word("bed.file"));
    table_grains_ = place_grains(scene_of(inputs).bed);
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
  take_unless_default("drive.start");
  const auto own = own_staircase(kind);
  const bool fits = found.size() == 1 && (found[0] == own || (found[0] == "drive.shields" && takes_shields(kind)));
  if (fits) return staircase(found[0]);
  if (takes_shields(kind))
    return problem("drive.kind", fmt::format("\"{}\" wants one of drive.shields and {}", kind, own),
                   "for example: shields = { from = 0.06, ratio = 1.2, steps = 12 }");
  problem("drive.kind", fmt::format("\"{}\" wants {} and no other levels", kind, own),
          kind == "push" ? "for example: push = { from = 0.3, step = 0.01, steps = 12 }"
                         : "for example: through_flow = { from = \"1 mm/s\", ratio = 1.2, steps = 12 }");
}

void Resolver::staircase(std::string_view table) {
  const auto from = joined(table, "from"), ratio = joined(table, "ratio"), step = joined(table, "step"),
             steps = joined(table, "steps");
  take(from);
  if (!inputs.has(from)) return;
  if (!given(steps)) inputs.values[steps] = 1.0;
  else take(steps);
  if (given(ratio) && given(step))
    return problem(step, "levels grow by a ratio or by a step, not both", "keep one of them");
  if (given(ratio)) take(ratio);
  if (given(step)) take(step);
  if (inputs.has(ratio) && number(ratio) <= 1)
    problem(ratio, "levels must rise: the ratio of one to the one before is above 1");
  if (number(steps) > 1 && !given(ratio) && !given(step))
    problem(steps, "how the levels grow is missing", "add ratio = 1.2, or step");
  if (number(steps) > most_levels)
    return problem(steps, fmt::format("{:.0f} levels are too many", number(steps)),
                   fmt::format("at most {:.0f}", most_levels));
  const double rises = number(steps) - 1;
  const bool finite = (!inputs.has(ratio) || std::isfinite(number(from) * std::pow(number(ratio), rises))) &&
                      (!inputs.has(step) || std::isfinite(number(from) + rises * number(step)));
  if (!finite) problem(steps, fmt::format("level {:.0f} is too large a number", number(steps)), "fewer steps");
}

/// Model time counts steps: beyond 2^53 of them it would stand still.
void Resolver::duration() {
  const auto table = staircase_of(inputs);
  const double levels = table.empty() ? 1 : number(joined(table, "steps"));
  const double searched = inputs.has("onset.hold") ? most_holds * number("onset.hold") : 0;
  const double sheared = inputs.has("bed.shear.time") ? number("bed.shear.time") : 0;
  const double count = (levels * number("drive.dwell") + searched + sheared) / number("steps.dem");
  if (count <= most_steps) return;
  problem("drive.dwell",
          fmt::format("{:.0f} times {:.3g} s are {:.3g} DEM steps, more than the {:.3g} that a clock can count", levels,
                      number("drive.dwell"), count, most_steps),
          "a shorter dwell, for example \"25 td\"");
}

void Resolver::onset() {
  take_all({"onset.criterion", "onset.value"});
  const bool driven = word("drive.kind") != "none";
  if (given("onset.method")) take("onset.method");
  else inputs.values["onset.method"] = std::string(driven ? "ramp" : "none");
  const std::string& method = word("onset.method");
  if (!driven && method != "none")
    problem("onset.method", fmt::format("a {} needs a drive", method == "ramp" ? "ramp" : "bisection"),
            "set drive.kind, or onset.method = \"none\"");
  for (const auto key : {"onset.bracket", "onset.hold"}) {
    if (method == "bisect") take(key);
    else if (given(key)) refuse(key, "only onset.method = \"bisect\" reads it");
  }
  if (method == "bisect" && driven) bisection();
}

/// Levels of a search lie between those of a staircase, and its holds are judged by their flux.
void Resolver::bisection() {
  if (staircase_of(inputs) != "drive.shields")
    problem("onset.method", "a bisection looks for a Shields number, and wants levels of it",
            "for example: drive.shields = { from = 0.06, ratio = 1.2, steps = 12 }");
  if (word("onset.criterion") != "flux")
    problem("onset.criterion", "a bisection asks whether grains go on moving downstream, which their flux says",
            "onset.criterion = \"flux\"");
}

/// The verdict on a hold compares its thirds, sample by sample: they must be much shorter.
void Resolver::samples_of_holds() {
  constexpr double fewest = 9;   // three to each
  if (!inputs.has("onset.hold")) return;
  const auto shorter = number("drive.dwell") < number("onset.hold") ? "drive.dwell" : "onset.hold";
  if (number("record.every") * fewest <= number(shorter) * (1 + 1e-9)) return;
  problem("record.every",
          fmt::format("{:.3g} s between samples: a search judges holds by them and wants {:g} at least within {} of "
                      "{:.3g} s",
                      number("record.every"), fewest, shorter, number(shorter)),
          fmt::format("\"{:.3g} s\" or less, or longer holds", number(shorter) / fewest));
}

void Resolver::models() {
  if (is_auto("models.fluid")) inputs.values["models.fluid"] = std::string("box");
  else take("models.fluid");
  take("models.drag");
  take_unless_default("models.crowded");
  if (is_auto("models.terms"))
    inputs.values["models.terms"] = std::vector<std::string>{};   // until wanted() knows them
  else take("models.terms");
}

/// Lengths that may be counted in grain diameters. None is none: a case without smoothing keeps its identity.
void Resolver::lengths_or_none() {
  for (const auto key : {"models.smoothing.xy", "models.smoothing.z", "models.frozen_depth"}) {
    if (given(key)) take(key);
    if (inputs.has(key) && number(key) == 0) inputs.values.erase(key);
  }
}

/// "auto": the terms that the scene requires. In the order of read lists, so that the same terms are the same case.
void Resolver::wanted() {
  if (!is_auto("models.terms")) return;
  const auto terms = wanted_terms(scene_of(inputs));
  std::vector<std::string> names;
  for (const auto& [name, term] : named_terms)
    if (terms.*term) names.emplace_back(name);
  std::ranges::sort(names);
  inputs.values["models.terms"] = names;
}

/// Before stiffness and steps are computed from them.
void Resolver::grains() {
  for (const auto& p : grain_problems_of(scene_of(inputs).bed)) problem(p.parameter, p.message, p.hint);
}

void Resolver::stiffness() {
  if (!is_auto("grains.stiffness")) return take("grains.stiffness");
  const auto bed = scene_of(inputs).bed;
  inputs.values["grains.stiffness"] = automatic_young_modulus(bed, bed_layers(bed));
}

double Resolver::rayleigh_time_of_smallest() const {
  const auto bed = scene_of(inputs).bed;
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
    inputs.values["steps.dem"] = significant(0.2 * rayleigh, auto_digits);
  } else {
    take("steps.dem");
  }
  if (!inputs.has("steps.dem")) return;
  const double dem = number("steps.dem");
  take_unless_default("steps.beyond_limit");
  if (!inputs.has("steps.beyond_limit") && dem > 0.3 * rayleigh) {
    problem(
        "steps.dem",
        fmt::format("{:.4g} s is {:.2g} Rayleigh times of the smallest grain ({:.3g} s)", dem, dem / rayleigh,
                    rayleigh),
        fmt::format("at most 0.3 of them: \"{:.2g} s\", or \"auto\" for 0.2", std::floor(0.3 * rayleigh * 1e8) / 1e8));
  }
  if (is_auto("steps.fluid")) {
    inputs.values["steps.fluid"] = significant(10 * dem, exact_digits);
  } else {
    take("steps.fluid");
  }
  if (inputs.has("steps.fluid") && number("steps.fluid") < dem)
    problem("steps.fluid", fmt::format("{:.4g} s is shorter than the DEM step of {:.4g} s", number("steps.fluid"), dem),
            "make it a multiple, or \"auto\"");
}

CaseInputs Resolver::run() {
  take_all({"fluid.density", "box.gravity", "box.slope"});
  take_properties(*this);
  models();
  measure_in_grains();
  take_all({"grains.spread", "grains.friction", "grains.restitution", "grains.poisson"});
  take_unless_default("grains.rolling_friction");
  start();
  box();
  lengths_or_none();
  drive();
  onset();
  take("record.every");
  if (given("record.tracks")) take("record.tracks");
  else inputs.values["record.tracks"] = std::vector<std::uint64_t>{};
  bed();
  shear();
  if (no_problems() && complete()) grains();
  if (no_problems() && complete()) wanted();
  if (no_problems() && complete()) samples_of_holds();
  if (no_problems() && complete()) stiffness();
  if (no_problems() && inputs.has("grains.stiffness")) dem_step();
  if (no_problems() && inputs.has("steps.dem")) duration();
  return inputs;
}

}   // namespace

double CaseInputs::number(std::string_view key) const { return std::get<double>(values.find(key)->second); }
const std::string& CaseInputs::word(std::string_view key) const {
  return std::get<std::string>(values.find(key)->second);
}

CaseInputs resolve(const Settings& settings, const std::filesystem::path& directory, Problems& problems,
                   const TableReader& read_table) {
  return Resolver(settings, directory, problems, read_table).run();
}

std::string_view staircase_of(const CaseInputs& inputs) {
  for (const auto table : staircases)
    if (inputs.has(joined(table, "from"))) return table;
  return {};
}

CaseInputs bed_inputs(const CaseInputs& inputs) {
  CaseInputs bed{.values = {}, .csv = inputs.csv, .bed_only = true};
  for (const auto& [key, value] : inputs.values) {
    if (key.starts_with("bed.shear.")) continue;   // comes after
    const bool felt =
        key.starts_with("fluid.") || key.starts_with("grains.") || key.starts_with("bed.") || key.starts_with("box.");
    if (felt && !key.starts_with("box.cell.")) bed.values.emplace(key, value);
  }
  const double d = inputs.number("grains.diameter"),
               dem = significant(0.2 * smallest_rayleigh_time(scene_of(inputs).bed), auto_digits);
  bed.values["steps.dem"] = dem;   // packing takes steps of its own
  bed.values["box.cell.xy"] = std::min({2 * d, inputs.number("box.length"), inputs.number("box.width")});
  bed.values["box.cell.z"] = std::min(0.5 * d, inputs.number("box.height"));
  bed.values["drive.kind"] = std::string("none");
  bed.values["drive.dwell"] = bed.values["record.every"] = bed.values["steps.fluid"] =
      significant(10 * dem, exact_digits);
  bed.values["record.tracks"] = std::vector<std::uint64_t>{};
  bed.values["onset.method"] = std::string("none");
  bed.values["onset.criterion"] = std::string("flux");
  bed.values["onset.value"] = 1e-2;
  bed.values["models.fluid"] = std::string("box");
  bed.values["models.drag"] = std::string("di_felice");
  bed.values["models.terms"] = std::vector<std::string>{"buoyancy", "drag", "pressure_gradient", "viscous_stress"};
  return bed;
}

}   // namespace bedload

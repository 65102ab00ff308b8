// The table of keys.
#include "studies/study_keys.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <string>
#include <vector>

namespace bedload {

namespace {

using Kind = StudyKey::Kind;
using Range = StudyKey::Range;

/// A quantity greater than zero.
constexpr StudyKey amount(std::string_view path, Dimension dimension, std::string_view label,
                          std::string_view fallback = {}, std::string_view choices = {}) {
  return {path, Kind::quantity, dimension, Range::positive, choices, {}, fallback, true, label};
}
/// A quantity of either sign.
constexpr StudyKey signed_amount(std::string_view path, Dimension dimension, std::string_view label) {
  return {path, Kind::quantity, dimension, Range::any, {}, {}, {}, true, label};
}
constexpr StudyKey number(std::string_view path, Range range, std::string_view label, std::string_view fallback = {}) {
  return {path, Kind::number, dimension::number, range, {}, {}, fallback, true, label};
}
constexpr StudyKey count(std::string_view path, std::string_view label, std::string_view fallback = {},
                         std::string_view choices = {}) {
  return {path, Kind::count, dimension::number, Range::positive, choices, {}, fallback, true, label};
}
constexpr StudyKey word(std::string_view path, std::string_view label, std::string_view choices,
                        std::string_view fallback = {}, std::string_view later = {}) {
  return {path, Kind::word, dimension::number, Range::any, choices, later, fallback, true, label};
}
constexpr StudyKey text(std::string_view path, std::string_view label) {
  return {.path = path, .kind = Kind::text, .label = label};
}
/// No part of a case's identity.
constexpr StudyKey not_physics(StudyKey key) {
  key.physics = false;
  return key;
}

constexpr std::string_view laws = "stokes|schiller_naumann|di_felice|ergun|gidaspow|koch_hill|beetstra|tang|rong";
constexpr std::string_view terms =
    "drag|buoyancy|pressure_gradient|viscous_stress|self_disturbance|added_mass|shear_lift|magnus|viscous_torque|"
    "wall_forces|wet_restitution|lubrication|exposure|turbulence";

constexpr StudyKey keys[] = {
    not_physics(text("name", "")),

    amount("fluid.density", dimension::density, "rhof"),
    amount("fluid.viscosity", dimension::viscosity, "nu"),
    number("fluid.galileo", Range::positive, "Ga"),
    word("fluid.start", "start", "rest|taylor_green", "rest"),
    amount("fluid.start_speed", dimension::speed, "u0"),

    amount("grains.diameter", dimension::length, "d"),
    amount("grains.density", dimension::density, "rho"),
    number("grains.density_ratio", Range::positive, "sg"),
    number("grains.spread", Range::not_negative, "spread", "0.05"),
    number("grains.friction", Range::not_negative, "mu", "0.4"),
    number("grains.restitution", Range::not_negative, "e", "0.6"),
    number("grains.poisson", Range::not_negative, "poisson", "0.3"),
    number("grains.rolling_friction", Range::not_negative, "mur", "0.0"),
    amount("grains.stiffness", dimension::pressure, "E", "auto", "auto"),

    word("bed.source", "bed", "poured|lattice|suspension|file|none", "poured"),
    count("bed.count", "n"),
    amount("bed.depth", dimension::length, "depth"),
    number("bed.solid_fraction", Range::positive, "phi"),
    word("bed.motion", "motion", "free|fixed", "free"),
    text("bed.file", "file"),
    number("bed.shear.shields", Range::not_negative, "shear", "0"),
    amount("bed.shear.time", dimension::time, "sheared", "100 td"),
    count("bed.seed", "s", "1"),

    amount("box.length", dimension::length, "L"),
    amount("box.width", dimension::length, "W"),
    amount("box.height", dimension::length, "H"),
    amount("box.cell.xy", dimension::length, "hxy", "2 d"),
    amount("box.cell.z", dimension::length, "hz", "0.5 d"),
    word("box.x", "x", "periodic|wall", "periodic"),
    word("box.y", "y", "periodic|wall", "periodic"),
    word("box.z", "z", "periodic|wall", "wall"),
    word("box.top", "top", "lid|free-slip", "lid"),
    {"box.roughness", Kind::quantity, dimension::length, Range::not_negative, {}, {}, "0 m", true, "ks"},
    {"box.gravity", Kind::quantity, dimension::acceleration, Range::not_negative, {}, {}, "9.81 m/s2", true, "g"},
    {"box.slope", Kind::quantity, dimension::angle, Range::any, {}, {}, "0 deg", true, "slope"},

    word("drive.kind", "drive", "lid|pressure|push|through_flow|none", "none"),
    word("drive.start", "begin", "developed|rest", "developed"),
    number("drive.shields.from", Range::positive, "theta"),
    number("drive.shields.ratio", Range::positive, "ratio"),
    number("drive.shields.step", Range::positive, "dtheta"),
    not_physics(count("drive.shields.steps", "")),
    signed_amount("drive.speed.from", dimension::speed, "U"),
    number("drive.speed.ratio", Range::positive, "ratio"),
    signed_amount("drive.speed.step", dimension::speed, "dU"),
    not_physics(count("drive.speed.steps", "")),
    signed_amount("drive.gradient.from", dimension::pressure_gradient, "G"),
    number("drive.gradient.ratio", Range::positive, "ratio"),
    signed_amount("drive.gradient.step", dimension::pressure_gradient, "dG"),
    not_physics(count("drive.gradient.steps", "")),
    number("drive.push.from", Range::positive, "F"),
    number("drive.push.ratio", Range::positive, "ratio"),
    number("drive.push.step", Range::positive, "dF"),
    not_physics(count("drive.push.steps", "")),
    signed_amount("drive.through_flow.from", dimension::speed, "q"),
    number("drive.through_flow.ratio", Range::positive, "ratio"),
    signed_amount("drive.through_flow.step", dimension::speed, "dq"),
    not_physics(count("drive.through_flow.steps", "")),
    amount("drive.dwell", dimension::time, "dwell", "25 td"),

    word("onset.method", "onset", "ramp|bisect|none"),
    number("onset.bracket", Range::positive, "bracket", "0.04"),
    amount("onset.hold", dimension::time, "hold", "100 td"),
    not_physics(amount("onset.interval", dimension::number, "")),
    not_physics(count("onset.batch", "", "4")),
    {.path = "onset.budget", .kind = Kind::words, .choices = "bracket|hold|mesh|area", .physics = false},
    not_physics(word("onset.criterion", "", "flux|moving_fraction", "flux")),
    not_physics(number("onset.value", Range::positive, "", "1e-2")),

    word("models.fluid", "fluid", "auto|profile|column|box", "auto"),
    word("models.drag", "drag", laws, "di_felice"),
    {"models.smoothing.xy", Kind::quantity, dimension::length, Range::not_negative, {}, {}, "0 m", true, "sxy"},
    {"models.smoothing.z", Kind::quantity, dimension::length, Range::not_negative, {}, {}, "0 m", true, "sz"},
    {"models.frozen_depth", Kind::quantity, dimension::length, Range::not_negative, {}, {}, "0 m", true, "frozen"},
    number("models.crowded", Range::positive, "crowded", "0.04"),
    {"models.terms", Kind::words, dimension::number, Range::any, terms, {}, "auto", true, "terms"},
    not_physics(amount("models.accuracy.target", dimension::number, "")),
    not_physics(text("models.accuracy.from", "")),
    {.path = "models.strict", .kind = Kind::flag, .fallback = "false", .physics = false},

    amount("steps.dem", dimension::time, "dt", "auto", "auto"),
    amount("steps.fluid", dimension::time, "T", "auto", "auto"),
    {.path = "steps.beyond_limit", .kind = Kind::flag, .fallback = "false"},

    amount("record.every", dimension::time, "every", "1 td"),
    {.path = "record.tracks", .kind = Kind::ids, .label = "tracks"},

    not_physics(word("run.executor", "", "process", "process", "slurm")),
    not_physics(count("run.ranks", "", "1")),
    not_physics(count("run.cores", "", "all", "all")),
    not_physics(amount("run.checkpoint.every", dimension::time, "", "5 min")),
    not_physics(count("run.checkpoint.keep", "", "2")),
    not_physics(amount("run.stall_limit", dimension::time, "", "10 min")),
};

struct LaterKey {
  std::string_view path, what;
};
constexpr LaterKey later_keys[] = {
    {"models.turbulence", "turbulence closures"},
    {"run.wall_limit", "a wall time limit per attempt"},
    {"run.slurm", "running through Slurm"},
};

char in_lower_case(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

std::string_view last_part(std::string_view path) { return path.substr(path.rfind('.') + 1); }

/// Levenshtein distance, whatever the case of the letters.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const auto substituted = diagonal + (in_lower_case(a[i]) == in_lower_case(b[j]) ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substituted, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

/// Keeps the candidate nearest to a misspelling, if it is near: at most a third of the letters of its last part differ, and at
/// most three. Farther words are other words.
class Nearest {
 public:
  explicit Nearest(std::string_view misspelt)
      : misspelt_(misspelt), best_(std::clamp<std::size_t>(last_part(misspelt).size() / 3, 1, 3) + 1) {}
  void consider(std::string_view candidate) {
    const auto distance = edit_distance(misspelt_, candidate);
    if (distance < best_) best_ = distance, nearest_ = candidate;
  }
  std::string_view get() const { return nearest_; }

 private:
  std::string_view misspelt_, nearest_;
  std::size_t best_;
};

std::vector<std::string_view> split(std::string_view words) {
  std::vector<std::string_view> parts;
  while (!words.empty()) {
    const auto end = std::min(words.find('|'), words.size());
    parts.push_back(words.substr(0, end));
    words.remove_prefix(std::min(end + 1, words.size()));
  }
  return parts;
}

}   // namespace

std::span<const StudyKey> study_keys() { return keys; }

const StudyKey* find_key(std::string_view path) {
  const auto found = std::ranges::find(keys, path, &StudyKey::path);
  return found == std::end(keys) ? nullptr : &*found;
}

std::optional<Setting> fallback_of(const StudyKey& key) {
  const std::string text(key.fallback);
  if (text.empty()) return std::nullopt;
  if (key.kind == Kind::number || (key.kind == Kind::count && !is_one_of(text, key.choices)))
    return Setting{std::stod(text), text, {}};
  if (key.kind == Kind::quantity && !is_one_of(text, key.choices))
    return Setting{parse_quantity(text, key.dimension), text, {}};
  return Setting{text, text, {}};
}

bool is_table(std::string_view path) {
  return std::ranges::any_of(keys, [&](const StudyKey& key) {
    return key.path.size() > path.size() && key.path.starts_with(path) && key.path[path.size()] == '.';
  });
}

std::string_view later_key(std::string_view path) {
  const auto found = std::ranges::find(later_keys, path, &LaterKey::path);
  return found == std::end(later_keys) ? std::string_view() : found->what;
}

std::string_view nearest_key(std::string_view path) {
  Nearest nearest(path);
  for (const auto& key : keys) {
    nearest.consider(key.path);
    for (auto dot = key.path.find('.'); dot != key.path.npos; dot = key.path.find('.', dot + 1))
      nearest.consider(key.path.substr(0, dot));
  }
  return nearest.get();
}

std::string keys_beside(std::string_view path) {
  const auto table = path.substr(0, path.rfind('.') + 1);   // "drive.shields.", or nothing
  std::vector<std::string_view> names;
  if (table.empty()) names = {"format"};
  for (const auto& key : keys) {
    if (!key.path.starts_with(table)) continue;
    const auto rest = key.path.substr(table.size()), name = rest.substr(0, rest.find('.'));
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
  if (table.empty()) names.push_back("exclude");
  std::string list;
  for (const auto name : names) list.append(list.empty() ? "" : ", ").append(name);
  return list;
}

std::string_view nearest_word(std::string_view word, std::string_view choices) {
  Nearest nearest(word);
  for (const auto choice : split(choices)) nearest.consider(choice);
  return nearest.get();
}

bool is_one_of(std::string_view word, std::string_view choices) {
  const auto words = split(choices);
  return std::ranges::find(words, word) != words.end();
}

}   // namespace bedload

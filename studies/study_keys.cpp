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

constexpr std::string_view later_terms =
    "added_mass|shear_lift|magnus|lubrication|viscous_torque|self_disturbance|wall_drag|turbulence";

// clang-format off
constexpr StudyKey keys[] = {
    {.path = "name", .kind = Kind::text, .physics = false},

    {.path = "fluid.density", .kind = Kind::quantity, .dimension = dimension::density, .range = Range::positive, .label = "rhof"},
    {.path = "fluid.viscosity", .kind = Kind::quantity, .dimension = dimension::viscosity, .range = Range::positive, .label = "nu"},

    {.path = "grains.diameter", .kind = Kind::quantity, .dimension = dimension::length, .range = Range::positive, .label = "d"},
    {.path = "grains.density", .kind = Kind::quantity, .dimension = dimension::density, .range = Range::positive, .label = "rho"},
    {.path = "grains.spread", .range = Range::not_negative, .fallback = "0.05", .label = "spread"},
    {.path = "grains.friction", .range = Range::not_negative, .fallback = "0.4", .label = "mu"},
    {.path = "grains.restitution", .range = Range::positive, .fallback = "0.6", .label = "e"},
    {.path = "grains.poisson", .range = Range::not_negative, .fallback = "0.3", .label = "poisson"},
    {.path = "grains.rolling_friction", .range = Range::not_negative, .fallback = "0.0", .label = "mur"},
    {.path = "grains.stiffness", .kind = Kind::quantity, .dimension = dimension::pressure, .range = Range::positive, .choices = "auto", .fallback = "auto", .label = "E"},

    {.path = "bed.source", .kind = Kind::word, .choices = "poured|lattice|file|none", .fallback = "poured", .label = "bed"},
    {.path = "bed.count", .kind = Kind::count, .range = Range::positive, .label = "n"},
    {.path = "bed.depth", .kind = Kind::quantity, .dimension = dimension::length, .range = Range::positive, .label = "depth"},
    {.path = "bed.file", .kind = Kind::text, .label = "file"},
    {.path = "bed.seed", .kind = Kind::count, .range = Range::positive, .fallback = "1", .label = "s"},

    {.path = "box.length", .kind = Kind::quantity, .dimension = dimension::length, .range = Range::positive, .label = "L"},
    {.path = "box.width", .kind = Kind::quantity, .dimension = dimension::length, .range = Range::positive, .label = "W"},
    {.path = "box.height", .kind = Kind::quantity, .dimension = dimension::length, .range = Range::positive, .label = "H"},
    {.path = "box.cell.xy", .kind = Kind::quantity, .dimension = dimension::length, .range = Range::positive, .fallback = "2 d", .label = "hxy"},
    {.path = "box.cell.z", .kind = Kind::quantity, .dimension = dimension::length, .range = Range::positive, .fallback = "0.5 d", .label = "hz"},
    {.path = "box.x", .kind = Kind::word, .choices = "periodic|wall", .fallback = "periodic", .label = "x"},
    {.path = "box.y", .kind = Kind::word, .choices = "periodic|wall", .fallback = "periodic", .label = "y"},
    {.path = "box.z", .kind = Kind::word, .choices = "periodic|wall", .fallback = "wall", .label = "z"},
    {.path = "box.top", .kind = Kind::word, .choices = "lid|free-slip", .fallback = "lid", .label = "top"},
    {.path = "box.gravity", .kind = Kind::quantity, .dimension = dimension::acceleration, .range = Range::not_negative, .fallback = "9.81 m/s2", .label = "g"},
    {.path = "box.slope", .kind = Kind::quantity, .dimension = dimension::angle, .fallback = "0 deg", .label = "slope"},

    {.path = "drive.kind", .kind = Kind::word, .choices = "lid|pressure|none", .fallback = "none", .label = "drive"},
    {.path = "drive.shields.from", .range = Range::positive, .label = "theta"},
    {.path = "drive.shields.ratio", .range = Range::positive, .label = "ratio"},
    {.path = "drive.shields.step", .range = Range::positive, .label = "dtheta"},
    {.path = "drive.shields.steps", .kind = Kind::count, .range = Range::positive, .physics = false},
    {.path = "drive.speed.from", .kind = Kind::quantity, .dimension = dimension::speed, .label = "U"},
    {.path = "drive.speed.ratio", .range = Range::positive, .label = "ratio"},
    {.path = "drive.speed.step", .kind = Kind::quantity, .dimension = dimension::speed, .label = "dU"},
    {.path = "drive.speed.steps", .kind = Kind::count, .range = Range::positive, .physics = false},
    {.path = "drive.gradient.from", .kind = Kind::quantity, .dimension = dimension::pressure_gradient, .label = "G"},
    {.path = "drive.gradient.ratio", .range = Range::positive, .label = "ratio"},
    {.path = "drive.gradient.step", .kind = Kind::quantity, .dimension = dimension::pressure_gradient, .label = "dG"},
    {.path = "drive.gradient.steps", .kind = Kind::count, .range = Range::positive, .physics = false},
    {.path = "drive.dwell", .kind = Kind::quantity, .dimension = dimension::time, .range = Range::positive, .fallback = "25 td", .label = "dwell"},

    {.path = "onset.method", .kind = Kind::word, .choices = "ramp|none", .later = "bisect", .label = "onset"},
    {.path = "onset.criterion", .kind = Kind::word, .choices = "flux|moving_fraction", .fallback = "flux", .physics = false},
    {.path = "onset.value", .range = Range::positive, .fallback = "1e-2", .physics = false},

    {.path = "models.fluid", .kind = Kind::word, .choices = "auto|box", .later = "profile|column", .fallback = "auto", .label = "fluid"},
    {.path = "models.drag", .kind = Kind::word, .choices = "stokes|schiller_naumann|di_felice",
     .later = "oseen|brown_lawler|dallavalle|rong|wen_yu|ergun|gidaspow_ergun_wen_yu|beetstra|tenneti|tang", .fallback = "di_felice", .label = "drag"},
    {.path = "models.terms", .kind = Kind::words, .choices = "drag|buoyancy|pressure_gradient|viscous_stress", .later = later_terms, .fallback = "auto", .label = "terms"},

    {.path = "steps.dem", .kind = Kind::quantity, .dimension = dimension::time, .range = Range::positive, .choices = "auto", .fallback = "auto", .label = "dt"},
    {.path = "steps.fluid", .kind = Kind::quantity, .dimension = dimension::time, .range = Range::positive, .choices = "auto", .fallback = "auto", .label = "T"},

    {.path = "record.every", .kind = Kind::quantity, .dimension = dimension::time, .range = Range::positive, .fallback = "1 td", .label = "every"},
    {.path = "record.tracks", .kind = Kind::ids, .label = "tracks"},

    {.path = "run.executor", .kind = Kind::word, .choices = "process", .later = "slurm", .fallback = "process", .physics = false},
    {.path = "run.ranks", .kind = Kind::count, .range = Range::positive, .fallback = "1", .physics = false},
    {.path = "run.cores", .kind = Kind::count, .range = Range::positive, .choices = "all", .fallback = "all", .physics = false},
    {.path = "run.checkpoint.every", .kind = Kind::quantity, .dimension = dimension::time, .range = Range::positive, .fallback = "5 min", .physics = false},
    {.path = "run.checkpoint.keep", .kind = Kind::count, .range = Range::positive, .fallback = "2", .physics = false},
    {.path = "run.stall_limit", .kind = Kind::quantity, .dimension = dimension::time, .range = Range::positive, .fallback = "10 min", .physics = false},
};
// clang-format on

struct LaterKey {
  std::string_view path, what;
};
constexpr LaterKey later_keys[] = {
    {"models.accuracy", "settings chosen by a measured accuracy"},
    {"models.turbulence", "turbulence closures"},
    {"onset.bracket", "bisection to a bracket"},
    {"run.wall_limit", "a wall time limit per attempt"},
    {"run.slurm", "running through Slurm"},
};

/// Levenshtein distance.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const auto substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substituted, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

/// Keeps the candidate nearest to a misspelling, if it is near: at most a third of the letters differ.
class Nearest {
 public:
  explicit Nearest(std::string_view misspelt) : misspelt_(misspelt), best_(misspelt.size() / 3 + 1) {}
  void consider(std::string_view candidate) {
    const auto distance = edit_distance(misspelt_, candidate);
    if (distance < best_ || (distance == best_ && nearest_.empty())) best_ = distance, nearest_ = candidate;
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

}  // namespace

std::span<const StudyKey> study_keys() { return keys; }

const StudyKey* find_key(std::string_view path) {
  const auto found = std::ranges::find(keys, path, &StudyKey::path);
  return found == std::end(keys) ? nullptr : &*found;
}

std::optional<Setting> fallback_of(const StudyKey& key) {
  const std::string text(key.fallback);
  if (text.empty()) return std::nullopt;
  if (key.kind == Kind::number || (key.kind == Kind::count && !is_one_of(text, key.choices))) return Setting{std::stod(text), text, {}};
  if (key.kind == Kind::quantity && !is_one_of(text, key.choices)) return Setting{parse_quantity(text, key.dimension), text, {}};
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

std::string_view nearest_word(std::string_view word, std::string_view choices) {
  Nearest nearest(word);
  for (const auto choice : split(choices)) nearest.consider(choice);
  return nearest.get();
}

bool is_one_of(std::string_view word, std::string_view choices) {
  const auto words = split(choices);
  return std::ranges::find(words, word) != words.end();
}

}  // namespace bedload

#include "studies/variation.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "studies/study_keys.hpp"

namespace bedload {

namespace {

struct Change {
  std::string_view key;
  double factor;
};

/// A pair of the budget: which settings are multiplied by how much.
struct Pair {
  std::string_view name;
  std::vector<Change> changes;
};

const std::array<Pair, 4>& pairs() {
  static const std::array<Pair, 4> all{{
      {"bracket", {{"onset.bracket", 0.25}}},
      {"hold", {{"onset.hold", 3}}},
      {"mesh", {{"box.cell.z", 2}}},
      {"area", {{"box.length", 2}, {"box.width", 2}, {"bed.count", 4}}},
  }};
  return all;
}

/// The setting, or what stands for it, so many times; nothing where that is no number.
std::optional<Setting> times(const Settings& settings, const Change& change) {
  const auto found = settings.find(change.key);
  auto setting = found != settings.end() ? std::optional(found->second) : fallback_of(*find_key(change.key));
  if (!setting) return {};
  if (auto* number = std::get_if<double>(&setting->value)) *number *= change.factor;
  else if (auto* quantity = std::get_if<Quantity>(&setting->value)) quantity->value *= change.factor;
  else return {};
  setting->text = fmt::format("{} x {}", setting->text, change.factor);
  if (auto* quantity = std::get_if<Quantity>(&setting->value)) quantity->text = setting->text;
  return setting;
}

bool bed_from_a_table(const Settings& settings) {
  const auto source = settings.find("bed.source");
  return source != settings.end() && source->second.text == "file";
}

}   // namespace

std::vector<Variation> budget_pairs(const Settings& settings, const std::vector<std::string>& wanted) {
  std::vector<Variation> made;
  for (const Pair& pair : pairs()) {
    if (std::ranges::find(wanted, pair.name) == wanted.end()) continue;
    if (pair.name == "area" && bed_from_a_table(settings)) continue;   // there are no more grains than those
    Variation variation{std::string(pair.name), {}};
    for (const Change& change : pair.changes)
      if (auto setting = times(settings, change)) variation.changes[std::string(change.key)] = std::move(*setting);
    if (!variation.changes.empty()) made.push_back(std::move(variation));
  }
  return made;
}

}   // namespace bedload

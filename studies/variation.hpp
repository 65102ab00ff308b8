// Cases that differ from another of the same study in one respect, to measure what that does.
#pragma once

#include <string>
#include <vector>

#include "studies/setting.hpp"

namespace bedload {

/// What is changed in the settings of a case, and what the change is called in labels and tables.
struct Variation {
  std::string name;
  Settings changes;
};

/// Packings of the first scene of a study that are run as pairs: one alone tells chance from error nowhere.
constexpr int budget_packings = 3;

/// The pairs of an error budget: `bracket` a quarter as wide, `hold` three times as long, `mesh` with cells twice as high,
/// `area` with a bed twice as long and twice as wide. Those among `wanted` that the settings have a number for.
std::vector<Variation> budget_pairs(const Settings&, const std::vector<std::string>& wanted);

}   // namespace bedload

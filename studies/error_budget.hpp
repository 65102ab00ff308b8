// What a threshold hangs on beside the packing: differences between paired runs, as the error of a campaign.
#pragma once

#include <string>
#include <vector>

#include "scheduler/database.hpp"

namespace bedload {

struct Case;

/// One pair that has finished: the case of the study, and the same packing with one thing changed.
struct BudgetEntry {
  std::string source;       // bracket | hold | mesh | area
  std::string label;        // of the case of the study
  double difference = 0;    // of theta_c, relative to the case of the study; nan where one of them is censored [-]
  double uncertainty = 0;   // half the brackets of both, relative: a difference below it is a bound [-]
  /// What the source may be worth: the difference, or what it would have to exceed to be seen [-].
  double size() const;
};

/// Keeps in the database which cases are variations of which.
void store_variations(Database&, const std::vector<Case>&);

/// The pairs of which both cases have finished, by source.
std::vector<BudgetEntry> error_budget(const Database&);

/// Square root of the sum of the squares of all sizes; nan as long as the mesh is not among them.
double systematic_error(const std::vector<BudgetEntry>&);

/// "mesh x 2 +12 %, hold x 3 < 3 %; together 12 % (of seed 1, d0.5mm-s1)", or "mesh not tested".
std::string budget_in_words(const std::vector<BudgetEntry>&);

}   // namespace bedload

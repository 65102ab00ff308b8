// What a threshold hangs on beside the packing: differences between paired runs, as the error of a campaign.
#pragma once

#include <string>
#include <vector>

#include "scheduler/database.hpp"
#include "studies/paired_difference.hpp"

namespace bedload {

struct Case;

/// One source of error: the pairs that have finished, each a case of the study and the same packing with one thing changed.
struct BudgetEntry {
  std::string source;           // bracket | hold | mesh | area
  std::string label;            // of the scene
  std::size_t packings = 0;     // with a threshold of both
  PairedDifference theta;       // of theta_c, relative; nan where every pair has a censored case [-]
  bool scatter_known = false;   // some source has two packings or more: chance is in the uncertainty
};

/// Keeps in the database which cases are variations of which.
void store_variations(Database&, const std::vector<Case>&);

/// The sources of which pairs have finished. How far the differences of a source scatter from packing to packing is taken from all
/// sources together: three packings say little of it.
std::vector<BudgetEntry> error_budget(const Database&);

/// Writes them into table error_sources, in place of what is there.
void store_error_sources(Database&);

/// Square root of the sum of the squares of all differences, or of the bounds of what is not seen; nan as long as the mesh is not among them.
double systematic_error(const std::vector<BudgetEntry>&);

/// "hold x 3 < 9 %, mesh x 2 +22 %; together 24 % (3 packings of d0.5mm)", or "mesh not tested".
std::string budget_in_words(const std::vector<BudgetEntry>&);

}   // namespace bedload

// A few combinations of many factors in which any two of them meet at every level.
#pragma once

#include <vector>

namespace bedload {

/// Rows of level indices, one per factor, in which every pair of levels of two factors occurs. Greedy, without chance.
std::vector<std::vector<int>> covering_pairs(const std::vector<int>& levels);

}   // namespace bedload

// Row by row: each begins with the first pair that is still open, then takes the levels that close most pairs, factor after
// factor, ties to the lowest level.
#include "studies/covering_pairs.hpp"

#include <algorithm>
#include <array>
#include <set>

namespace bedload {
namespace {

using Pair = std::array<int, 4>;   // two factors, the lower one first, and a level of each
using Row = std::vector<int>;      // a level per factor

constexpr int not_set = -1;

Pair pair_of(const Row& row, int a, int b) {
  if (a > b) std::swap(a, b);
  return {a, b, row[a], row[b]};
}

std::set<Pair> all_pairs(const std::vector<int>& levels) {
  const int factors = static_cast<int>(levels.size());
  std::set<Pair> pairs;
  for (int a = 0; a < factors; ++a)
    for (int b = a + 1; b < factors; ++b)
      for (int of_a = 0; of_a < levels[a]; ++of_a)
        for (int of_b = 0; of_b < levels[b]; ++of_b) pairs.insert({a, b, of_a, of_b});
  return pairs;
}

/// Of `levels` levels of a factor, the one that closes most open pairs with the factors that are set.
int best_level(Row row, int factor, int levels, const std::set<Pair>& open) {
  int best = 0;
  std::ptrdiff_t most = -1;
  for (row[factor] = 0; row[factor] < levels; ++row[factor]) {
    std::ptrdiff_t closed = 0;
    for (int other = 0; other < static_cast<int>(row.size()); ++other)
      if (other != factor && row[other] != not_set) closed += open.contains(pair_of(row, factor, other));
    if (closed > most) most = closed, best = row[factor];
  }
  return best;
}

}   // namespace

std::vector<std::vector<int>> covering_pairs(const std::vector<int>& levels) {
  const int factors = static_cast<int>(levels.size());
  std::set<Pair> open = all_pairs(levels);
  std::vector<Row> rows;
  while (!open.empty()) {
    Row row(levels.size(), not_set);
    const auto [a, b, of_a, of_b] = *open.begin();
    row[a] = of_a, row[b] = of_b;
    for (int f = 0; f < factors; ++f)
      if (row[f] == not_set) row[f] = best_level(row, f, levels[f], open);
    for (int f = 0; f < factors; ++f)
      for (int g = f + 1; g < factors; ++g) open.erase(pair_of(row, f, g));
    rows.push_back(row);
  }
  return rows;
}

}   // namespace bedload

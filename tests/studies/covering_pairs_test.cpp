// Every pair of levels occurs, in few rows, always the same.
#include "studies/covering_pairs.hpp"

#include <gtest/gtest.h>

#include <array>
#include <set>

namespace bedload {
namespace {

TEST(CoveringPairs, HaveEveryPairOfLevelsOfTwoFactors) {
  const std::vector<int> levels = {4, 4, 3, 3, 3, 2, 2};
  const auto rows = covering_pairs(levels);
  std::size_t wanted = 0;
  std::set<std::array<int, 4>> seen;
  for (int a = 0; a < 7; ++a)
    for (int b = a + 1; b < 7; ++b) wanted += static_cast<std::size_t>(levels[a] * levels[b]);
  for (const auto& row : rows)
    for (int a = 0; a < 7; ++a) {
      ASSERT_GE(row[a], 0);
      ASSERT_LT(row[a], levels[a]);
      for (int b = a + 1; b < 7; ++b) seen.insert({a, row[a], b, row[b]});
    }
  EXPECT_EQ(seen.size(), wanted);
  EXPECT_LE(rows.size(), 24u);   // 16 at least: the two factors of four levels
  EXPECT_EQ(rows, covering_pairs(levels));
}

}   // namespace
}   // namespace bedload

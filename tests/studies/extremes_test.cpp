// The matrix of the extremes: what it consists of, and that its verdict can be wrong.
#include "studies/extremes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
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

TEST(ExtremeScenes, AreAboutEightyAndTheShortFormIsAPartOfThem) {
  const auto all = extreme_scenes(false), part = extreme_scenes(true);
  EXPECT_GE(all.size(), 75u);
  std::set<std::string> names;
  for (const auto& scene : all) EXPECT_TRUE(names.insert(scene.base + ": " + scene.name).second) << scene.name;
  for (const auto& scene : part) EXPECT_TRUE(names.contains(scene.base + ": " + scene.name));
  EXPECT_LT(part.size(), all.size() / 2);
}

ExtremeRow right_row() {
  ExtremeRow row;
  row.outcome = Outcome::finished;
  row.resumed_is_straight = row.all_finite = true;
  return row;
}

TEST(ExtremeRow, IsWrongByEachOfItsBooks) {
  EXPECT_EQ(right_row().wrong(), "");
  const auto wrong = [](auto&& spoil) {
    ExtremeRow row = right_row();
    spoil(row);
    return !row.wrong().empty();
  };
  EXPECT_TRUE(wrong([](ExtremeRow& r) { r.outcome = Outcome::failed; }));
  EXPECT_TRUE(wrong([](ExtremeRow& r) { r.scene.expected = Outcome::refused; }));
  EXPECT_TRUE(wrong([](ExtremeRow& r) { r.all_finite = false; }));
  EXPECT_TRUE(wrong([](ExtremeRow& r) { r.resumed_is_straight = false; }));
  EXPECT_TRUE(wrong([](ExtremeRow& r) { r.books.grains_unchanged = false; }));
  EXPECT_TRUE(wrong([](ExtremeRow& r) { r.books.fluid_volume = 2e-10; }));
  EXPECT_TRUE(wrong([](ExtremeRow& r) { r.books.momentum = 2e-10; }));
  EXPECT_TRUE(wrong([](ExtremeRow& r) { r.books.momentum = std::nan(""); }));
  EXPECT_TRUE(wrong([](ExtremeRow& r) { r.books.energy = 0.02; }));
  EXPECT_TRUE(wrong([](ExtremeRow& r) { r.books.divergence = 2e-8; }));
  EXPECT_FALSE(wrong([](ExtremeRow& r) { r.books.divergence = 2e-8, r.books.mobile = true; }));
}

TEST(ExtremeScenes, ThatMustBeRefusedAreRefusedWithAWord) {
  for (const auto& scene : extreme_scenes(true)) {
    if (scene.expected != Outcome::refused) continue;
    const ExtremeRow row = run_extreme(scene);
    EXPECT_EQ(row.wrong(), "") << scene.name << ": " << row.message;
    EXPECT_FALSE(scene.why.empty()) << scene.name;
  }
}

}   // namespace
}   // namespace bedload

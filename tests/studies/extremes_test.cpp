// The matrix of the extremes: what it consists of, and that its verdict can be wrong.
#include "studies/extremes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace bedload {
namespace {

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
  row.grains = 160, row.steps = 400;
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
  EXPECT_TRUE(wrong([](ExtremeRow& r) { r.grains = 501; }));
  EXPECT_TRUE(wrong([](ExtremeRow& r) { r.steps = 199; }));
  EXPECT_TRUE(wrong([](ExtremeRow& r) { r.steps = 2001; }));
  EXPECT_TRUE(wrong([](ExtremeRow& r) { r.resumed_is_straight = false; }));
  EXPECT_TRUE(wrong([](ExtremeRow& r) { r.books.grains_unchanged = false; }));
  EXPECT_TRUE(wrong([](ExtremeRow& r) { r.books.fluid_volume = 2e-10; }));
  EXPECT_TRUE(wrong([](ExtremeRow& r) { r.books.momentum = 2e-10; }));
  EXPECT_TRUE(wrong([](ExtremeRow& r) { r.books.momentum = std::nan(""); }));
  EXPECT_TRUE(wrong([](ExtremeRow& r) { r.books.energy = 0.02; }));
  EXPECT_TRUE(wrong([](ExtremeRow& r) { r.books.divergence = 2e-8; }));
  EXPECT_FALSE(wrong([](ExtremeRow& r) { r.books.divergence = 2e-8, r.books.mobile = true; }));
}

TEST(ExtremeScenes, TakeAsManyStepsAsTheyAreToWhateverLimitsThese) {
  const std::string few = "bed.count = 40\n", large = few + "grains.diameter = \"20 mm\"",
                    syrup = few + "grains.diameter = \"20 um\"\nfluid.viscosity = \"1e-2 m2/s\"";
  for (const auto& [base, overrides] : {std::pair{"extremes-laminar", large}, {"extremes-water", syrup}}) {
    const ExtremeRow row = run_extreme({.name = overrides, .base = base, .overrides = overrides, .steps = 200});
    EXPECT_EQ(row.steps, 200u) << base << ": " << overrides << ": " << row.message;
    EXPECT_EQ(row.wrong(), "") << base << ": " << overrides;
  }
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

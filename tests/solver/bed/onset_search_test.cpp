#include "solver/bed/onset_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace bedload {
namespace {

constexpr double endless = std::numeric_limits<double>::infinity();

OnsetSearchPlan plan_of(double bracket = 0.04) {
  OnsetSearchPlan plan;
  for (double level = 0.06; plan.staircase.size() < 12; level *= 1.2) plan.staircase.push_back(level);
  plan.bracket = bracket;
  plan.stair = 20, plan.hold = 100;
  return plan;
}

using Bed = std::function<HoldVerdict(HoldPurpose, double level, int before)>;   // before: holds of this level in a row

struct Found {
  std::vector<JudgedHold> holds;
  std::vector<PlannedHold> planned;
  double grain_times = 0;
  LevelBracket onset() const { return bracket_of(holds, HoldPurpose::onset); }
  LevelBracket stop() const { return bracket_of(holds, HoldPurpose::stop); }
};

Found search(const OnsetSearchPlan& plan, const Bed& bed) {
  Found found;
  int in_a_row = 0;
  while (const auto next = next_hold(plan, found.holds)) {
    in_a_row = !found.planned.empty() && !next->from_settled && found.planned.back().level == next->level &&
                       found.planned.back().purpose == next->purpose
                   ? in_a_row + 1
                   : 0;
    found.planned.push_back(*next);
    found.grain_times += next->duration;
    found.holds.push_back({next->purpose, next->level, bed(next->purpose, next->level, in_a_row)});
    if (found.holds.size() > 400) ADD_FAILURE() << "the search does not end";
    if (found.holds.size() > 400) break;
  }
  return found;
}

/// Moves from rest at `begins`, comes to rest below `stops`.
Bed sharp(double begins, double stops) {
  return [=](HoldPurpose purpose, double level, int) {
    return level >= (purpose == HoldPurpose::stop ? stops : begins) ? HoldVerdict::mobile : HoldVerdict::arrested;
  };
}

/// Eight gaps of a bracket of 4 % make a stair of 1.2: a sixteenth of it puts each level between two others.
TEST(OnsetSearch, TriesLevelsOfItsOwnWhereItIsShifted) {
  for (const double begins : {0.0999, 0.1411, 0.2}) {
    OnsetSearchPlan shifted = plan_of();
    shifted.shift = 1.0 / 16;
    const LevelBracket a = search(plan_of(), sharp(begins, begins)).onset(),
                       b = search(shifted, sharp(begins, begins)).onset();
    for (const LevelBracket& found : {a, b}) {
      EXPECT_LT(found.lower, begins);
      EXPECT_GE(found.upper, begins);
    }
    EXPECT_NEAR(std::abs(std::log(a.lower / b.lower)), std::log(1.2) / 16, 1e-9);
    EXPECT_NEAR(std::abs(std::log(a.upper / b.upper)), std::log(1.2) / 16, 1e-9);
  }
}

TEST(OnsetSearch, BracketsTheLevelsAtWhichABedBeginsToMoveAndStops) {
  for (const double bracket : {0.02, 0.04, 0.1})
    for (const double begins : {0.0612, 0.0999, 0.1, 0.1411, 0.3333})
      for (const double hysteresis : {1.0, 1.02, 1.3, 1.9}) {
        const double stops = begins / hysteresis;
        const Found found = search(plan_of(bracket), sharp(begins, stops));
        const LevelBracket up = found.onset(), down = found.stop();
        ASSERT_LT(up.lower, begins);
        ASSERT_GE(up.upper, begins);
        ASSERT_LE(up.upper / up.lower, 1 + bracket);
        ASSERT_LT(down.lower, stops) << begins;
        const double stopped_above = down.upper == endless ? up.upper : down.upper;   // onset itself is known to move
        ASSERT_GE(stopped_above, stops);
        ASSERT_LE(stopped_above / down.lower, 1 + bracket);
      }
}

TEST(OnsetSearch, TakesAboutTheGrainTimesOfItsEstimate) {
  const Found found = search(plan_of(), sharp(0.13, 0.11));
  EXPECT_LE(found.grain_times, 1500) << found.holds.size();
}

TEST(OnsetSearch, TriesEveryLevelFromTheSettledBedAndStopsOnlyWhatWasStirred) {
  const Found found = search(plan_of(), sharp(0.13, 0.11));
  for (std::size_t k = 0; k < found.planned.size(); ++k) {
    const PlannedHold& hold = found.planned[k];
    const bool at_rest = hold.purpose == HoldPurpose::onset || hold.purpose == HoldPurpose::stir;
    EXPECT_TRUE(hold.from_settled || !at_rest) << k;
    if (hold.purpose == HoldPurpose::stop) {
      EXPECT_FALSE(hold.from_settled);
      const PlannedHold& before = found.planned[k - 1];
      EXPECT_TRUE(before.purpose == HoldPurpose::stir || before.purpose == HoldPurpose::stop);
      EXPECT_EQ(found.holds[k - 1].verdict, HoldVerdict::mobile);
      EXPECT_GT(before.level, hold.level);
    }
  }
}

TEST(OnsetSearch, LetsAnUndecidedHoldGoOnOnce) {
  const auto late = [](HoldPurpose purpose, double level, int before) {   // moves, or rests, only in the longer hold
    if (purpose == HoldPurpose::staircase || purpose == HoldPurpose::stir) return sharp(0.13, 0.13)(purpose, level, 0);
    return before == 0 ? HoldVerdict::undecided : sharp(0.13, 0.11)(purpose, level, 0);
  };
  const Found found = search(plan_of(), late);
  const LevelBracket up = found.onset();
  EXPECT_LT(up.lower, 0.13);
  EXPECT_GE(up.upper, 0.13);
  EXPECT_LE(up.upper / up.lower, 1.04);
  for (std::size_t k = 0; k < found.planned.size(); ++k) {
    const PlannedHold& hold = found.planned[k];
    if (found.holds[k].verdict != HoldVerdict::undecided) continue;
    ASSERT_LT(k + 1, found.planned.size());
    EXPECT_EQ(found.planned[k + 1], (PlannedHold{hold.purpose, hold.level, 2 * hold.duration, false}));
  }
}

TEST(OnsetSearch, BoundsAZoneThatStaysUndecidedFromBothSides) {
  const auto doubtful = [](HoldPurpose purpose, double level, int) {
    if (purpose == HoldPurpose::staircase) return level > 0.13 ? HoldVerdict::mobile : HoldVerdict::arrested;
    return level < 0.12 ? HoldVerdict::arrested : level < 0.14 ? HoldVerdict::undecided : HoldVerdict::mobile;
  };
  const Found found = search(plan_of(), doubtful);
  const LevelBracket up = found.onset();
  EXPECT_LT(up.lower, 0.12);
  EXPECT_GE(up.upper, 0.14);
  EXPECT_GT(up.lower, 0.12 / 1.041);
  EXPECT_LT(up.upper, 0.14 * 1.041);
}

TEST(OnsetSearch, SaysOnlyABoundWhereTheBedNeverMovesOrNeverRests) {
  const Found still = search(plan_of(), sharp(100, 100));
  EXPECT_EQ(still.holds.size(), 12u);   // the staircase alone
  EXPECT_EQ(still.onset().upper, endless);
  const Found restless = search(plan_of(), sharp(0, 0));
  EXPECT_EQ(restless.onset().lower, 0);
  EXPECT_LT(restless.onset().upper, 0.06 / 4);
  EXPECT_EQ(restless.stop().lower, 0);
}

TEST(OnsetSearch, LooksFurtherWhereTheStaircaseMisled) {
  for (const double truth : {0.05, 0.08, 0.2, 0.5}) {
    const auto misled = [=](HoldPurpose purpose, double level, int) {
      return sharp(purpose == HoldPurpose::staircase ? 0.13 : truth, truth)(purpose, level, 0);
    };
    const LevelBracket up = search(plan_of(), misled).onset();
    EXPECT_LT(up.lower, truth);
    EXPECT_GE(up.upper, truth);
    EXPECT_LE(up.upper / up.lower, 1.04);
  }
}

TEST(OnsetSearch, EndsWhateverTheBedDoes) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    unsigned noise = seed;
    const auto fickle = [&](HoldPurpose, double, int) {
      noise = noise * 1664525u + 1013904223u;
      return static_cast<HoldVerdict>(1 + (noise >> 16) % 3);
    };
    const Found found = search(plan_of(), fickle);
    const LevelBracket up = found.onset();
    EXPECT_LT(up.lower, up.upper);
  }
}

TEST(HoldVerdicts, AreMobileWhileTheFluxLastsAndArrestedWhenHardlyAnyIsLeft) {
  const double value = 1e-2;
  EXPECT_EQ(judge_hold(2e-2, 2e-2, value), HoldVerdict::mobile);
  EXPECT_EQ(judge_hold(0, 1e-2, value), HoldVerdict::mobile);
  EXPECT_EQ(judge_hold(5e-2, 1.1e-2, value), HoldVerdict::undecided) << "it dies away";
  EXPECT_EQ(judge_hold(5e-3, 5e-3, value), HoldVerdict::undecided);
  EXPECT_EQ(judge_hold(5e-2, 9e-4, value), HoldVerdict::arrested);
  EXPECT_EQ(judge_hold(0, 0, value), HoldVerdict::arrested);
}

TEST(HoldVerdicts, MeasureTheMiddleAndTheLastThird) {
  std::vector<double> time, flux;
  for (int k = 1; k <= 90; ++k) time.push_back(10 + k), flux.push_back(k <= 30 ? 7 : k <= 60 ? 2 : k <= 75 ? 1 : 3);
  const Thirds thirds = thirds_of(time, flux, 10, 100);
  EXPECT_DOUBLE_EQ(thirds.middle, 2);
  EXPECT_DOUBLE_EQ(thirds.last, 2);
  const Thirds none = thirds_of({}, {}, 0, 1);
  EXPECT_EQ(none.middle, 0);
  EXPECT_EQ(none.last, 0);
}

}   // namespace
}   // namespace bedload

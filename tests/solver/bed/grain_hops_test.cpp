// Histories made by hand, whose hops and rests are known.
#include "solver/bed/grain_hops.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace bedload {
namespace {

constexpr double slow = 0.5, fast = 3, dt = 0.25, before_the_hold = std::numeric_limits<double>::lowest();
constexpr RestRule rule{.speed = 1, .time = 1, .diameter = 2};

/// One grain in a box of length 10, and what has been counted of it.
struct History {
  Grains grains;
  GrainHops hops;
  HopSums counted;
  double time = 5;

  explicit History(double speed = 0) {
    grains.resize(1);
    grains.position = {{9, 0, 0}};
    grains.velocity = {{speed, 0, 0}};
    begin_hops(grains, time, rule, hops);
  }
  /// n steps at that speed along x; each is taken before its speed is seen, as after a coupled step.
  History& go(int n, double speed, bool counts = true) {
    for (; n > 0; --n) {
      const std::vector<double> x_before{grains.position[0].x};
      double& x = grains.position[0].x;
      x += dt * speed, x -= 10 * std::floor(x / 10);
      grains.velocity[0] = {speed, 0, 0};
      follow_hops(grains, x_before, 10, time, time + dt, rule, hops, counts ? &counted : nullptr);
      time += dt;
    }
    return *this;
  }
};

TEST(GrainHops, GoFromRestToRestAndCountNothingOfTheRestItself) {
  History h;
  h.go(8, fast).go(5, slow);   // 6 along x within 2 s, past the end of the box; then 1.25 s of rest
  EXPECT_EQ(h.counted.entrained, 1);
  EXPECT_EQ(h.counted.deposited, 1);
  EXPECT_EQ(h.counted.hop_length.count(), 1);
  EXPECT_NEAR(h.counted.hop_length.mean(), 6, 1e-12);
  EXPECT_NEAR(h.counted.hop_duration.mean(), 2, 1e-12);
  EXPECT_EQ(h.counted.rest_time.count(), 0);   // the one before the hop began before the hold
}

TEST(GrainHops, EndInARestOnlyWhenThatHasLasted) {
  History h;
  h.go(4, fast).go(4, slow);   // slow for just as long as a rest must exceed
  EXPECT_EQ(h.counted.deposited, 0);
  h.go(4, fast).go(5, slow);   // so that all of it was one hop, its pause included
  EXPECT_EQ(h.counted.entrained, 1);
  EXPECT_EQ(h.counted.hop_length.count(), 1);
  EXPECT_NEAR(h.counted.hop_length.mean(), 3 + 0.5 + 3, 1e-12);
  EXPECT_NEAR(h.counted.hop_duration.mean(), 3, 1e-12);
}

TEST(GrainHops, LeaveRestsThatLastFromTheLastMotionToTheNext) {
  History h;
  h.go(2, fast).go(10, slow).go(1, -fast).go(6, slow);
  EXPECT_EQ(h.counted.entrained, 2);
  EXPECT_EQ(h.counted.rest_time.count(), 1);
  EXPECT_NEAR(h.counted.rest_time.mean(), 2.5, 1e-12);
  EXPECT_NEAR(h.counted.hop_length.mean(), (1.5 - 0.75) / 2, 1e-12);   // the second went upstream
  EXPECT_NEAR(h.counted.hop_length.standard_deviation(), (1.5 + 0.75) / std::sqrt(2.0), 1e-12);
}

TEST(GrainHops, AreNotMeasuredWhereTheirBeginningIsNotKnown) {
  History h(fast);                         // moves when the hold begins
  h.go(4, fast).go(5, slow).go(1, fast);   // its first rest is known from end to end
  EXPECT_EQ(h.counted.deposited, 1);
  EXPECT_EQ(h.counted.hop_length.count(), 0);
  EXPECT_EQ(h.counted.rest_time.count(), 1);
  EXPECT_NEAR(h.counted.rest_time.mean(), 1.25, 1e-12);
}

TEST(GrainHops, OfAGrainThatSlowsAsTheHoldBeginsLastAsLongAsAnyOther) {
  History h(fast);
  h.go(4, slow);
  EXPECT_EQ(h.counted.deposited, 0);
  EXPECT_EQ(h.go(1, slow).counted.deposited, 1);
}

TEST(GrainHops, ThatBeganUncountedAreMeasuredWhereTheyEndCounted) {
  History h;
  h.go(4, fast, false).go(1, fast).go(5, slow);
  EXPECT_EQ(h.counted.entrained, 0);
  EXPECT_EQ(h.counted.deposited, 1);
  EXPECT_NEAR(h.counted.hop_length.mean(), 5 * 0.75, 1e-12);
}

TEST(GrainHops, BalanceWhatRests) {
  History h;
  for (int n = 0; n < 7; ++n) {
    h.go(1 + n % 3, fast).go(n % 4 + 3, slow);
    EXPECT_EQ(h.counted.deposited - h.counted.entrained, double(h.hops.resting[0]) - 1) << n;
  }
  EXPECT_GT(h.counted.deposited, 2);
}

TEST(GrainHops, BeginAnewWithEveryHold) {
  History h;
  h.go(3, fast).go(7, slow).go(2, fast);
  begin_hops(h.grains, h.time, rule, h.hops);
  EXPECT_EQ(h.hops.resting, std::vector<std::uint8_t>{0});
  EXPECT_EQ(h.hops.last_fast, std::vector<double>{h.time});
  EXPECT_EQ(h.hops.left_rest, std::vector<double>{before_the_hold});
  EXPECT_EQ(h.hops.way, std::vector<double>{0});
}

TEST(Spread, CountsInBinsThatDouble) {
  Spread s;
  for (const double measure : {-3.0, 0.0, 2.0 / 64, 2 * 1.999 / 64, 2 * 2.0 / 64, 2.0, 3.9, 2 * 512.0, 1e9})
    s.add(measure, 2);
  EXPECT_EQ(s.histogram, (std::vector<double>{4, 1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 2}));
  EXPECT_EQ(s.count(), 9);
  EXPECT_EQ(Spread::lower_edge(6), 1);
}

TEST(Spread, HasItsMedianWhereHalfIsBelow) {
  std::vector<double> counts(Spread::bins);
  EXPECT_TRUE(std::isnan(Spread::median(counts)));
  counts[5] = 3, counts[6] = 4, counts[9] = 1;   // the fourth of eight: a quarter into [1, 2)
  EXPECT_NEAR(Spread::median(counts), std::exp2(0.25), 1e-12);
  counts[0] = 9;
  EXPECT_TRUE(std::isnan(Spread::median(counts)));
}

}   // namespace
}   // namespace bedload

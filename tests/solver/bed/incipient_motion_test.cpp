// Every verdict of the onset rule, on records made by hand.
#include "solver/bed/incipient_motion.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <initializer_list>

#include "solver/bed/onset_search.hpp"

namespace bedload {
namespace {

constexpr double value = 1e-2;
constexpr auto flux = Onset::Criterion::flux;

/// A ramp whose hold k measured theta = 0.1 (k + 1) and the flux given.
BedRecord ramp(std::initializer_list<double> fluxes) {
  BedRecord record;
  for (const double f : fluxes) {
    const double k = double(record.holds.hold.size());
    record.holds.hold.push_back(k);
    record.holds.shields_measured.push_back(0.1 * (k + 1));
    record.holds.flux.push_back(f);
    record.holds.moving_fraction.push_back(0.01 * k);
  }
  return record;
}

TEST(IncipientMotion, IsBracketedByTheLastStillAndTheFirstConfirmedHold) {
  const auto onset = incipient_motion(ramp({0, 1e-4, 1e-3, 3e-2, 8e-2, 0.2, 0.3}), flux, value);
  EXPECT_EQ(onset.status, OnsetStatus::bracketed);
  EXPECT_DOUBLE_EQ(onset.lower, 0.3);
  EXPECT_DOUBLE_EQ(onset.upper, 0.4);
}

TEST(IncipientMotion, InterpolatesTheLogarithmOfTheFlux) {
  const auto onset = incipient_motion(ramp({1e-3, 1e-1, 1}), flux, value);   // 1e-2 is half way in decades
  EXPECT_NEAR(onset.shields, 0.15, 1e-12);
}

TEST(IncipientMotion, LiesInsideItsBracketWhenTheStillHoldCountedNothing) {
  const auto onset = incipient_motion(ramp({0, 2e-2, 1}), flux, value);
  EXPECT_GT(onset.shields, onset.lower);
  EXPECT_LT(onset.shields, onset.upper);
}

TEST(IncipientMotion, AtTheValueItselfCountsAsMotion) {
  EXPECT_EQ(incipient_motion(ramp({0, value, value}), flux, value).status, OnsetStatus::bracketed);
}

TEST(IncipientMotion, IsCensoredBelowWhenTheFirstHoldMoves) {
  const auto onset = incipient_motion(ramp({2e-2, 3e-2, 4e-2, 5e-2}), flux, value);
  EXPECT_EQ(onset.status, OnsetStatus::censored_below);
  EXPECT_TRUE(std::isnan(onset.lower));
  EXPECT_TRUE(std::isnan(onset.shields));
  EXPECT_DOUBLE_EQ(onset.upper, 0.1);
}

TEST(IncipientMotion, IsCensoredAboveWhenNothingMoves) {
  const auto onset = incipient_motion(ramp({0, 0, 1e-3}), flux, value);
  EXPECT_EQ(onset.status, OnsetStatus::censored_above);
  EXPECT_DOUBLE_EQ(onset.lower, 0.3);
  EXPECT_TRUE(std::isnan(onset.upper));
}

TEST(IncipientMotion, IsCensoredAboveWhenOnlyTheLastHoldMoves) {
  const auto onset = incipient_motion(ramp({0, 0, 2e-2}), flux, value);
  EXPECT_EQ(onset.status, OnsetStatus::censored_above);
  EXPECT_DOUBLE_EQ(onset.lower, 0.2);
}

TEST(IncipientMotion, IsNoisyWhenAHoldMovesAndTheNextRests) {
  const auto onset = incipient_motion(ramp({0, 2e-2, 1e-3, 1e-3}), flux, value);
  EXPECT_EQ(onset.status, OnsetStatus::noisy);
  EXPECT_DOUBLE_EQ(onset.lower, 0.1);
  EXPECT_TRUE(std::isnan(onset.upper));
}

TEST(IncipientMotion, SpansTheNoiseWhenALaterOnsetIsConfirmed) {
  const auto onset = incipient_motion(ramp({0, 2e-2, 1e-3, 5e-2, 9e-2, 0.2, 0.3}), flux, value);
  EXPECT_EQ(onset.status, OnsetStatus::noisy);
  EXPECT_DOUBLE_EQ(onset.lower, 0.1);
  EXPECT_DOUBLE_EQ(onset.upper, 0.4);
  EXPECT_GT(onset.shields, 0.3);
}

TEST(IncipientMotion, OfARecordWithoutHoldsIsNone) {
  EXPECT_EQ(incipient_motion({}, flux, value).status, OnsetStatus::none);
}

TEST(IncipientMotion, FollowsTheMovingFractionWhenThatIsTheCriterion) {
  const auto onset =
      incipient_motion(ramp({0, 0, 0, 0, 0}), Onset::Criterion::moving_fraction, 0.025);   // 0, .01, .02, .03, .04
  EXPECT_EQ(onset.status, OnsetStatus::bracketed);
  EXPECT_DOUBLE_EQ(onset.upper, 0.4);
}

TEST(RampEnd, ComesTwoHoldsAfterTheOneThatConfirms) {
  const Onset onset{.method = Onset::Method::ramp, .criterion = flux, .value = value};
  EXPECT_FALSE(ramp_is_over(ramp({0, 2e-2, 3e-2, 4e-2}), onset, 12));
  EXPECT_TRUE(ramp_is_over(ramp({0, 2e-2, 3e-2, 4e-2, 5e-2}), onset, 12));
}

TEST(RampEnd, ComesWithTheLastLevelWhateverMoved) {
  const Onset onset{.method = Onset::Method::ramp, .criterion = flux, .value = value};
  EXPECT_FALSE(ramp_is_over(ramp({0, 0}), onset, 3));
  EXPECT_TRUE(ramp_is_over(ramp({0, 0, 0}), onset, 3));
  EXPECT_FALSE(ramp_is_over(ramp({1, 1, 1, 1, 1}), {.method = Onset::Method::none}, 6));
  EXPECT_TRUE(ramp_is_over(ramp({0}), {.method = Onset::Method::none}, 0));
}

Grains row_of(std::initializer_list<double> x) {
  Grains grains;
  for (const double at : x) {
    grains.resize(grains.size() + 1);
    grains.position.back().x = at;
  }
  return grains;
}

TEST(MotionEvents, AreCountedOncePerHalfDiameterDownstream) {
  Grains grains = row_of({0, 0, 0});
  const double still[] = {0, 0, 0};
  grains.position[0].x = 0.4;
  grains.position[1].x = -3;
  grains.position[2].x = 1.6;
  EXPECT_EQ(count_events(grains, still, 0, 1), 3u);   // the third grain passed 0.5, 1.0 and 1.5
  const double before[] = {0.4, -3, 1.6};
  grains.position[0].x = 0.55;
  grains.position[1].x = -2;
  EXPECT_EQ(count_events(grains, before, 0, 1), 1u);   // the second is still upstream of where it was
}

TEST(MovedGrains, AreCountedOnceHoweverFarAndStayCounted) {
  Grains grains = row_of({0, 0, 0, 0});
  const double still[] = {0, 0, 0, 0};
  for (std::size_t p = 0; p < 4; ++p) grains.position[p].x = std::array{0.6, -3.0, 1.6, 0.4}[p];
  count_events(grains, still, 0, 1);
  EXPECT_EQ(count_moved(grains), 2u);
  const double before[] = {0.6, -3, 1.6, 0.4};
  for (std::size_t p = 0; p < 4; ++p) grains.position[p].x = std::array{0.0, -2.0, 2.6, 0.55}[p];
  count_events(grains, before, 0, 1);
  EXPECT_EQ(count_moved(grains), 3u);   // the first, back where it was, and now the last
}

TEST(LowestReached, IsTheBracketOfHoldsInAnyOrder) {
  const std::vector<double> theta{0.2, 0.1, 0.3, 0.14, 0.12}, motion{0.2, 0, 0.05, 0.1, 1e-3};
  const IncipientMotion found = lowest_reached(theta, motion, 0.01);
  EXPECT_EQ(found.status, OnsetStatus::bracketed);
  EXPECT_EQ(found.lower, 0.12);
  EXPECT_EQ(found.upper, 0.14);
  EXPECT_NEAR(found.shields, 0.13, 1e-12);   // 1e-2 is half-way from 1e-3 to 1e-1 on a logarithm
  EXPECT_EQ(lowest_reached(theta, motion, 0.5).status, OnsetStatus::censored_above);
  EXPECT_EQ(lowest_reached(theta, motion, 0.5).lower, 0.3);
  const std::vector<double> all(5, 1.0);
  EXPECT_EQ(lowest_reached(theta, all, 0.5).status, OnsetStatus::censored_below);
  EXPECT_EQ(lowest_reached(theta, all, 0.5).upper, 0.1);
  EXPECT_EQ(lowest_reached({}, {}, 1).status, OnsetStatus::none);
}

TEST(MotionEvents, GoTheShortWayRoundAPeriodicBox) {
  Grains grains = row_of({0.1, 9.8});
  const double before[] = {9.9, 0.1};
  EXPECT_EQ(count_events(grains, before, 10, 0.3), 1u);
  EXPECT_NEAR(grains.travel[0], 0.05, 1e-12);
  EXPECT_NEAR(grains.travel[1], -0.3, 1e-12);
}

TEST(MotionEvents, CallAGrainMovingAboveAHundredthOfTheScale) {
  Grains grains = row_of({0, 0, 0});
  grains.velocity = {{0.0099, 0, 0}, {0, 0.008, 0.008}, {0, 0, -0.0101}};
  EXPECT_EQ(count_moving(grains, 1), 2u);
}

TEST(GrainTime, IsTheSlowerOfInertiaAndSettling) {
  EXPECT_NEAR(grain_time(1e-3, 2, 10, 1e3), 1e-2, 1e-12);   // sqrt(1e-3/10)
  EXPECT_NEAR(grain_time(1e-3, 2, 10, 1e-3), 1, 1e-12);     // d/U_t
  EXPECT_EQ(grain_time(1e-3, 1, 10, 0), 0);
}

TEST(SurfaceGrains, CoverFourFifthsOfTheBed) {
  Scene scene;
  scene.bed.grains.diameter = 1;
  scene.bed.length = {20, 12, 13};
  EXPECT_NEAR(surface_grains(scene), 244.46, 0.01);   // "244 surface grains" of a box 20 x 12 d
}

/// Holds of a search at nominal levels, each measured 0.9 of it.
struct SearchedBed {
  BedRecord record;
  void add(HoldPurpose purpose, double level, HoldVerdict verdict) {
    auto& h = record.holds;
    h.hold.push_back(double(h.hold.size()));
    h.purpose.push_back(double(purpose)), h.level.push_back(level), h.verdict.push_back(double(verdict));
    h.shields_measured.push_back(0.9 * level);
  }
};

TEST(SearchedMotion, IsWhatWasMeasuredInTheHoldsThatBoundIt) {
  SearchedBed bed;
  bed.add(HoldPurpose::staircase, 0.3, HoldVerdict::mobile);
  bed.add(HoldPurpose::onset, 0.3, HoldVerdict::mobile);
  bed.add(HoldPurpose::onset, 0.1, HoldVerdict::arrested);
  bed.add(HoldPurpose::onset, 0.2, HoldVerdict::undecided);
  bed.add(HoldPurpose::onset, 0.2, HoldVerdict::mobile);   // went on
  bed.add(HoldPurpose::stir, 0.4, HoldVerdict::mobile);
  bed.add(HoldPurpose::stop, 0.08, HoldVerdict::arrested);
  const SearchedMotion found = searched_motion(bed.record);
  EXPECT_EQ(found.onset.status, OnsetStatus::bracketed);
  EXPECT_DOUBLE_EQ(found.onset.lower, 0.09);
  EXPECT_DOUBLE_EQ(found.onset.upper, 0.18);
  EXPECT_DOUBLE_EQ(found.onset.shields, std::sqrt(0.09 * 0.18));
  EXPECT_DOUBLE_EQ(found.stop_lower, 0.072);
  EXPECT_DOUBLE_EQ(found.stop_upper, 0.18) << "the bed moved from rest there";
}

TEST(SearchedMotion, IsABoundWhereABedNeverMovedOrNeverRested) {
  SearchedBed still;
  still.add(HoldPurpose::staircase, 0.1, HoldVerdict::arrested);
  still.add(HoldPurpose::staircase, 0.2, HoldVerdict::arrested);
  const SearchedMotion above = searched_motion(still.record);
  EXPECT_EQ(above.onset.status, OnsetStatus::censored_above);
  EXPECT_DOUBLE_EQ(above.onset.lower, 0.18);
  EXPECT_TRUE(std::isnan(above.onset.upper) && std::isnan(above.onset.shields) && std::isnan(above.stop_lower));

  SearchedBed restless;
  restless.add(HoldPurpose::staircase, 0.1, HoldVerdict::mobile);
  restless.add(HoldPurpose::onset, 0.1, HoldVerdict::mobile);
  const SearchedMotion below = searched_motion(restless.record);
  EXPECT_EQ(below.onset.status, OnsetStatus::censored_below);
  EXPECT_DOUBLE_EQ(below.onset.upper, 0.09);
  EXPECT_TRUE(std::isnan(below.onset.lower) && std::isnan(below.onset.shields));
}

}   // namespace
}   // namespace bedload

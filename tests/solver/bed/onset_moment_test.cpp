// Which hold is kept as the bed at onset, on records made by hand.
#include "solver/bed/onset_moment.hpp"

#include <gtest/gtest.h>

#include "solver/bed/onset_search.hpp"

namespace bedload {
namespace {

/// Of the holds of a record, those after which it ended at onset.
std::vector<std::size_t> moments(const Onset& onset, std::size_t holds, auto&& add_hold) {
  BedRecord record;
  std::vector<std::size_t> found;
  for (std::size_t k = 0; k < holds; ++k) {
    record.holds.hold.push_back(double(k));
    add_hold(record.holds, k);
    if (ends_at_onset(record, onset)) found.push_back(k);
  }
  return found;
}

std::vector<std::size_t> moments_of_ramp(const std::vector<double>& flux, const Onset& onset) {
  return moments(onset, flux.size(), [&](BedRecord::Holds& holds, std::size_t k) {
    holds.flux.push_back(flux[k]);
    holds.moving_fraction.push_back(10 * flux[k]);
  });
}

struct Hold {
  HoldPurpose purpose;
  double level;
  HoldVerdict verdict;
};

std::vector<std::size_t> moments_of_search(const std::vector<Hold>& of) {
  return moments({.method = Onset::Method::bisect}, of.size(), [&](BedRecord::Holds& holds, std::size_t k) {
    holds.purpose.push_back(double(of[k].purpose));
    holds.level.push_back(of[k].level);
    holds.verdict.push_back(double(of[k].verdict));
  });
}

using Moments = std::vector<std::size_t>;
const Onset by_flux{.method = Onset::Method::ramp, .criterion = Onset::Criterion::flux, .value = 1e-2};

TEST(OnsetMoment, IsTheFirstHoldOfARampThatMoves) {
  EXPECT_EQ(moments_of_ramp({0, 1e-3, 1e-2, 0.1, 0.2}, by_flux), Moments{2});
  EXPECT_EQ(moments_of_ramp({0.1, 0.2}, by_flux), Moments{0});
  EXPECT_EQ(moments_of_ramp({0, 1e-3}, by_flux), Moments{});
}

TEST(OnsetMoment, IsALaterHoldOfARampThatStirredAndRestedAgain) {
  EXPECT_EQ(moments_of_ramp({0, 0.1, 0, 0.1, 0.2}, by_flux), (Moments{1, 3}));
}

TEST(OnsetMoment, FollowsTheCriterion) {
  Onset onset = by_flux;
  onset.criterion = Onset::Criterion::moving_fraction;
  EXPECT_EQ(moments_of_ramp({0, 1e-3, 1e-2}, onset), Moments{1});
  onset.method = Onset::Method::none;
  EXPECT_EQ(moments_of_ramp({0, 1e-3, 1e-2}, onset), Moments{});
}

TEST(OnsetMoment, IsTheWeakestFlowThatMovedTheSettledBed) {
  using enum HoldPurpose;
  using enum HoldVerdict;
  EXPECT_EQ(moments_of_search({{staircase, 0.1, mobile},
                               {onset, 0.2, mobile},
                               {onset, 0.1, arrested},
                               {onset, 0.15, mobile},
                               {onset, 0.12, undecided},
                               {onset, 0.17, mobile},
                               {stir, 0.14, mobile},
                               {stop, 0.1, mobile}}),
            (Moments{1, 3}));
}

}   // namespace
}   // namespace bedload

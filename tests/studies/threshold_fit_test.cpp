// Brackets of many packings to one threshold: against closed forms, brute force, and campaigns whose answer is known.
#include "studies/threshold_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <tuple>
#include <vector>

#include "base/error.hpp"
#include "base/random_stream.hpp"

namespace bedload {
namespace {

using Brackets = std::vector<SeedBracket>;
constexpr double endless = std::numeric_limits<double>::infinity();

/// Numbered from 1 in the order given.
Brackets seeds(std::initializer_list<std::pair<double, double>> ends) {
  Brackets all;
  for (const auto& [lower, upper] : ends) all.push_back({all.size() + 1, lower, upper});
  return all;
}

Brackets transformed(Brackets all, const std::function<double(double)>& f) {
  for (SeedBracket& one : all) one.lower = f(one.lower), one.upper = f(one.upper);
  return all;
}

/// As a search leaves them: the threshold of each packing, log-normal, in a bracket of the given ratio; the ends anywhere, or
/// on levels that all packings share.
struct Campaign {
  double theta_50 = 0.12, sigma = 0.1, ratio = 1.04;
  bool shared_levels = false;

  double threshold(std::uint64_t campaign, std::uint32_t seed) const {
    return theta_50 * std::exp(sigma * RandomStream(campaign, Stream::grain_diameter, seed).normal());
  }
  Brackets brackets(std::uint64_t campaign, std::uint32_t count) const {
    Brackets all;
    for (std::uint32_t seed = 1; seed <= count; ++seed) {
      const double shift =
          RandomStream(campaign, Stream::grain_place, shared_levels ? 0 : seed).uniform();   // of levels
      const double level = std::floor(std::log(threshold(campaign, seed) / theta_50) / std::log(ratio) + shift) - shift;
      all.push_back({seed, theta_50 * std::pow(ratio, level), theta_50 * std::pow(ratio, level + 1)});
    }
    return all;
  }
};

/// The likelihood as it stands in the book.
double log_likelihood(const Brackets& all, double mu, double sigma) {
  double sum = 0;
  for (const SeedBracket& one : all) {
    const auto phi = [&](double theta) { return 0.5 * std::erfc(-(std::log(theta) - mu) / (sigma * std::sqrt(2.0))); };
    sum += std::log(phi(one.upper) - phi(one.lower));
  }
  return sum;
}

/// Its maximum by looking everywhere, again and again around the best place of a grid half as wide.
std::pair<double, double> maximum_by_grid(const Brackets& all, double mu, double log_sigma, double reach) {
  for (; reach > 1e-7; reach /= 2) {
    double best = -endless, best_mu = mu, best_log_sigma = log_sigma;
    for (int i = -10; i <= 10; ++i)
      for (int j = -10; j <= 10; ++j) {
        const double value = log_likelihood(all, mu + reach * i / 10, std::exp(log_sigma + reach * j / 10));
        if (value > best) best = value, best_mu = mu + reach * i / 10, best_log_sigma = log_sigma + reach * j / 10;
      }
    mu = best_mu, log_sigma = best_log_sigma;
  }
  return {mu, std::exp(log_sigma)};
}

double sigma_of(const ThresholdFit& fit) { return std::log(fit.theta_84 / fit.theta_16) / 2; }

void expect_same_bits(const ThresholdFit& a, const ThresholdFit& b) {
  EXPECT_EQ(a.status, b.status);
  EXPECT_EQ(a.width_resolved, b.width_resolved);
  EXPECT_EQ(std::tie(a.theta_50, a.theta_16, a.theta_84, a.lower, a.upper),
            std::tie(b.theta_50, b.theta_16, b.theta_84, b.lower, b.upper));
}

TEST(ThresholdFit, OfPointsIsTheMeanAndDeviationOfTheirLogarithms) {
  const Campaign campaign;
  for (const double narrow : {1e-5, 1e-7, 1e-10}) {
    Brackets all;
    double sum = 0, square = 0;
    for (std::uint32_t seed = 1; seed <= 50; ++seed) {
      const double theta = campaign.threshold(1, seed);
      all.push_back({seed, theta * (1 - narrow), theta * (1 + narrow)});
      sum += std::log(theta), square += std::log(theta) * std::log(theta);
    }
    const double mean = sum / 50, deviation = std::sqrt(square / 50 - mean * mean);
    const ThresholdFit fit = fit_threshold(all);
    EXPECT_EQ(fit.status, ThresholdStatus::bracketed);
    EXPECT_TRUE(fit.width_resolved);
    EXPECT_NEAR(std::log(fit.theta_50), mean, 1e-9);
    EXPECT_NEAR(sigma_of(fit), deviation, 1e-8);   // a bracket of w moves it by w^2/(24 sigma), 2e-10 here
    EXPECT_NEAR(fit.theta_16 * fit.theta_84, fit.theta_50 * fit.theta_50, 1e-14);
  }
}

TEST(ThresholdFit, OfPublishedCensoredDataIsThePublishedOne) {
  // Ten values, five known to be below 65 and three above 50, as the example hands them to its optimiser: mean 58.106,
  // deviation 5.669. "Gaussian distribution with interval data", http://leg.ufpr.br/~henrique/stuff/likelihood.
  Brackets all;
  const auto theta = [](double x) { return std::exp(x / 10); };
  for (const double x : {56.4, 54.2, 65.3, 49.2, 50.1, 56.9, 58.9, 62.5, 70.0, 61.0})
    all.push_back({all.size(), theta(x - 1e-6), theta(x + 1e-6)});
  for (int n = 0; n < 5; ++n) all.push_back({all.size(), 0, theta(65)});
  for (int n = 0; n < 3; ++n) all.push_back({all.size(), theta(50), endless});
  const ThresholdFit fit = fit_threshold(all);
  EXPECT_NEAR(10 * std::log(fit.theta_50), 58.106, 0.001);
  EXPECT_NEAR(10 * sigma_of(fit), 5.669, 0.001);
}

TEST(ThresholdFit, IsTheMaximumThatAGridFinds) {
  Brackets mixed = Campaign{.sigma = 0.05}.brackets(3, 12);
  mixed[2].upper = endless, mixed[5].lower = 0, mixed[7].lower = 0, mixed[9].lower /= 1.2;
  const Brackets one_sided = seeds({{0, 0.10}, {0.12, endless}, {0, 0.15}, {0.09, endless}, {0, 0.13}});
  const Brackets hardly_apart = seeds({{0.100, 0.120}, {0.1201, 0.14}, {0.09, 0.13}});
  const Brackets stray = seeds({{0.100, 0.104}, {0.102, 0.106}, {0.101, 0.105}, {0.9, 1.0}});
  for (const Brackets& all :
       {Campaign{}.brackets(1, 8), Campaign{.sigma = 0.02}.brackets(2, 20), mixed, one_sided, hardly_apart, stray}) {
    const ThresholdFit fit = fit_threshold(all);
    ASSERT_TRUE(fit.width_resolved);
    const auto [mu, sigma] = maximum_by_grid(all, std::log(0.12), std::log(0.1), 3);
    EXPECT_NEAR(std::log(fit.theta_50), mu, 1e-5);   // the grid sees differences of the likelihood down to 1e-15 only
    EXPECT_NEAR(std::log(sigma_of(fit)), std::log(sigma), 1e-5);
    EXPECT_GE(log_likelihood(all, std::log(fit.theta_50), sigma_of(fit)), log_likelihood(all, mu, sigma) - 1e-13);
  }
}

TEST(ThresholdFit, GoesAlongWithTheScaleOfTheShieldsNumber) {
  Brackets all = Campaign{}.brackets(4, 12);
  all[3].lower = 0, all[8].upper = endless;
  const ThresholdFit fit = fit_threshold(all);
  const ThresholdInterval interval = interval_of_threshold(all);
  for (const double factor : {0.01, 3.7, 1e6}) {
    const Brackets scaled_brackets = transformed(all, [&](double theta) { return factor * theta; });
    const ThresholdFit scaled = fit_threshold(scaled_brackets);
    EXPECT_NEAR(scaled.theta_50 / fit.theta_50, factor, 1e-10 * factor);
    EXPECT_NEAR(scaled.theta_16 / fit.theta_16, factor, 1e-10 * factor);
    const ThresholdInterval of_scaled = interval_of_threshold(scaled_brackets);
    EXPECT_NEAR(of_scaled.lower / interval.lower, factor, 1e-10 * factor);
    EXPECT_NEAR(of_scaled.upper / interval.upper, factor, 1e-10 * factor);
  }
}

TEST(ThresholdFit, OfInvertedBracketsIsTheInverse) {
  Brackets all = Campaign{}.brackets(5, 12), inverted = all;
  all[3].lower = 0, all[8].upper = endless;
  for (std::size_t n = 0; n < all.size(); ++n) inverted[n] = {all[n].seed, 1 / all[n].upper, 1 / all[n].lower};
  inverted[3].upper = endless, inverted[8].lower = 0;
  const ThresholdFit fit = fit_threshold(all), mirror = fit_threshold(inverted);
  EXPECT_NEAR(fit.theta_50 * mirror.theta_50, 1, 1e-10);
  EXPECT_NEAR(fit.theta_16 * mirror.theta_84, 1, 1e-10);
}

TEST(ThresholdFit, KeepsItsBitsInWhateverOrderSeedsAreHandedIn) {
  Brackets all = Campaign{}.brackets(6, 9);
  all[4].upper = endless;
  const ThresholdFit fit = fit_threshold(all);
  const ThresholdInterval interval = interval_of_threshold(all);
  for (int turn = 0; turn < 3; ++turn) {
    std::ranges::rotate(all, all.begin() + 4);
    std::swap(all[0], all[5]);
    expect_same_bits(fit_threshold(all), fit);
    EXPECT_EQ(interval_of_threshold(all).lower, interval.lower);
    EXPECT_EQ(interval_of_threshold(all).upper, interval.upper);
  }
}

TEST(ThresholdFit, HasNoWidthWhereAllBracketsShareAnInterval) {
  for (const Brackets& all :
       {seeds({{0.10, 0.13}, {0.11, 0.14}, {0.105, 0.12}}), seeds({{0.11, 0.12}}), seeds({{0.11, 0.12}, {0.11, 0.12}}),
        seeds({{0, 0.12}, {0.11, endless}}), seeds({{0, 0.2}, {0.11, 0.12}, {0.05, endless}})}) {
    const ThresholdFit fit = fit_threshold(all);
    EXPECT_EQ(fit.status, ThresholdStatus::bracketed);
    EXPECT_FALSE(fit.width_resolved);
    EXPECT_DOUBLE_EQ(fit.theta_50, std::sqrt(0.11 * 0.12));
    EXPECT_EQ(fit.lower, 0.11);
    EXPECT_EQ(fit.upper, 0.12);
    EXPECT_TRUE(std::isnan(fit.theta_16) && std::isnan(fit.theta_84));
  }
  // Brackets that touch have a point in common, of which a distribution without width leaves each its share.
  EXPECT_FALSE(fit_threshold(seeds({{0.10, 0.12}, {0.12, 0.14}, {0.12, 0.13}})).width_resolved);
  EXPECT_EQ(fit_threshold(seeds({{0.10, 0.12}, {0.12, 0.14}})).theta_50, std::sqrt(0.12 * 0.12));
}

TEST(ThresholdFit, GrowsAWidthFromNothingAsBracketsDrawApart) {
  double last = 0;
  for (const double gap : {1e-15, 1e-12, 1e-6, 1e-3}) {   // relative
    const ThresholdFit fit = fit_threshold(seeds({{0.10, 0.12}, {0.12 * (1 + gap), 0.144 * (1 + gap)}}));
    ASSERT_TRUE(fit.width_resolved) << gap;
    EXPECT_NEAR(fit.theta_50, 0.12 * std::sqrt(1 + gap), 1e-12);   // by symmetry
    EXPECT_GT(sigma_of(fit), last);
    last = sigma_of(fit);
  }
}

TEST(ThresholdFit, OfBoundsOnOneSideIsABound) {
  const ThresholdFit moved = fit_threshold(seeds({{0, 0.06}, {0, 0.07}}));
  EXPECT_EQ(moved.status, ThresholdStatus::only_upper_bound);
  EXPECT_TRUE(std::isnan(moved.theta_50));
  EXPECT_EQ(moved.lower, 0);
  EXPECT_EQ(moved.upper, 0.07);   // the one that holds for every seed
  const ThresholdFit rested = fit_threshold(seeds({{0.4, endless}, {0.3, endless}}));
  EXPECT_EQ(rested.status, ThresholdStatus::only_lower_bound);
  EXPECT_TRUE(std::isnan(rested.theta_50));
  EXPECT_EQ(rested.lower, 0.3);
  EXPECT_EQ(rested.upper, endless);
  for (const Brackets& all : {Brackets{}, seeds({{0, endless}})}) {
    EXPECT_EQ(fit_threshold(all).status, ThresholdStatus::none);
    EXPECT_EQ(interval_of_threshold(all).lower, 0);
    EXPECT_EQ(interval_of_threshold(all).upper, endless);
    EXPECT_EQ(interval_of_threshold(all).confidence, 0);
  }
}

TEST(ThresholdFit, OfBoundsThatContradictEachOtherIsNone) {
  const Brackets all = seeds({{0, 0.1}, {0.2, endless}, {0, 0.11}, {0.1, endless}});
  EXPECT_EQ(fit_threshold(all).status, ThresholdStatus::none);
  // The wider, the likelier: there is nothing to find.
  for (double sigma = 0.05; sigma < 100; sigma *= 2)
    EXPECT_LT(log_likelihood(all, std::log(0.12), sigma), log_likelihood(all, std::log(0.12), 2 * sigma));
}

TEST(ThresholdFit, LeavesOutSeedsThatSayNothing) {
  Brackets all = Campaign{}.brackets(7, 8);
  const ThresholdFit fit = fit_threshold(all);
  all.push_back({0, 0, endless});
  expect_same_bits(fit_threshold(all), fit);
}

TEST(ThresholdFit, IsMovedByWhatIsKnownFromOneSide) {
  const Brackets all = Campaign{}.brackets(8, 8);
  const ThresholdFit fit = fit_threshold(all);
  Brackets lower = all, higher = all;
  lower.push_back({9, 0, fit.theta_50}), higher.push_back({9, fit.theta_50, endless});
  EXPECT_LT(fit_threshold(lower).theta_50, fit.theta_50);
  EXPECT_GT(fit_threshold(higher).theta_50, fit.theta_50);
  // An open end in place of a closed one moves it to that side, and widens the distribution there.
  Brackets open = all;
  std::ranges::max_element(open, {}, &SeedBracket::upper)->upper = endless;
  EXPECT_GT(fit_threshold(open).theta_50, fit.theta_50);
  EXPECT_GT(fit_threshold(open).theta_84, fit.theta_84);
}

TEST(ThresholdFit, RefusesWhatIsNoBracket) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [lower, upper] : {std::pair{0.12, 0.12},
                                     {0.13, 0.12},
                                     {-0.1, 0.12},
                                     {nan, 0.12},
                                     {0.12, nan},
                                     {endless, endless},
                                     {0.0, 0.0},
                                     {-endless, 0.1}}) {
    const Brackets all = seeds({{0.1, 0.2}, {lower, upper}});
    try {
      fit_threshold(all);
      ADD_FAILURE() << lower << " " << upper;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind, ErrorKind::numerical);
      EXPECT_NE(std::string(error.what()).find("seed 2"), std::string::npos);
      EXPECT_FALSE(error.hint.empty());
    }
    EXPECT_THROW(interval_of_threshold(all), Error);
  }
  EXPECT_THROW(fit_threshold(Brackets{{1, 0.1, 0.2}, {1, 0.1, 0.2}}), Error);
}

TEST(ThresholdInterval, OfPointsIsThatOfTheMeansOfTheirResamples) {
  Brackets all;
  std::vector<double> logs;
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    const double theta = Campaign{}.threshold(9, seed);
    logs.push_back(std::log(theta));
    all.push_back({seed, theta * (1 - 1e-8), theta * (1 + 1e-8)});
  }
  std::vector<double> means;
  for (std::uint32_t resample = 0; resample < 2000; ++resample) {
    RandomStream random(0, Stream::resampling, resample);
    double sum = 0;
    for (int k = 0; k < 10; ++k) sum += logs[static_cast<std::size_t>(10 * random.uniform())];
    means.push_back(sum / 10);
  }
  std::ranges::sort(means);
  // t = 2.262 of 9 degrees of freedom: Phi(-2.262 sqrt(10/9)) = 0.00855, 17 of 2000.
  const ThresholdInterval interval = interval_of_threshold(all);
  EXPECT_NEAR(std::log(interval.lower), means[17], 1e-7);
  EXPECT_NEAR(std::log(interval.upper), means[1999 - 17], 1e-7);
  EXPECT_EQ(interval.confidence, 0.95);
}

TEST(ThresholdInterval, LeavesOutAsManyResamplesAsStudentsTWants) {
  // t at 97.5 %: Abramowitz & Stegun table 26.10.
  for (const auto& [n, t] : {std::pair{2, 12.706}, {6, 2.571}, {8, 2.365}, {20, 2.093}, {121, 1.980}}) {
    const double tail = 0.5 * std::erfc(t * std::sqrt(n / (n - 1.0)) / std::sqrt(2.0));
    EXPECT_NEAR(share_beyond_each_end(static_cast<std::size_t>(n)), tail, 2e-3 * t * t * tail + 1e-70) << n;
  }
}

TEST(ThresholdInterval, WithoutAWidthIsNeverNarrowerThanWhatTheBracketsShare) {
  for (std::uint32_t count = 1; count <= 30; ++count) {
    const Brackets all = Campaign{.sigma = 0.001}.brackets(count, count);
    const ThresholdFit fit = fit_threshold(all);
    if (fit.width_resolved) continue;
    const ThresholdInterval interval = interval_of_threshold(all);
    EXPECT_LE(interval.lower, fit.lower);
    EXPECT_GE(interval.upper, fit.upper);
  }
  const Brackets alike(8, {0, 0.11, 0.12});
  Brackets numbered = alike;
  for (std::size_t n = 0; n < 8; ++n) numbered[n].seed = n;
  EXPECT_EQ(interval_of_threshold(numbered).lower, 0.11);
  EXPECT_EQ(interval_of_threshold(numbered).upper, 0.12);
  // Half of the packings below a level that both halves met, half above: no width, but theta_50 is not known exactly.
  for (std::size_t n = 0; n < 8; n += 2) numbered[n] = {n, 0.12, 0.13};
  EXPECT_EQ(fit_threshold(numbered).lower, fit_threshold(numbered).upper);
  EXPECT_EQ(interval_of_threshold(numbered).lower, 0.11);
  EXPECT_EQ(interval_of_threshold(numbered).upper, 0.13);
}

TEST(ThresholdInterval, WithoutAWidthIsThatOfTheSignTest) {
  // Ranks of the interval of the median at 95 %: Conover, "Practical nonparametric statistics", or Dixon & Massey, table A-25.
  const struct { std::size_t seeds, rank; } table[] = {{6, 1}, {8, 1}, {9, 2}, {12, 3}, {15, 4}, {20, 6}, {25, 8}};
  for (const auto& [count, rank] : table) {
    Brackets all;
    for (std::size_t n = 1; n <= count; ++n) {
      const double shift = 1e-3 * static_cast<double>(n);
      all.push_back({n, 0.1 + shift, 0.2 + shift});
    }
    const ThresholdInterval interval = interval_of_threshold(all);
    EXPECT_EQ(interval.lower, all[rank - 1].lower) << count;
    EXPECT_EQ(interval.upper, all[count - rank].upper) << count;
    EXPECT_EQ(interval.confidence, 0.95);
  }
}

TEST(ThresholdInterval, PromisesNoMoreThanFewSeedsAllow) {
  // Not all packings lie on one side of their median: 1 - 2/2^n.
  for (const auto& [count, confidence] :
       {std::pair{1u, 0.0}, {2u, 0.5}, {3u, 0.75}, {4u, 0.875}, {5u, 0.9375}, {6u, 0.95}})
    EXPECT_EQ(interval_of_threshold(Campaign{}.brackets(10, count)).confidence, confidence);
}

TEST(ThresholdInterval, OpensWhereResamplesKnowOneSideOnly) {
  Brackets all = Campaign{}.brackets(11, 8);
  for (std::size_t n = 0; n < 7; ++n) all[n].lower = 0;
  all[7] = {8, 0.2, 0.21};
  ASSERT_TRUE(fit_threshold(all).width_resolved);
  const ThresholdInterval interval = interval_of_threshold(all);
  EXPECT_EQ(interval.lower, 0);   // a third of the resamples have upper bounds alone
  EXPECT_TRUE(std::isfinite(interval.upper));
}

/// In how many of `campaigns` the interval holds theta_50.
int held(const Campaign& campaign, std::uint32_t count, int campaigns) {
  int good = 0;
  for (int n = 0; n < campaigns; ++n) {
    const ThresholdInterval interval =
        interval_of_threshold(campaign.brackets(1000 * count + static_cast<std::uint64_t>(n), count));
    good += interval.lower <= campaign.theta_50 && campaign.theta_50 <= interval.upper;
  }
  return good;
}

struct Case {
  double sigma;
  std::uint32_t count;
  bool shared_levels = false;
};
struct Coverage : ::testing::TestWithParam<Case> {
  static constexpr int campaigns = 200;
  static double band() { return 3.29 * std::sqrt(campaigns * 0.95 * 0.05); }   // binomial, missed by one in a thousand
};

struct ThresholdIntervalOfWideDistributions : Coverage {};
TEST_P(ThresholdIntervalOfWideDistributions, HoldsThetaInNinetyFivePerCentOfCampaigns) {
  const auto [sigma, count, shared_levels] = GetParam();
  EXPECT_NEAR(held({.sigma = sigma, .shared_levels = shared_levels}, count, campaigns), 0.95 * campaigns, band());
}
INSTANTIATE_TEST_SUITE_P(ByWidthAndSeeds, ThresholdIntervalOfWideDistributions,
                         ::testing::Values(Case{0.1, 8}, Case{0.1, 20}, Case{0.3, 12}, Case{0.1, 8, true}));

struct ThresholdIntervalOfNarrowDistributions : Coverage {};   // ranks say less, and promise more than they must
TEST_P(ThresholdIntervalOfNarrowDistributions, HoldsThetaInNoLessThanNinetyFivePerCentOfCampaigns) {
  const auto [sigma, count, shared_levels] = GetParam();
  EXPECT_GE(held({.sigma = sigma, .shared_levels = shared_levels}, count, campaigns), 0.95 * campaigns - band());
}
INSTANTIATE_TEST_SUITE_P(ByWidthAndSeeds, ThresholdIntervalOfNarrowDistributions,
                         ::testing::Values(Case{0.001, 8}, Case{0.01, 8}, Case{0.02, 8}, Case{0.02, 12},
                                           Case{0.01, 8, true}, Case{0.02, 8, true}));

/// The table of docs/decisions/threshold_fit.md: minutes, judged above.
TEST(ThresholdInterval, DISABLED_PrintsHowOftenItHoldsTheta) {
  constexpr int campaigns = 1000;
  for (const bool shared_levels : {false, true})
    for (const double sigma : {0.001, 0.01, 0.02, 0.04, 0.1}) {
      std::printf("| %s | %g |", shared_levels ? "shared" : "anywhere", sigma);
      for (const std::uint32_t count : {6u, 8u, 12u, 20u})
        std::printf(" %.3f |",
                    held({.sigma = sigma, .shared_levels = shared_levels}, count, campaigns) / (1.0 * campaigns));
      std::printf("\n");
      std::fflush(stdout);
    }
}

/// After how many seeds a campaign stops.
std::size_t stops_after(const Brackets& all, int batch, double wanted, int most) {
  for (std::size_t k = 1; k <= all.size(); ++k)
    if (enough_seeds(std::span(all).first(k), batch, wanted, most)) return k;
  return 0;
}

TEST(EnoughSeeds, StopsAtTheFirstWholeBatchWhoseIntervalIsNarrowEnough) {
  const Brackets all = Campaign{.sigma = 0.2}.brackets(12, 60);
  for (const int batch : {1, 4, 5}) {
    const auto k = stops_after(all, batch, 0.1, 1000);
    ASSERT_GT(k, 6u);
    EXPECT_EQ(k % static_cast<std::size_t>(batch), 0u);
    for (std::size_t n = 6; n <= k; ++n) {
      const auto first = std::span(all).first(n);
      const ThresholdInterval interval = interval_of_threshold(first);
      const bool narrow = (interval.upper - interval.lower) / 2 <= 0.1 * fit_threshold(first).theta_50;
      if (n % static_cast<std::size_t>(batch) == 0) {
        EXPECT_EQ(narrow, n == k) << n;
      }
    }
  }
  EXPECT_LT(stops_after(all, 4, 0.2, 1000), stops_after(all, 4, 0.1, 1000));
}

TEST(EnoughSeeds, DependsOnTheFirstSeedsOnlyAndNotOnTheirOrder) {
  Brackets all = Campaign{.sigma = 0.2}.brackets(13, 40);
  const auto k = stops_after(all, 4, 0.12, 40);
  ASSERT_LT(k, 40u);
  Brackets others = all;
  for (std::size_t n = k; n < others.size(); ++n) others[n].upper = endless;
  EXPECT_EQ(stops_after(others, 4, 0.12, 40), k);
  std::reverse(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(k));
  EXPECT_TRUE(enough_seeds(std::span(all).first(k), 4, 0.12, 40));
}

TEST(EnoughSeeds, StopsAtTheMostWhateverIsKnown) {
  const Brackets wide = Campaign{.sigma = 1}.brackets(14, 10);
  EXPECT_EQ(stops_after(wide, 4, 0.01, 10), 10u);
  EXPECT_EQ(stops_after(seeds({{0, 0.1}, {0, 0.1}, {0, 0.1}}), 1, 0.5, 3), 3u);
}

TEST(EnoughSeeds, NeedsSixForNinetyFivePerCent) {
  const Brackets all = Campaign{.sigma = 0.001}.brackets(15, 12);
  EXPECT_EQ(stops_after(all, 1, 0.15, 12), 6u);
  EXPECT_EQ(stops_after(all, 4, 0.15, 12), 8u);
}

TEST(EnoughSeeds, RefusesRulesThatNeverStop) {
  const Brackets all = Campaign{}.brackets(16, 8);
  EXPECT_THROW(enough_seeds(all, 0, 0.15, 8), Error);
  EXPECT_THROW(enough_seeds(all, 4, 0, 8), Error);
  EXPECT_THROW(enough_seeds(all, 4, std::nan(""), 8), Error);
  EXPECT_THROW(enough_seeds(all, 4, 0.15, 0), Error);
}

}   // namespace
}   // namespace bedload

// Interval-censored likelihood of a log-normal threshold, maximised by Newton's method; intervals by resampling and by rank.
#include "studies/threshold_fit.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/error.hpp"
#include "base/random_stream.hpp"
#include "studies/normal_distribution.hpp"

namespace bedload {

namespace {

constexpr double endless = std::numeric_limits<double>::infinity();
constexpr double tail = 0.025;             // of an interval of 95 %, on each side
constexpr std::size_t fewest_for_95 = 6;   // n packings all lie on one side of the median with probability 2^(1 - n)
constexpr std::uint32_t resamples = 2000;

/// A bracket and how often it is in the sample.
struct Member {
  double lower, upper;   // [-]
  double times = 1;

  bool open_below() const { return lower == 0; }
  bool open_above() const { return upper == endless; }
};
using Members = std::vector<Member>;

void check(const SeedBracket& bracket) {
  const auto [seed, lower, upper] = bracket;
  if (lower >= 0 && lower < upper && lower < endless) return;
  throw Error(
      ErrorKind::numerical,
      fmt::format("seed {}: at rest at theta = {}, moving at {}, is no bracket: lower has to be 0 or more, and less "
                  "than upper",
                  seed, lower, upper),
      "longer holds measure the Shields number better; a wider bracket keeps its ends apart");
}

/// Those that say anything, in order of their seeds.
Members members(std::span<const SeedBracket> brackets) {
  std::vector<SeedBracket> sorted(brackets.begin(), brackets.end());
  std::ranges::sort(sorted, {}, &SeedBracket::seed);
  const auto twice = std::ranges::adjacent_find(sorted, {}, &SeedBracket::seed);
  if (twice != sorted.end())
    throw Error(ErrorKind::internal, fmt::format("seed {} has two brackets; it may have one", twice->seed));
  Members kept;
  for (const SeedBracket& bracket : sorted) {
    check(bracket);
    if (bracket.lower > 0 || bracket.upper < endless) kept.push_back({bracket.lower, bracket.upper});
  }
  return kept;
}

/// A bracket of logarithms, less a common one. The width comes from the ratio: a difference of logarithms would lose digits.
struct LogBracket {
  bool open_below, open_above;
  double middle;   // of an open one its only end
  double width;    // 0 of an open one
  double times;

  LogBracket(const Member& member, double reference)
      : open_below(member.open_below()), open_above(member.open_above()), times(member.times) {
    const double end = open_below ? member.upper : member.lower;
    width = open_below || open_above ? 0 : std::log1p((member.upper - member.lower) / member.lower);
    middle = std::log(end / reference) + width / 2;
  }
};

/// In alpha = mu/sigma and beta = 1/sigma.
struct Likelihood {
  double value = 0;   // its logarithm
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  Eigen::Matrix2d curvature = Eigen::Matrix2d::Zero();
};

Likelihood likelihood_of(std::span<const LogBracket> brackets, const Eigen::Vector2d& at) {
  Likelihood sum;
  for (const LogBracket& b : brackets) {
    const double z = b.middle * at[1] - at[0];
    const LogMass mass = b.open_below   ? log_mass_below(z)
                         : b.open_above ? log_mass_above(z)
                                        : log_mass_between(z, b.width * at[1]);
    const double crossed = -(b.middle * mass.mm + b.width * mass.mh);
    const double by_beta =
        b.middle * b.middle * mass.mm + 2 * b.middle * b.width * mass.mh + b.width * b.width * mass.hh;
    sum.value += b.times * mass.value;
    sum.slope += b.times * Eigen::Vector2d(-mass.m, b.middle * mass.m + b.width * mass.h);
    sum.curvature += b.times * (Eigen::Matrix2d() << mass.mm, crossed, crossed, by_beta).finished();
  }
  return sum;
}

/// Mean and spread of the brackets' middles; these differ wherever the brackets have no interval in common.
Eigen::Vector2d first_guess(std::span<const LogBracket> brackets) {
  double times = 0, mean = 0, square = 0;
  for (const LogBracket& b : brackets) times += b.times, mean += b.times * b.middle;
  mean /= times;
  for (const LogBracket& b : brackets) square += b.times * (b.middle - mean) * (b.middle - mean);
  const double beta = 1 / std::sqrt(square / times);
  return {mean * beta, beta};
}

/// Newton's method, a step halved until the likelihood grows as its slope lets expect. It has one maximum, since its
/// logarithm is concave in alpha and beta (Burridge, J. R. Stat. Soc. B 43 (1981) 41; Pratt, J. Am. Stat. Assoc. 76 (1981) 103).
Eigen::Vector2d maximum_of_likelihood(std::span<const LogBracket> brackets) {
  Eigen::Vector2d at = first_guess(brackets);
  Likelihood here = likelihood_of(brackets, at);
  for (int iteration = 0; iteration < 200; ++iteration) {
    const Eigen::Vector2d step = (-here.curvature).ldlt().solve(here.slope);
    const double square = here.slope.dot(step);   // of its length in standard errors
    const double rounding = 1e-12 * (1 + std::abs(here.value));
    for (double part = 1;; part /= 2) {
      if (!(part > 1e-12)) throw Error(ErrorKind::internal, "the fit of the threshold found no way up");
      const Eigen::Vector2d next = at + part * step;
      if (next[1] <= 0) continue;
      const Likelihood there = likelihood_of(brackets, next);
      if (!(there.value >= here.value + 0.1 * part * square - rounding)) continue;
      at = next, here = there;
      break;
    }
    if (square < rounding) return at;
  }
  throw Error(ErrorKind::internal, "the fit of the threshold came to no end in 200 steps");
}

/// Of brackets that have no interval in common.
ThresholdFit fit_with_width(const Members& sample) {
  const double reference = sample.front().open_below() ? sample.front().upper : sample.front().lower;
  std::vector<LogBracket> brackets;
  for (const Member& member : sample) brackets.emplace_back(member, reference);
  const Eigen::Vector2d best = maximum_of_likelihood(brackets);
  const double mu = best[0] / best[1], sigma = 1 / best[1];
  const double theta_50 = reference * std::exp(mu);
  return {.status = ThresholdStatus::bracketed,
          .theta_50 = theta_50,
          .theta_16 = reference * std::exp(mu - sigma),
          .theta_84 = reference * std::exp(mu + sigma),
          .width_resolved = true,
          .lower = theta_50,
          .upper = theta_50};
}

/// Whether the likelihood grows with the width for ever: all bounds are from one side, and the upper ones not above the lower
/// ones on the average. This is the slope in beta at beta = 0, where alpha gives both kinds their shares.
bool fits_no_width(const Members& sample) {
  double uppers = 0, lowers = 0, sum_upper = 0, sum_lower = 0;
  for (const Member& member : sample) {
    if (!member.open_below() && !member.open_above()) return false;
    if (member.open_below()) uppers += member.times, sum_upper += member.times * std::log(member.upper);
    else lowers += member.times, sum_lower += member.times * std::log(member.lower);
  }
  return sum_upper / uppers <= sum_lower / lowers;
}

ThresholdFit fit_of(const Members& sample) {
  double highest_lower = 0, lowest_upper = endless, lowest_lower = endless, highest_upper = 0;
  for (const Member& member : sample) {
    highest_lower = std::max(highest_lower, member.lower), lowest_lower = std::min(lowest_lower, member.lower);
    lowest_upper = std::min(lowest_upper, member.upper), highest_upper = std::max(highest_upper, member.upper);
  }
  if (sample.empty()) return {};
  if (highest_lower == 0) return {.status = ThresholdStatus::only_upper_bound, .upper = highest_upper};
  if (lowest_upper == endless) return {.status = ThresholdStatus::only_lower_bound, .lower = lowest_lower};
  if (highest_lower <= lowest_upper)
    return {.status = ThresholdStatus::bracketed,
            .theta_50 = std::sqrt(highest_lower * lowest_upper),
            .lower = highest_lower,
            .upper = lowest_upper};
  return fits_no_width(sample) ? ThresholdFit{} : fit_with_width(sample);
}

Members resample(const Members& all, std::uint32_t number) {
  RandomStream random(0, Stream::resampling, number);
  Members drawn = all;
  for (Member& member : drawn) member.times = 0;
  for (std::size_t k = 0; k < all.size(); ++k)
    ++drawn[static_cast<std::size_t>(random.uniform() * static_cast<double>(all.size()))].times;
  std::erase_if(drawn, [](const Member& member) { return member.times == 0; });
  return drawn;
}

ThresholdInterval interval_by_resampling(const Members& all) {
  std::vector<double> lower, upper;
  for (std::uint32_t number = 0; number < resamples; ++number) {
    const ThresholdFit fit = fit_of(resample(all, number));
    lower.push_back(fit.lower), upper.push_back(fit.upper);
  }
  std::ranges::sort(lower), std::ranges::sort(upper);
  const auto cut = static_cast<std::size_t>(share_beyond_each_end(all.size()) * resamples);
  return {lower[cut], upper[resamples - 1 - cut], 1 - 2 * tail};
}

/// The k-th lowest lower bound and the k-th highest upper one, k as large as lets fewer than k of n packings lie on one
/// side of their median with a probability of at most 2.5 %; 1 if no k does.
ThresholdInterval interval_by_rank(const Members& all) {
  const std::size_t n = all.size();
  if (n == 0) return {};
  std::vector<double> lower, upper;
  for (const Member& member : all) lower.push_back(member.lower), upper.push_back(member.upper);
  std::ranges::sort(lower), std::ranges::sort(upper);
  std::size_t k = 0;
  double log_term = -static_cast<double>(n) * std::numbers::ln2, fewer = std::exp(log_term);   // P(no more than k)
  while (fewer <= tail) {
    ++k;
    log_term += std::log(static_cast<double>(n - k + 1) / static_cast<double>(k));
    fewer += std::exp(log_term);
  }
  k = std::max<std::size_t>(k, 1);
  const double allowed = 1 - std::ldexp(2.0, -static_cast<int>(n));
  return {lower[k - 1], upper[n - k], std::min(allowed, 1 - 2 * tail)};
}

}   // namespace

double share_beyond_each_end(std::size_t seeds) {
  double low = 0, high = 16;   // t: 12.7 for one degree of freedom, less for more
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = (low + high) / 2;
    (student_within(middle, seeds - 1) < 1 - 2 * tail ? low : high) = middle;
  }
  const double n = static_cast<double>(seeds);
  return std::exp(log_normal_cdf(-low * std::sqrt(n / (n - 1))));
}

ThresholdFit fit_threshold(std::span<const SeedBracket> brackets) { return fit_of(members(brackets)); }

ThresholdInterval interval_of_threshold(std::span<const SeedBracket> brackets) {
  const Members all = members(brackets);
  const bool by_resampling = all.size() >= fewest_for_95 && fit_of(all).width_resolved;
  return by_resampling ? interval_by_resampling(all) : interval_by_rank(all);
}

bool enough_seeds(std::span<const SeedBracket> first_k, int batch, double wanted_relative_interval, int most) {
  if (batch < 1 || most < 1 || !(wanted_relative_interval > 0))
    throw Error(
        ErrorKind::study_invalid,
        fmt::format("seeds in batches of {}, at most {}, for an interval of {}: batch and most have to be 1 or more, "
                    "the interval positive",
                    batch, most, wanted_relative_interval));
  const std::size_t k = first_k.size();
  if (k >= static_cast<std::size_t>(most)) return true;
  if (k % static_cast<std::size_t>(batch) != 0) return false;
  const ThresholdFit fit = fit_threshold(first_k);
  if (fit.status != ThresholdStatus::bracketed) return false;
  const ThresholdInterval interval = interval_of_threshold(first_k);
  return interval.confidence >= 1 - 2 * tail &&
         (interval.upper - interval.lower) / 2 <= wanted_relative_interval * fit.theta_50;
}

}   // namespace bedload

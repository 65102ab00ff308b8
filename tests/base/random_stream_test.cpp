// Random streams: the published generator, and deviates with the distribution they promise.
#include "base/random_stream.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace bedload {
namespace {

/// Largest distance between the empirical distribution of the samples and `cdf`, times sqrt(n). Exceeds 1.95 with
/// probability 0.001 (Kolmogorov).
template <class Cdf>
double kolmogorov_smirnov(std::vector<double> samples, Cdf&& cdf) {
  std::ranges::sort(samples);
  const double n = static_cast<double>(samples.size());
  double distance = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double f = cdf(samples[i]);
    const double below = static_cast<double>(i) / n;
    distance = std::max({distance, f - below, below + 1 / n - f});
  }
  return distance * std::sqrt(n);
}

TEST(RandomStream, IsThePublishedPhilox) {
  // Known answers that come with Random123, the code of Salmon et al. (2011), for philox4x32 with 10 rounds.
  using Counter = std::array<std::uint32_t, 4>;
  EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}), (Counter{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox4x32({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
            (Counter{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Counter{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(RandomStream, IsAFunctionOfSeedStreamIdAndStep) {
  std::set<std::uint64_t> first_draws;
  for (const std::uint64_t seed : {1ull, 2ull, 1ull << 32}) {
    for (const Stream stream : {Stream::grain_diameter, Stream::grain_place}) {
      for (const std::uint32_t id : {0u, 1u, 0xffffffffu}) {
        for (const std::uint64_t step : {0ull, 1ull, 1ull << 32}) {
          EXPECT_EQ(RandomStream(seed, stream, id, step).bits(), RandomStream(seed, stream, id, step).bits());
          first_draws.insert(RandomStream(seed, stream, id, step).bits());
        }
      }
    }
  }
  EXPECT_EQ(first_draws.size(), 3u * 2 * 3 * 3);
}

TEST(RandomStream, DrawsUniformNumbersInsideTheUnitInterval) {
  RandomStream random(7, Stream::grain_place);
  std::vector<double> samples(100000);
  for (double& x : samples) x = random.uniform();
  EXPECT_GT(*std::ranges::min_element(samples), 0);
  EXPECT_LT(*std::ranges::max_element(samples), 1);
  EXPECT_LT(kolmogorov_smirnov(samples, [](double x) { return x; }), 1.95);
}

TEST(RandomStream, DrawsNormalNumbers) {
  std::vector<double> samples;
  for (std::uint32_t id = 0; id < 100000; ++id) samples.push_back(RandomStream(7, Stream::grain_diameter, id).normal());
  EXPECT_LT(kolmogorov_smirnov(samples, [](double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }), 1.95);
  // The far tail, where methods of approximation give up: P(|z| > 3) = 0.0026998, here 270 +- 4 * 16.4 of 100 000.
  const auto far = std::ranges::count_if(samples, [](double z) { return std::abs(z) > 3; });
  EXPECT_NEAR(static_cast<double>(far), 270, 66);
}

}   // namespace
}   // namespace bedload

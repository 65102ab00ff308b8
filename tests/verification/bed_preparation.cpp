// Beds as the program makes them against beds poured plainly: the same statistics, for less work. Two-sample tests over eight
// seeds, exact by permutation. The whole table of docs/decisions/bed_preparation.md:
//   test_verification --gtest_also_run_disabled_tests --gtest_filter='*BedPreparation*'
// (a quarter of an hour; without the large beds this is a matter of seconds).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "solver/bed/bed_surface.hpp"
#include "solver/grains/bed_packing.hpp"
#include "tests/support/plain_pouring.hpp"

namespace bedload::test {
namespace {

constexpr int seeds = 8;
constexpr double level = 0.01;   // of a wrong alarm in one table, shared by its tests

constexpr const char* names[] = {"solid fraction", "coordination", "of carriers", "rattlers",
                                 "roughness/d",    "height/d",     "phi 0-0.5 d", "phi 0.5-1 d",
                                 "phi 1-1.5 d",    "phi top d",    "phi second d"};
constexpr std::size_t statistics = std::size(names);
using Statistics = std::array<double, statistics>;
using Samples = std::vector<Statistics>;   // one row per seed

/// Grains with less than three contacts among those that have three and more, walls counted, carry nothing.
struct Carriers {
  double share, coordination;
};
Carriers carriers_of(const Grains& grains, const ContactHistory& contacts) {
  const std::size_t n = grains.size();
  std::vector<std::uint8_t> carries(n, 1);
  std::vector<int> touches;
  for (bool changed = true; changed;) {
    changed = false;
    touches.assign(n, 0);
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      const std::uint32_t a = contacts.lower[k], b = contacts.higher[k];
      if (!carries[a] || (b < n && !carries[b])) continue;
      ++touches[a];
      if (b < n) ++touches[b];
    }
    for (std::size_t i = 0; i < n; ++i)
      if (carries[i] && touches[i] < 3) carries[i] = 0, changed = true;
  }
  double count = 0, sum = 0;
  for (std::size_t i = 0; i < n; ++i)
    if (carries[i]) ++count, sum += touches[i];
  return {count / static_cast<double>(n), sum / count};
}

Statistics statistics_of(const BedScene& scene, const Grains& grains, const ContactHistory& contacts) {
  const double d = scene.grains.diameter;
  const BedSurface surface = bed_surface(grains, scene.length, d);
  const Carriers carriers = carriers_of(grains, contacts);
  const auto between = [&](double low, double high) {
    double volume = 0;
    for (std::size_t i = 0; i < grains.size(); ++i)
      volume += slice_volume(grains.diameter[i] / 2, low - grains.position[i].z, high - grains.position[i].z);
    return volume / (scene.length.x * scene.length.y * (high - low));
  };
  const double top = surface.height;
  return {1 - surface.porosity,         coordination(contacts, grains.fixed),
          carriers.coordination,        1 - carriers.share,
          surface.roughness / d,        top / d,
          between(0, 0.5 * d),          between(0.5 * d, d),
          between(d, 1.5 * d),          between(top - d, top),
          between(top - 2 * d, top - d)};
}

struct Made {
  Samples samples;
  double grain_steps = 0;
};

Made prepared(BedScene scene) {
  Made made;
  for (scene.source.seed = 1; scene.source.seed <= seeds; ++scene.source.seed) {
    Grains grains = place_grains(scene);
    ContactHistory contacts;
    BedPacking packing(scene);
    double time = 0;
    for (bool settled = false; !settled && time < packing.patience();) {
      const auto progress = packing.advance(grains, contacts);
      time += progress.dt, settled = progress.settled;
      made.grain_steps += static_cast<double>(progress.grain_steps);
    }
    EXPECT_LT(time, packing.patience());
    made.samples.push_back(statistics_of(scene, grains, contacts));
  }
  return made;
}

Made poured_plainly(BedScene scene) {
  Made made;
  for (scene.source.seed = 1; scene.source.seed <= seeds; ++scene.source.seed) {
    const PouredBed bed = pour_plainly(scene);
    EXPECT_TRUE(bed.settled);
    made.grain_steps += bed.grain_steps;
    made.samples.push_back(statistics_of(scene, bed.grains, bed.contacts));
  }
  return made;
}

/// Probabilities, were both samples of one distribution, of means as far apart as these, and of distributions (the greatest
/// distance of Kolmogorov and Smirnov): over all ways to deal the sixteen values out.
struct Probabilities {
  double means, distributions;
};
Probabilities two_sample(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> all(a);
  all.insert(all.end(), b.begin(), b.end());
  std::vector<std::size_t> order(all.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::sort(order, {}, [&](std::size_t i) { return all[i]; });
  const auto distances = [&](unsigned in_first) {
    double sum = 0, farthest = 0;
    int ahead = 0;
    for (std::size_t rank = 0; rank < order.size(); ++rank) {
      const int side = in_first >> order[rank] & 1u ? 1 : -1;
      sum += side * all[order[rank]], ahead += side;
      const bool tied = rank + 1 < order.size() && all[order[rank]] == all[order[rank + 1]];
      if (!tied) farthest = std::max(farthest, std::abs(static_cast<double>(ahead)));
    }
    return std::pair(std::abs(sum), farthest);
  };
  const auto [mean, farthest] = distances((1u << a.size()) - 1);
  double deals = 0, means = 0, distributions = 0;
  for (unsigned deal = 0; deal < 1u << all.size(); ++deal) {
    if (std::popcount(deal) != static_cast<int>(a.size())) continue;
    const auto [m, f] = distances(deal);
    ++deals, means += m >= mean * (1 - 1e-12), distributions += f >= farthest;
  }
  return {means / deals, distributions / deals};
}

std::vector<double> column(const Samples& samples, std::size_t which) {
  std::vector<double> values;
  for (const Statistics& row : samples) values.push_back(row[which]);
  return values;
}

std::pair<double, double> mean_and_deviation(const std::vector<double>& values) {
  double mean = 0, squares = 0;
  for (const double v : values) mean += v / static_cast<double>(values.size());
  for (const double v : values) squares += (v - mean) * (v - mean);
  return {mean, std::sqrt(squares / static_cast<double>(values.size() - 1))};
}

/// Smallest probability of the table, which is printed if asked for.
double smallest_probability(const Made& plain, const Made& ours, bool print) {
  double smallest = 1;
  for (std::size_t s = 0; s < statistics; ++s) {
    const auto a = column(plain.samples, s), b = column(ours.samples, s);
    const Probabilities p = two_sample(a, b);
    smallest = std::min({smallest, p.means, p.distributions});
    const auto [mean_a, deviation_a] = mean_and_deviation(a);
    const auto [mean_b, deviation_b] = mean_and_deviation(b);
    std::vector<double> change(seeds);
    for (std::size_t i = 0; i < change.size(); ++i) change[i] = b[i] - a[i];
    const auto [shift, scatter] = mean_and_deviation(change);
    if (print)
      fmt::print("| {} | {:.4f} +- {:.4f} | {:.4f} +- {:.4f} | {:+.4f} +- {:.4f} | {:.2f} | {:.2f} |\n", names[s],
                 mean_a, deviation_a, mean_b, deviation_b, shift, scatter / std::sqrt(seeds), p.means, p.distributions);
  }
  if (print) fmt::print("grain-steps: {:.3f} of plain pouring's\n", ours.grain_steps / plain.grain_steps);
  return smallest;
}

constexpr double level_of_one_test = level / (2 * statistics);

/// Quartz-like grains of 0.5 mm in a laminar liquid, 10 x 8 d.
BedScene small_bed(double friction, double spread, Side across = Side::periodic) {
  const double d = 0.5e-3;
  BedScene scene;
  scene.fluid = {1000, 1e-5};
  scene.grains = {d, 2500, spread, friction, 0.6, 0.3, 0};
  scene.source = {BedSource::Kind::poured, 350, "", 1};
  scene.length = {10 * d, 8 * d, 11 * d};
  scene.sides = {across, across, Side::wall};
  scene.gravity = {0, 0, -9.81};
  scene.grains.young_modulus = automatic_young_modulus(scene, bed_layers(scene));
  scene.dem_step = 0.2 * rayleigh_time(d * (1 - 2 * spread), 2500, scene.grains.young_modulus, 0.3);
  return scene;
}

/// The first case of studies/examples/quickstart.toml.
BedScene quickstart_bed() {
  BedScene scene = small_bed(0.4, 0.05);
  const double d = scene.grains.diameter;
  scene.grains.density = 2000;
  scene.source.count = 1500;
  scene.length = {20 * d, 12 * d, 13 * d};
  scene.grains.young_modulus = automatic_young_modulus(scene, bed_layers(scene));
  scene.dem_step = 0.2 * rayleigh_time(d * (1 - 2 * scene.grains.spread), 2000, scene.grains.young_modulus, 0.3);
  return scene;
}

/// studies/examples/seed-erosion.toml, by share of its area.
BedScene seed_bed(double friction, double spread, double share) {
  const double d = 1e-3, edge = std::sqrt(share);
  BedScene scene;
  scene.fluid = {1000, 1e-6};
  scene.grains = {d, 3000, spread, friction, 0.6, 0.3, 1.2e7};
  scene.source = {BedSource::Kind::poured, static_cast<std::uint64_t>(std::lround(20000 * share)), "", 1};
  scene.length = {60 * d * edge, 30 * d * edge, 20 * d};
  scene.sides = {Side::periodic, Side::periodic, Side::wall};
  scene.gravity = {0, 0, -9.81};
  scene.dem_step = 1e-5 * (1 - 2 * spread);
  return scene;
}

struct Bed {
  const char* name;
  BedScene scene;
};
std::ostream& operator<<(std::ostream& out, const Bed& bed) { return out << bed.name; }
const auto name_of = [](const auto& info) { return info.param.name; };

class BedPreparation : public testing::TestWithParam<Bed> {};

TEST_P(BedPreparation, MakesBedsLikePlainPouringForLessThanTwoThirdsOfItsWork) {
  const Made plain = poured_plainly(GetParam().scene), ours = prepared(GetParam().scene);
  EXPECT_GT(smallest_probability(plain, ours, true), level_of_one_test);
  EXPECT_LT(ours.grain_steps, plain.grain_steps * 2 / 3);
}

INSTANTIATE_TEST_SUITE_P(Small, BedPreparation,
                         testing::Values(Bed{"Rough", small_bed(0.4, 0.05)}, Bed{"SmoothEqual", small_bed(0.1, 0)},
                                         Bed{"BetweenWalls", small_bed(0.4, 0.05, Side::wall)}),
                         name_of);
INSTANTIATE_TEST_SUITE_P(DISABLED_Large, BedPreparation,
                         testing::Values(Bed{"Quickstart", quickstart_bed()}, Bed{"Seed", seed_bed(0.4, 0, 1)},
                                         Bed{"FifthOfSeed", seed_bed(0.4, 0, 0.2)},
                                         Bed{"FifthOfSeedUnequal", seed_bed(0.4, 0.05, 0.2)},
                                         Bed{"FifthOfSeedSmooth", seed_bed(0.1, 0, 0.2)}),
                         name_of);

TEST(BedStatistics, TellBedsOfOtherFrictionApart) {
  const Made rough = prepared(small_bed(0.4, 0.05)), smooth = prepared(small_bed(0.1, 0.05));
  EXPECT_LT(smallest_probability(rough, smooth, false), level_of_one_test);
}

}   // namespace
}   // namespace bedload::test

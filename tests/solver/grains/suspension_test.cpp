#include "solver/grains/suspension.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "solver/grains/bed_packing.hpp"
#include "solver/grains/box_walls.hpp"

namespace bedload {
namespace {

constexpr double d = 1e-3, edge = 10 * d;

BedScene box_of(double solid_fraction, double spread = 0) {
  BedScene scene;
  scene.grains = {.diameter = d, .density = 2000, .spread = spread};
  scene.length = {edge, edge, edge};
  scene.sides = {Side::periodic, Side::periodic, Side::periodic};
  scene.source = {.kind = BedSource::Kind::suspension, .seed = 3};
  scene.source.count = static_cast<std::uint64_t>(std::round(solid_fraction * edge * edge * edge / sphere_volume(d)));
  return scene;
}

double closest_gap(const BedScene& scene, const Grains& grains) {
  const PeriodicBox box(scene);
  double closest = 1;
  for (std::size_t i = 0; i < grains.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double apart = norm(box.shortest(grains.position[i] - grains.position[j]));
      closest = std::min(closest, apart - 0.5 * (grains.diameter[i] + grains.diameter[j]));
    }
  return closest;
}

TEST(Suspension, GrainsDoNotTouchAtAnySolidFraction) {
  for (const double phi : {0.001, 0.05, 0.3, 0.5, 0.6}) {
    const auto scene = box_of(phi);
    const auto grains = place_grains(scene);
    ASSERT_EQ(grains.size(), scene.source.count);
    EXPECT_GE(closest_gap(scene, grains), 0) << phi;
  }
}

TEST(Suspension, DoesNotTouchWallsEither) {
  auto scene = box_of(0.3, 0.1);
  scene.sides = {Side::wall, Side::periodic, Side::wall};
  const auto grains = place_grains(scene);
  EXPECT_GE(closest_gap(scene, grains), 0);
  for (std::size_t i = 0; i < grains.size(); ++i)
    for (const int c : {0, 2}) {
      EXPECT_GE(grains.position[i][c], 0.5 * grains.diameter[i]);
      EXPECT_LE(grains.position[i][c], edge - 0.5 * grains.diameter[i]);
    }
}

/// The strongest of the scattering peaks that the crystal of the start would show: |sum exp(i k x)|^2/N, N for a crystal
/// and about one for disorder. For 573 grains at phi 0.3 the crystal has 6 cells along each edge.
TEST(Suspension, LosesTheOrderOfItsCrystal) {
  const auto grains = place_grains(box_of(0.3));
  for (int cells = 5; cells <= 7; ++cells)
    for (const auto [a, b, c] : {std::array{1, 1, 1}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}}) {
      std::complex<double> sum;
      for (const Vec3& x : grains.position)
        sum += std::polar(1.0, 2 * std::numbers::pi * cells / edge * (a * x.x + b * x.y + c * x.z));
      EXPECT_LT(std::norm(sum) / double(grains.size()), 15) << cells << ": " << a << b << c;
    }
}

TEST(Suspension, IsAFunctionOfItsSeed) {
  auto scene = box_of(0.2);
  const auto once = place_grains(scene);
  EXPECT_EQ(once, place_grains(scene));
  scene.source.seed = 4;
  EXPECT_NE(once.position, place_grains(scene).position);
}

TEST(Suspension, FixedOnesNeverMove) {
  auto scene = box_of(0.1);
  EXPECT_TRUE(std::ranges::all_of(place_grains(scene).fixed, [](auto f) { return f == 0; }));
  scene.source.fixed = true;
  EXPECT_TRUE(std::ranges::all_of(place_grains(scene).fixed, [](auto f) { return f == 1; }));
}

TEST(Suspension, RefusesMoreThanACrystalHolds) { EXPECT_THROW(place_grains(box_of(0.76)), Error); }

}   // namespace
}   // namespace bedload

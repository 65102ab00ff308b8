// Slices of spheres, the level of a known slab, roughness of known heights, counted contacts.
#include "solver/bed/bed_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

namespace bedload {
namespace {

void add(Grains& grains, Vec3 at, double diameter) {
  grains.resize(grains.size() + 1);
  grains.position.back() = at;
  grains.diameter.back() = diameter;
}

/// Simple cubic stack of nx x ny x nz touching spheres of diameter d on the bottom.
Grains cubic_stack(int nx, int ny, int nz, double d) {
  Grains grains;
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j)
      for (int k = 0; k < nz; ++k) add(grains, {(i + 0.5) * d, (j + 0.5) * d, (k + 0.5) * d}, d);
  return grains;
}

TEST(SphereSlices, IntegrateToTheVolume) {
  const double radius = 0.37;
  double volume = 0;
  for (int k = -50; k < 50; ++k) volume += slice_volume(radius, 0.01 * k, 0.01 * (k + 1));
  EXPECT_NEAR(volume, sphere_volume(2 * radius), 1e-14);
}

TEST(SphereSlices, HalveAtTheEquatorAndMatchTheCapFormula) {
  EXPECT_DOUBLE_EQ(slice_volume(2, -5, 0), sphere_volume(4) / 2);
  const double rise = 0.3;   // cap of height h: pi h^2 (3R - h)/3
  EXPECT_NEAR(slice_volume(1, 1 - rise, 1), std::numbers::pi * rise * rise * (3 - rise) / 3, 1e-15);
}

TEST(SolidFraction, HoldsTheVolumeOfTheGrainsWhateverTheLayers) {
  Grains grains;
  for (int n = 0; n < 40; ++n) add(grains, {0.1 * n, 0.05 * n, 0.55 + 0.11 * n}, 0.8 + 0.01 * n);
  const double solid = std::accumulate(grains.diameter.begin(), grains.diameter.end(), 0.0,
                                       [](double sum, double d) { return sum + sphere_volume(d); });
  for (const std::size_t bins : {1u, 7u, 64u, 501u}) {
    const auto phi = solid_fraction(grains, {4, 5, 6}, bins);
    const double total = std::accumulate(phi.begin(), phi.end(), 0.0) * 4 * 5 * 6 / double(bins);
    EXPECT_NEAR(total, solid, 1e-12 * solid) << bins;
  }
}

TEST(BedSurfaceLevel, OfACubicStackLiesInItsTopLayer) {
  // phi of a plane through a cubic layer is pi (1/4 - x^2), x from its middle plane in d; the bulk's is pi/6.
  const double d = 1e-3;
  const BedSurface surface = bed_surface(cubic_stack(8, 8, 6, d), {8 * d, 8 * d, 12 * d}, d);
  const double above_middle = std::sqrt(0.25 - 1.0 / 12);
  EXPECT_NEAR(surface.height, (5.5 + above_middle) * d, 0.01 * d);   // layers of d/10, linear between them
  EXPECT_NEAR(surface.porosity, 1 - std::numbers::pi / 6, 0.01);
}

TEST(BedSurfaceLevel, IgnoresGrainsThatFly) {
  const double d = 1e-3;
  Grains grains = cubic_stack(8, 8, 6, d);
  const double before = bed_surface(grains, {8 * d, 8 * d, 12 * d}, d).height;
  add(grains, {4 * d, 4 * d, 10 * d}, d);
  EXPECT_NEAR(bed_surface(grains, {8 * d, 8 * d, 12 * d}, d).height, before, 0.01 * d);
}

TEST(BedSurfaceLevel, IsTheBottomWhereThereIsNoBed) {
  Grains grains;
  EXPECT_EQ(bed_surface(grains, {1, 1, 1}, 0.1).height, 0);
  add(grains, {0.5, 0.5, 0.7}, 0.1);
  EXPECT_EQ(bed_surface(grains, {1, 1, 1}, 0.1).height, 0);
  EXPECT_EQ(bed_surface(grains, {1, 1, 1}, 0.1).porosity, 1);
}

TEST(BedRoughness, IsThatOfTwoKnownTerraces) {
  // One more layer on half of the stack: elevations differ by d between halves, so the variance grows by d^2/4.
  const double d = 1e-3;
  const Vec3 box{8 * d, 8 * d, 12 * d};
  const double level = bed_surface(cubic_stack(8, 8, 6, d), box, d).roughness;
  Grains terraces = cubic_stack(8, 8, 6, d);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 8; ++j) add(terraces, {(i + 0.5) * d, (j + 0.5) * d, 6.5 * d}, d);
  EXPECT_NEAR(bed_surface(terraces, box, d).roughness, std::hypot(level, d / 2), 1e-9 * d);
}

TEST(BedSlope, IsThatOfAStaircaseOfPlateaus) {
  // Plateaus of equal shape at heights f(i) d: plain regression over them, their own shape being even about their middles.
  const double d = 1e-3;
  const Vec3 box{8 * d, 4 * d, 20 * d};
  Grains stairs;
  double mean = 0, moment = 0, squares = 0;
  for (int i = 0; i < 8; ++i) {
    const int layers = 3 + (i * i) / 7;
    for (int j = 0; j < 4; ++j)
      for (int k = 0; k < layers; ++k) add(stairs, {(i + 0.5) * d, (j + 0.5) * d, (k + 0.5) * d}, d);
    moment += (i - 3.5) * layers, mean += layers / 8.0;
    for (const double off : {-0.25, 0.25}) squares += (i - 3.5 + off) * (i - 3.5 + off) / 2;
  }
  const BedSurface surface = bed_surface(stairs, box, d);
  EXPECT_NEAR(surface.slope, moment / squares, 1e-9);
  // four columns over each grain, at (d/4, d/4) from its axis
  EXPECT_NEAR(surface.top, (mean - 0.5 + std::sqrt(0.25 - 2.0 / 16)) * d, 1e-9 * d);
}

TEST(BearingCoordination, LeavesOutRattlersAndWhatHangsOnThem) {
  ContactHistory
      contacts;   // a triangle 0 1 2, a chain 2-3-4 that ends, a grain 5 between bottom and 0, 6 on the bottom alone
  const auto bottom = static_cast<std::uint32_t>(Wall::z_low);
  contacts.lower = {0, 0, 0, 1, 2, 3, 5, 6};
  contacts.higher = {1, 2, 5, 2, 3, 4, bottom, bottom};
  EXPECT_DOUBLE_EQ(bearing_coordination(contacts, std::vector<std::uint8_t>(8)), 2.0 * 4 / 4);   // 0, 1, 2, 5
  EXPECT_EQ(bearing_coordination({}, std::vector<std::uint8_t>(3)), 0);
  EXPECT_EQ(bearing_coordination({}, std::vector<std::uint8_t>()), 0);
}

TEST(Coordination, CountsBothPartnersAndNoWalls) {
  ContactHistory contacts;
  contacts.lower = {0, 0, 1, 2};
  contacts.higher = {1, 2, 2, static_cast<std::uint32_t>(Wall::z_low)};
  EXPECT_DOUBLE_EQ(coordination(contacts, std::vector<std::uint8_t>(4)), 6.0 / 4);
  EXPECT_EQ(coordination({}, std::vector<std::uint8_t>()), 0);
}

/// A bead (3) in a pocket of three fixed grains, one (4) on a single fixed grain, two frozen ones (5, 6) that only wait.
TEST(Coordination, IsOfGrainsThatCanMoveAndFixedOnesBear) {
  ContactHistory contacts;
  contacts.lower = {0, 1, 2, 2, 3, 5};
  contacts.higher = {3, 3, 3, 4, 5, 6};
  const std::vector<std::uint8_t> fixed{1, 1, 1, 0, 0, 2, 2};
  EXPECT_DOUBLE_EQ(coordination(contacts, fixed), (4 + 1 + 2 + 1) / 4.0);
  EXPECT_DOUBLE_EQ(bearing_coordination(contacts, fixed), 3.0)
      << "6 hangs on 5, 5 then on the bead alone, 4 is a rattler";
}

}   // namespace
}   // namespace bedload

// Exposure: who shelters whom, and the velocity that the exposed part meets.
#include <gtest/gtest.h>

#include <numbers>

#include "solver/coupling/exposure.hpp"

namespace bedload {
namespace {

PeriodicBox box_of(double length) {
  BedScene scene;
  scene.length = {length, length, length};
  scene.sides = {Side::periodic, Side::periodic, Side::wall};
  return PeriodicBox(scene);
}
Grains grains_at(std::vector<Vec3> places, double diameter = 1) {
  Grains grains;
  grains.resize(places.size());
  grains.position = std::move(places);
  std::fill(grains.diameter.begin(), grains.diameter.end(), diameter);
  return grains;
}

/// A square layer of touching grains, n x n, periodic, at height z; then one more.
Grains on_a_layer(int n, Vec3 one_more) {
  std::vector<Vec3> places;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) places.push_back({i + 0.5, j + 0.5, 0.5});
  places.push_back(one_more);
  return grains_at(places);
}

TEST(Exposure, AMomentIsTheIntegralOverTheExposedFrontalArea) {
  for (const double level : {-1.0, -0.7, 0.0, 0.3, 0.9, 1.0}) {
    double integral = 0;   // over heights z of z x chord, of a circle of radius 1, over its area
    const int n = 20000;
    for (int i = 0; i < n; ++i) {
      const double z = level + (1 - level) * (i + 0.5) / n;
      integral += z * 2 * std::sqrt(1 - z * z) * (1 - level) / n / std::numbers::pi;
    }
    EXPECT_NEAR(exposed_moment(level), integral, 1e-5) << level;
  }
  EXPECT_EQ(exposed_moment(-1), 0);   // a sphere that stands free: the shear cancels
  EXPECT_EQ(exposed_moment(1), 0);
  EXPECT_EQ(exposed_moment(2), 0);
  EXPECT_EQ(exposed_moment(-3), 0);
}

TEST(Exposure, VelocityPointsAlongTheShearAndScales) {
  const Vec3 u = exposure_velocity(0, 2e-3, {0, 10, 0});   // u = 10 z along x
  EXPECT_NEAR(u.x, 1e-3 * 10 * 2 / (3 * std::numbers::pi), 1e-15);
  EXPECT_EQ(u.y, 0);
  EXPECT_EQ(exposure_velocity(0, 2e-3, {-10, 0, 0}).y, u.x);   // v = 10 z along y has the vorticity (-10, 0, 0)
  EXPECT_EQ(exposure_velocity(0, 2e-3, {0, -10, 0}).x, -u.x);
  EXPECT_EQ(exposure_velocity(0, 2e-3, {0, 0, 10}), Vec3{});   // no vertical shear
}

TEST(Exposure, ALoneGrainStandsFree) {
  Sheltering sheltering;
  EXPECT_EQ(sheltering.find(box_of(10), grains_at({{5, 5, 0.5}}))[0], -1);
  EXPECT_EQ(sheltering.find(box_of(10), grains_at({{5, 5, 0.5}, {7.1, 5, 0.5}}))[0], -1);   // the other is too far
}

TEST(Exposure, AGrainOfALevelLayerIsShelteredToItsTop) {
  Sheltering sheltering;
  const auto level = sheltering.find(box_of(6), on_a_layer(6, {3, 3, 4}));
  EXPECT_EQ(level[0], 1);   // in the corner of the box: its neighbours are across the seam
  EXPECT_EQ(level[20], 1);
  EXPECT_EQ(level[36], -1);   // far above
}

TEST(Exposure, AGrainOfAHexagonalLayerIsShelteredToItsTop) {
  std::vector<Vec3> places;
  const double row = std::sqrt(0.75);
  for (int j = 0; j < 7; ++j)
    for (int i = 0; i < 7; ++i) places.push_back({20 + i + 0.5 * (j % 2), 20 + row * j, 0.5});
  Sheltering sheltering;
  EXPECT_EQ(sheltering.find(box_of(50), grains_at(places))[24], 1);   // the middle one
}

TEST(Exposure, AGrainInAPocketOfASquareLayerIsShelteredToTheTopsOfItsSupports) {
  // Rests on four touching grains: centre 1/sqrt 2 above theirs, so that their tops are 0.414 radii below it.
  Sheltering sheltering;
  const auto level = sheltering.find(box_of(6), on_a_layer(6, {3, 3, 0.5 + std::sqrt(0.5)}));
  EXPECT_NEAR(level[36], 1 - std::sqrt(2), 1e-12);
  EXPECT_EQ(level[14], 1);   // one of them: level with the layer
}

TEST(Exposure, DoesNotDependOnTheOrderOfGrainsNorOnTheSeam) {
  const Grains grains = grains_at({{0.1, 5, 0.5}, {9.3, 5.2, 0.7}, {0.8, 5.7, 0.4}, {0.3, 4.2, 0.6}});
  Sheltering sheltering;
  const auto found = sheltering.find(box_of(10), grains);
  const std::vector<double> level(found.begin(), found.end());
  std::vector<Vec3> moved;
  for (const std::size_t p : {2, 0, 3, 1}) moved.push_back(grains.position[p] + Vec3{4, 2, 0});
  const auto other = sheltering.find(box_of(10), grains_at(moved));
  EXPECT_NEAR(other[0], level[2], 1e-12);
  EXPECT_NEAR(other[1], level[0], 1e-12);
  EXPECT_NEAR(other[2], level[3], 1e-12);
  EXPECT_NEAR(other[3], level[1], 1e-12);
  EXPECT_GT(level[0], -1);
}

TEST(Exposure, ASmallGrainBehindALargeOneIsHidden) {
  Grains grains = grains_at({{4.2, 5, 0.25}, {5, 5, 0.5}});
  grains.diameter[0] = 0.5;
  Sheltering sheltering;
  const auto level = sheltering.find(box_of(10), grains);
  // The large one fills 77 degrees of the small one's horizon, 4 of 16 directions, above its top; the small one 36 degrees,
  // 2 directions, with its top at the height of the large one's centre.
  EXPECT_NEAR(level[0], (4 * 1 - 12) / 16.0, 1e-12);
  EXPECT_NEAR(level[1], (2 * 0 - 14) / 16.0, 1e-12);
}

TEST(Exposure, GrainsThatMoveFindWhatAFreshSearchFinds) {
  Grains grains = grains_at({{5, 5, 0.5}, {9.9, 5.1, 0.7}, {5, 8.5, 0.9}});
  Sheltering kept;
  std::size_t met = 0;
  for (int step = 0; step < 200; ++step) {
    grains.position[1].x += 0.043;   // across the seam, and by the first
    if (grains.position[1].x >= 10) grains.position[1].x -= 10;
    grains.position[2].y -= 0.011;
    Sheltering fresh;
    const auto level = kept.find(box_of(10), grains), expected = fresh.find(box_of(10), grains);
    for (std::size_t p = 0; p < grains.size(); ++p) EXPECT_EQ(level[p], expected[p]) << step << ' ' << p;
    met += level[0] > -1;
  }
  EXPECT_GT(met, 20u);
  EXPECT_LT(met, 190u);
  grains.diameter[2] = 4;   // as large, it shelters where it did not
  Sheltering fresh;
  EXPECT_EQ(kept.find(box_of(10), grains)[0], fresh.find(box_of(10), grains)[0]);
}

}   // namespace
}   // namespace bedload

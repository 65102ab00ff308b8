// Profiles of a linear flow over a known layer of grains.
#include "solver/bed/bed_profiles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace bedload {
namespace {

StaggeredGrid box() {
  return {.cells = {4, 4, 8}, .h = {1, 1, 0.5}, .sides = {Side::periodic, Side::periodic, Side::wall}};
}

FluidState linear_flow(const StaggeredGrid& grid, double shear) {
  FluidState fluid(grid);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      for (int k = 0; k < 8; ++k) fluid.velocity.x[grid.index(i, j, k)] = shear * (k + 0.5) * grid.h.z;
  return fluid;
}

TEST(BedProfiles, ReproduceALinearFlowUpToBothWalls) {
  const StaggeredGrid grid = box();
  BedRecord::Profiles out;
  ProfileSums sums;
  add_instant({}, linear_flow(grid, 3), grid, 1, 12, sums);
  record_profiles(sums, grid.length(), 7, out);
  ASSERT_EQ(out.z.size(), 16u);
  for (std::size_t k = 0; k < out.z.size(); ++k) {
    EXPECT_NEAR(out.fluid_velocity[k], 3 * out.z[k], 1e-12);
    EXPECT_EQ(out.porosity[k], 1);
    EXPECT_EQ(out.hold[k], 7);
  }
}

TEST(BedProfiles, WeighGrainVelocitiesBySlices) {
  const StaggeredGrid grid = box();
  Grains grains;
  grains.resize(2);
  grains.position = {{1, 1, 0.5}, {3, 3, 0.5}};
  grains.velocity = {{2, 0, 5}, {4, 0, 1}};
  grains.diameter = {1, 1};
  BedRecord::Profiles out;
  ProfileSums sums;
  add_instant(grains, FluidState(grid), grid, 1, 0, sums);
  record_profiles(sums, grid.length(), 0, out);
  double solid = 0;
  for (std::size_t k = 0; k < out.z.size(); ++k) {
    solid += (1 - out.porosity[k]) * 16 * 0.25;
    EXPECT_NEAR(out.grain_velocity[k], out.z[k] < 1 ? 3 : 0, 1e-12);
    EXPECT_NEAR(out.granular_temperature[k], out.z[k] < 1 ? (1.0 + 4) / 3 : 0,
                1e-12);   // fluctuations (-1, 2), (1, -2)
  }
  EXPECT_NEAR(solid, 2 * sphere_volume(1), 1e-12);
}

TEST(BedProfiles, AreMeansOverTheirInstants) {
  const StaggeredGrid grid = box();
  Grains grains;
  grains.resize(1);
  grains.position = {{1, 1, 0.5}};
  grains.velocity = {{2, 0, 0}};
  grains.diameter = {1};
  ProfileSums sums;
  add_instant(grains, linear_flow(grid, 3), grid, 1, 12, sums);
  grains.position[0].z = 2.5;   // where it was, half of the time there is none
  grains.velocity[0].x = 5;
  add_instant(grains, linear_flow(grid, 1), grid, 1, 4, sums);
  grains.velocity[0].x = 8;
  for (int n = 0; n < 2; ++n) add_instant(grains, linear_flow(grid, 1), grid, 1, 4, sums);
  BedRecord::Profiles out;
  record_profiles(sums, grid.length(), 0, out);
  double solid = 0;
  for (std::size_t k = 0; k < out.z.size(); ++k) {
    const double z = out.z[k];
    solid += (1 - out.porosity[k]) * 16 * 0.25;
    EXPECT_NEAR(out.fluid_velocity[k], 1.5 * z, 1e-12);
    EXPECT_NEAR(out.grain_velocity[k], z < 1 ? 2 : z > 2 && z < 3 ? 7 : 0, 1e-12);             // 5, 8, 8
    EXPECT_NEAR(out.granular_temperature[k], z > 2 && z < 3 ? (4 + 1 + 1) / 9.0 : 0, 1e-12);   // about the mean in time
  }
  EXPECT_NEAR(solid, sphere_volume(1), 1e-12);
}

/// Layers of 0.01 with phi = 0.6 below z = 1 and 0.6 exp(-(z - 1)/0.3) above, P_s falls likewise. Sheared as v_x = (z - 0.5)^2 from 0.5 up.
TEST(BedProfiles, FindTheLevelWhereTheWeightAboveIsShearedHardest) {
  std::vector<double> z, porosity, velocity;
  for (int k = 0; k < 300; ++k) {
    z.push_back((k + 0.5) * 0.01);
    porosity.push_back(1 - 0.6 * std::exp(-std::max(0.0, z.back() - 1) / 0.3));
    velocity.push_back(z.back() > 0.5 ? (z.back() - 0.5) * (z.back() - 0.5) : 0);
  }
  // P_s ~ 1 - z + 0.3 below 1, 0.3 exp(-(z - 1)/0.3) above; times z - 0.5: largest at (1.3 + 0.5)/2 = 0.9.
  EXPECT_NEAR(rebound_level(z, porosity, velocity), 0.9, 2e-3);
}

TEST(BedProfiles, HaveNoLevelOfReboundsWhereNothingIsSheared) {
  const std::vector<double> z{0.5, 1.5, 2.5, 3.5}, porosity{0.4, 0.4, 0.5, 1}, still(4), lone{0, 0, 0, 7};
  EXPECT_TRUE(std::isnan(rebound_level(z, porosity, still)));
  EXPECT_TRUE(std::isnan(rebound_level(z, porosity, lone)));   // no grains there
  EXPECT_TRUE(std::isnan(rebound_level({}, {}, {})));
}

}   // namespace
}   // namespace bedload

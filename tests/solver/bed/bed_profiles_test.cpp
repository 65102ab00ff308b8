// Profiles of a linear flow over a known layer of grains.
#include "solver/bed/bed_profiles.hpp"

#include <gtest/gtest.h>

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
  record_profiles({}, linear_flow(grid, 3), grid, 1, 12, 7, out);
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
  record_profiles(grains, FluidState(grid), grid, 1, 0, 0, out);
  double solid = 0;
  for (std::size_t k = 0; k < out.z.size(); ++k) {
    solid += (1 - out.porosity[k]) * 16 * 0.25;
    EXPECT_NEAR(out.grain_velocity[k], out.z[k] < 1 ? 3 : 0, 1e-12);
    EXPECT_NEAR(out.granular_temperature[k], out.z[k] < 1 ? (1.0 + 4) / 3 : 0,
                1e-12);   // fluctuations (-1, 2), (1, -2)
  }
  EXPECT_NEAR(solid, 2 * sphere_volume(1), 1e-12);
}

}   // namespace
}   // namespace bedload

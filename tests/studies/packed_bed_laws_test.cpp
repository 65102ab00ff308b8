// The published laws against values worked out by hand.
#include "studies/packed_bed_laws.hpp"

#include <gtest/gtest.h>

namespace bedload {
namespace {

TEST(PackedBedLaws, GiveTheGradientOfABed) {
  // 150 0.6^2/0.4^3 + 1.75 0.6 Re/0.4^3
  EXPECT_NEAR(gradient_per_flux("ergun", 0.4, 1), 843.75 + 16.40625, 1e-9);
  EXPECT_NEAR(gradient_per_flux("ergun", 0.4, 100), 843.75 + 1640.625, 1e-9);
  // 18 0.6 (5.43^2/24) 0.4^-(3.7 - 0.65 exp(-1.5^2/2) + 1)
  EXPECT_NEAR(gradient_per_flux("di_felice", 0.4, 1), 811.3, 0.5);
  EXPECT_NEAR(gradient_per_flux("di_felice", 0.4, 100), 2432, 1);
}

TEST(PackedBedLaws, AreDallavallesDragForALoneSphere) {
  EXPECT_NEAR(di_felice(1, 100), 1.11 * 1.11 * 100 / 24, 1e-12);
  EXPECT_NEAR(di_felice(1, 1e-8), 0.96, 1e-4);   // 4.8^2/24: not quite Stokes'
}

TEST(ZeroOfRising, IsFoundToRoundOff) {
  EXPECT_NEAR(zero_of_rising([](double x) { return x * x - 2; }, 0, 2), 1.4142135623730951, 1e-15);
  EXPECT_EQ(zero_of_rising([](double x) { return x - 3; }, 0, 2), 2);
}

}   // namespace
}   // namespace bedload

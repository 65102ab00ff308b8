// Drag laws: limits, published values, terminal speeds.
#include <gtest/gtest.h>

#include "solver/coupling/drag_laws.hpp"

namespace bedload {
namespace {

TEST(DragLaws, TendToStokesForALoneSlowGrain) {
  EXPECT_EQ(Stokes{}.multiplier(1, 1e-9), 1);
  EXPECT_NEAR(SchillerNaumann{}.multiplier(1, 1e-9), 1, 1e-6);
  // Dallavalle's coefficient is 24 x 0.96/Re in the limit: 4.8^2/24.
  EXPECT_NEAR(DiFelice{}.multiplier(1, 1e-9), 4.8 * 4.8 / 24, 1e-4);
}

TEST(DragLaws, DiFeliceGivesItsTabulatedMultipliers) {
  // phi, Re, F: evaluated independently from the published formula, four digits.
  const double table[][3] = {{0.01, 1, 1.272},    {0.10, 0.01, 1.455}, {0.10, 10, 2.672}, {0.30, 0.01, 3.686},
                             {0.30, 10, 5.863},   {0.50, 0.01, 12.79}, {0.50, 10, 16.79}, {0.50, 100, 44.83},
                             {0.60, 0.01, 29.20}, {0.60, 1, 30.05},    {0.60, 100, 90.06}};
  for (const auto& [phi, re, f] : table)
    EXPECT_NEAR(DiFelice{}.multiplier(1 - phi, re) / f, 1, 5e-4) << phi << " " << re;
}

TEST(DragLaws, SchillerNaumannMeetsNewtonsPlateauNearRe1000) {
  EXPECT_NEAR(SchillerNaumann{}.multiplier(1, 999.9) / SchillerNaumann{}.multiplier(1, 1000.1), 1, 0.02);
}

TEST(DragLaws, GrowWithPackingAndReynoldsNumber) {
  for (const double re : {0.0, 1e-7, 0.1, 10.0, 500.0}) {
    EXPECT_GT(DiFelice{}.multiplier(0.4, re), DiFelice{}.multiplier(0.6, re));
    EXPECT_GT(DiFelice{}.multiplier(0.6, 2 * re + 0.1), DiFelice{}.multiplier(0.6, re));
    EXPECT_TRUE(std::isfinite(DiFelice{}.multiplier(0.26, re)));
  }
}

TEST(DragLaws, SettleALoneGrainAtTheirPublishedSpeed) {
  // d 0.1 mm, 3000 kg/m3 in water: physics reference values, seven digits.
  const auto speed = [](DragLawName law) { return terminal_speed(law, 1e-6, 3, 1e-4, 9.81); };
  EXPECT_NEAR(speed(DragLawName::stokes), 1.090000e-2, 1e-8);
  EXPECT_NEAR(speed(DragLawName::schiller_naumann), 9.519559e-3, 1e-8);
  EXPECT_NEAR(speed(DragLawName::di_felice), 8.981035e-3, 1e-8);
}

}   // namespace
}   // namespace bedload

#include "solver/fluid/wall_law.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace bedload {
namespace {

TEST(WallLaw, IsTheViscousStressUpToElevenWallUnits) {
  const double nu = 1e-6, y = 2e-4;
  for (double y_plus : {1e-3, 1.0, 5.0, 11.0}) {
    const double speed = y_plus * y_plus * nu / y;   // u+ = y+
    EXPECT_EQ(wall_stress(speed, y, nu, 0), nu * speed / y) << y_plus;
  }
}

TEST(WallLaw, OfASmoothWallIsTheLogLawBeyond) {
  const double nu = 1e-6, y = 2e-3;
  for (double y_plus : {12.0, 30.0, 300.0, 1e4, 1e6}) {
    const double friction_speed = y_plus * nu / y;
    const double speed = friction_speed * (std::log(y_plus) / 0.41 + 5.2);
    EXPECT_NEAR(wall_stress(speed, y, nu, 0), friction_speed * friction_speed, 1e-12 * friction_speed * friction_speed);
  }
}

TEST(WallLaw, OfARoughWallDependsOnNoViscosity) {   // u/u* = ln(30 (y + k/30)/k)/kappa
  const double y = 2e-3, k = 1e-3, friction_speed = 0.2;
  const double speed = friction_speed / 0.41 * std::log((y + k / 30) / (k / 30));
  for (double nu : {1e-8, 1e-6})
    EXPECT_NEAR(wall_stress(speed, y, nu, k), friction_speed * friction_speed, 1e-12 * friction_speed * friction_speed);
}

TEST(WallLaw, IsContinuousAndAWallIsNeverSmootherThanSmooth) {
  const double nu = 1e-6, y = 1e-3;
  for (double k : {0.0, 1e-6, 1e-4}) {
    double before = 0;
    for (double speed = 1e-4; speed < 10; speed *= 1.01) {
      const double stress = wall_stress(speed, y, nu, k);
      EXPECT_GE(stress, wall_stress(speed, y, nu, 0));
      if (before > 0) {
        EXPECT_GT(stress, before);
        EXPECT_LT(stress, 1.03 * before) << speed;   // at most as the square of the speed, with no jump
      }
      before = stress;
    }
  }
  EXPECT_EQ(wall_stress(1, y, nu, 1e-9), wall_stress(1, y, nu, 0));
}

}   // namespace
}   // namespace bedload

// The dimensionless numbers: what they mean for grains that rise, and how they hang together.
#include "solver/dimensionless.hpp"

#include <gtest/gtest.h>

namespace bedload {
namespace {

TEST(DimensionlessNumbers, OfGrainsThatRiseAreThoseOfGrainsThatSinkAsFast) {
  EXPECT_EQ(reduced_gravity(0.5, 9.81), reduced_gravity(1.5, 9.81));
  EXPECT_EQ(galileo_number(0.5, 9.81, 1e-3, 1e-6), galileo_number(1.5, 9.81, 1e-3, 1e-6));
  EXPECT_EQ(shields_number(1, 1000, 0.5, 9.81, 1e-3), shields_number(1, 1000, 1.5, 9.81, 1e-3));
}

// Grains of 1 mm and s = 3 in water at theta = 0.2: tau_b = 3.924 Pa, gdot = 3924 1/s, Ga = 140.07, Re* = 62.64.
TEST(DimensionlessNumbers, OfShearFollowFromShieldsAndGalileoNumber) {
  const double theta = 0.2, nu = 1e-6, d = 1e-3, galileo = galileo_number(3, 9.81, d, nu);
  const double stress = stress_of_shields(theta, 1000, 3, 9.81, d), shear = stress / (1000 * nu);
  EXPECT_NEAR(stress, 3.924, 1e-12);
  EXPECT_NEAR(shields_number(stress, 1000, 3, 9.81, d), theta, 1e-15);
  EXPECT_NEAR(friction_reynolds_number(theta, galileo), 62.64, 0.01);
  EXPECT_NEAR(reynolds_number(std::sqrt(nu * shear), d, nu), friction_reynolds_number(theta, galileo), 1e-12);
  EXPECT_NEAR(shear_reynolds_number(shear, d, nu), theta * galileo * galileo, 1e-9);
}

}   // namespace
}   // namespace bedload

// Published threshold curves against values computed from their formulas by hand (three digits).
#include "studies/published_curves.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace bedload {
namespace {

double value_of(const std::string& name, double galileo) {
  for (const PublishedCurve& curve : published_curves())
    if (curve.name == name) return curve.shields(galileo);
  ADD_FAILURE() << "no curve " << name;
  return 0;
}

struct Row {
  double diameter, density_ratio;   // in water, nu = 1e-6 m2/s
  double soulsby, brownlie, parker, cao, guo, van_rijn;
};

constexpr Row table[] = {
    {20e-6, 2.65, .187, .406, .203, .179, .456, .474},        {0.1e-3, 1.05, .155, .272, .136, .154, .294, .304},
    {0.1e-3, 2.65, .0771, .0955, .0477, .103, .0959, .0949},  {0.2e-3, 2.65, .0477, .0521, .0261, .0628, .0540, .0496},
    {0.5e-3, 2.65, .0308, .0323, .0161, .0315, .0351, .0310}, {1e-3, 2.65, .0314, .0348, .0174, .0353, .0357, .0332},
    {1e-3, 3.00, .0319, .0354, .0177, .0363, .0361, .0338},   {2e-3, 2.65, .0399, .0422, .0211, .0450, .0426, .0406},
    {5e-3, 2.65, .0526, .0506, .0253, .0450, .0520, .0529},   {20e-3, 2.65, .0555, .0570, .0285, .0450, .0544, .0550},
};

TEST(PublishedCurves, GiveTheValuesOfTheirTable) {
  for (const Row& row : table) {
    const double ga = std::sqrt((row.density_ratio - 1) * 9.81 * std::pow(row.diameter, 3)) / 1e-6;
    const auto agrees = [&](const char* name, double expected) {
      EXPECT_NEAR(value_of(name, ga), expected, 0.006 * expected)
          << name << " at d = " << row.diameter;   // three printed digits
    };
    agrees("Soulsby 1997", row.soulsby);
    agrees("Brownlie 1981", row.brownlie);
    agrees("Parker 2003", row.parker);
    agrees("Cao 2006", row.cao);
    agrees("Guo 2002", row.guo);
    agrees("van Rijn 1984", row.van_rijn);
  }
}

TEST(PublishedCurves, OfCaoAreContinuousWhereTheirBranchesMeet) {
  for (const double seam : {6.61, 282.84})
    EXPECT_NEAR(value_of("Cao 2006", seam * 0.9999) / value_of("Cao 2006", seam * 1.0001), 1,
                0.02);   // coefficients of four digits
}

}   // namespace
}   // namespace bedload

// Units: what people write becomes SI, and what is not the quantity wanted is refused in plain words.
#include "base/units.hpp"

#include <cmath>
#include <cstdlib>
#include <numbers>

#include <gtest/gtest.h>

namespace bedload {
namespace {

std::string complaint(std::string_view text, Dimension wanted) {
  try {
    const double value = read_quantity(text, wanted);
    return "accepted as " + shortest(value);
  } catch (const UnitError& error) {
    return error.what();
  }
}

TEST(Units, ReadWhatTheFieldWrites) {
  EXPECT_EQ(read_quantity("0.5 mm", dimension::length), 0.5e-3);
  EXPECT_EQ(read_quantity("1.0e-6 m2/s", dimension::viscosity), 1e-6);
  EXPECT_EQ(read_quantity("1 mm2/s", dimension::viscosity), 1e-6);
  EXPECT_EQ(read_quantity("9.81 m/s2", dimension::acceleration), 9.81);
  EXPECT_EQ(read_quantity("9.81 m s-2", dimension::acceleration), 9.81);
  EXPECT_EQ(read_quantity("9.81 m/s^2", dimension::acceleration), 9.81);
  EXPECT_EQ(read_quantity("1000 kg/m3", dimension::density), 1000);
  EXPECT_EQ(read_quantity("2.65 g/cm3", dimension::density), 2650);
  EXPECT_EQ(read_quantity("1.2e7 Pa", dimension::pressure), 1.2e7);
  EXPECT_EQ(read_quantity("12 MPa", dimension::pressure), 1.2e7);
  EXPECT_EQ(read_quantity("10 Pa/m", dimension::pressure_gradient), 10);
  EXPECT_EQ(read_quantity("5 min", dimension::time), 300);
  EXPECT_EQ(read_quantity("6 h", dimension::time), 21600);
  EXPECT_DOUBLE_EQ(read_quantity("2 deg", dimension::angle), 2 * std::numbers::pi / 180);
  EXPECT_EQ(read_quantity("-3 mm/s", dimension::speed), -3e-3);
  EXPECT_EQ(read_quantity("5mm", dimension::length), 5e-3);
  EXPECT_EQ(read_quantity("5 \u00b5m", dimension::length), 5e-6);
  EXPECT_EQ(read_quantity("0.25", dimension::number), 0.25);
}

TEST(Units, ShiftTheExponentSoThatEveryPrefixGivesTheSameBits) {
  for (int n = 1; n < 2000; ++n) {
    const std::string millimetres = std::to_string(n / 1000) + "." + std::to_string(1000 + n % 1000).substr(1) + " mm";
    const double expected = std::stod(std::to_string(n) + "e-6");
    EXPECT_EQ(read_quantity(millimetres, dimension::length), expected) << millimetres;
    EXPECT_EQ(read_quantity(std::to_string(n) + " um", dimension::length), expected);
    EXPECT_EQ(read_quantity(std::to_string(n) + "e-3 mm", dimension::length), expected);
    EXPECT_EQ(read_quantity(std::to_string(n) + "e+3 nm", dimension::length), expected);
  }
}

TEST(Units, RefuseALengthWhereATimeIsDue) {
  EXPECT_EQ(complaint("0.5 mm", dimension::time), "\"0.5 mm\" is a length, not a time");
  EXPECT_EQ(complaint("5 s", dimension::length), "\"5 s\" is a time, not a length");
  EXPECT_EQ(complaint("1e-3 Pa s", dimension::viscosity),
            "\"1e-3 Pa s\" is a dynamic viscosity, not a kinematic viscosity");
  EXPECT_EQ(complaint("1 kg2", dimension::mass), "\"1 kg2\" is a quantity in kg2, not a mass");
}

TEST(Units, RefuseABareNumberWhereAUnitIsDue) {
  EXPECT_EQ(complaint("0.5", dimension::length), "\"0.5\" has no unit, and a length is wanted");
}

TEST(Units, RefuseWhatIsNoNumber) {
  for (const char* text : {"0,8 mm", "mm", "", "  ", "inf m", "nan m", "1.2.3 mm", "-", "0.5-mm"}) {
    EXPECT_EQ(complaint(text, dimension::length), "\"" + std::string(text) + "\" is not a length");
  }
  EXPECT_EQ(complaint("1e400 m", dimension::length),
            "\"1e400 m\" is not a length: too large or too small for a double");
}

TEST(Units, SuggestADecimalPointForAComma) {
  try {
    read_quantity("0,8 mm", dimension::length);
    FAIL();
  } catch (const UnitError& error) {
    EXPECT_EQ(error.hint, "the decimal sign is a point: \"0.8 mm\"");
  }
}

TEST(Units, RefuseUnknownAndAmbiguousUnits) {
  EXPECT_EQ(complaint("3 furlong", dimension::length), "\"3 furlong\" is not a length: \"furlong\" is not a unit");
  EXPECT_EQ(complaint("3 mmin", dimension::time), "\"3 mmin\" is not a time: \"mmin\" is not a unit");
  EXPECT_EQ(complaint("3 /", dimension::length), "\"3 /\" is not a length: \"/\" is not a unit");
  EXPECT_EQ(complaint("3 kg/m s2", dimension::pressure),
            "\"3 kg/m s2\" is not a pressure: its unit can be read in two ways");
  EXPECT_EQ(read_quantity("3 kg m-1 s-2", dimension::pressure), 3);
  EXPECT_EQ(complaint("3 m/s/s", dimension::acceleration),
            "\"3 m/s/s\" is not an acceleration: its unit can be read in two ways");
}

TEST(Units, MeasureInGrainsOnceTheirScalesAreKnown) {
  const GrainScales scales{.diameter = 0.5e-3, .time = 0.02};
  EXPECT_EQ(read_quantity("6 d", dimension::length, scales), 6 * 0.5e-3);
  EXPECT_EQ(read_quantity("25 td", dimension::time, scales), 25 * 0.02);
  EXPECT_DOUBLE_EQ(read_quantity("2 d/td", dimension::speed, scales), 2 * 0.5e-3 / 0.02);
  EXPECT_TRUE(parse_quantity("6 d", dimension::length).relative());
  EXPECT_FALSE(parse_quantity("6 mm", dimension::length).relative());
  EXPECT_EQ(complaint("6 d", dimension::length), "\"6 d\" counts grain diameters, which are not known here");
  EXPECT_EQ(complaint("6 td", dimension::length), "\"6 td\" is a time, not a length");
}

TEST(Shortest, ReadsBackAsTheSameDouble) {
  EXPECT_EQ(shortest(0.1), "0.1");
  EXPECT_EQ(shortest(1e-6), "1e-06");
  for (const double x : {1.0 / 3, 6.02214076e23, -5e-324, 0.1 + 0.2}) {
    EXPECT_EQ(std::strtod(shortest(x).c_str(), nullptr), x);
  }
}

}   // namespace
}   // namespace bedload

// Drag laws: limits, published values, terminal speeds.
#include <gtest/gtest.h>

#include "solver/coupling/drag_laws.hpp"

namespace bedload {
namespace {

constexpr DragLawName all_laws[] = {
    DragLawName::stokes,   DragLawName::schiller_naumann, DragLawName::di_felice, DragLawName::ergun,
    DragLawName::gidaspow, DragLawName::koch_hill,        DragLawName::beetstra,  DragLawName::tang,
    DragLawName::rong};

double multiplier(DragLawName name, double eps, double re) {
  return std::visit([&](const auto& law) { return law.multiplier(eps, re); }, drag_law(name));
}

TEST(DragLaws, TendToStokesForALoneSlowGrain) {
  for (const auto name : {DragLawName::stokes, DragLawName::schiller_naumann, DragLawName::gidaspow,
                          DragLawName::koch_hill, DragLawName::beetstra, DragLawName::tang})
    EXPECT_NEAR(multiplier(name, 1, 1e-9), 1, 1e-5) << name_of(name);
  // Dallavalle's coefficient is 24 x 0.96/Re in the limit: 4.8^2/24.
  EXPECT_NEAR(multiplier(DragLawName::di_felice, 1, 1e-9), 4.8 * 4.8 / 24, 1e-4);
  EXPECT_NEAR(multiplier(DragLawName::rong, 1, 1e-9), 4.8 * 4.8 / 24, 1e-4);
  EXPECT_NEAR(multiplier(DragLawName::ergun, 1, 1e-9), 0, 1e-9);   // for beds alone
}

TEST(DragLaws, GiveTheirTabulatedMultipliers) {
  // F evaluated independently from the published formulas, four digits.
  struct Row {
    double phi, re, di_felice, beetstra, tang, gidaspow, koch_hill;
  };
  const Row table[] = {{0.01, 1, 1.272, 1.309, 1.460, 1.193, 1.303},    {0.10, 0.01, 1.455, 2.429, 2.441, 1.478, 2.541},
                       {0.10, 10, 2.672, 3.218, 3.616, 2.541, 3.116},   {0.30, 0.01, 3.686, 7.015, 7.034, 5.104, 6.607},
                       {0.30, 10, 5.863, 8.279, 9.009, 7.086, 7.547},   {0.50, 0.01, 12.79, 20.52, 20.57, 16.67, 20.00},
                       {0.50, 10, 16.79, 22.77, 25.67, 20.56, 22.29},   {0.50, 100, 44.83, 50.41, 44.44, 55.56, 42.89},
                       {0.60, 0.01, 29.20, 37.85, 37.97, 31.26, 37.51}, {0.60, 1, 30.05, 37.87, 40.36, 31.86, 37.99},
                       {0.60, 100, 90.06, 89.79, 83.82, 92.01, 86.70}};
  for (const auto& r : table) {
    const std::pair<DragLawName, double> values[] = {{DragLawName::di_felice, r.di_felice},
                                                     {DragLawName::beetstra, r.beetstra},
                                                     {DragLawName::tang, r.tang},
                                                     {DragLawName::gidaspow, r.gidaspow},
                                                     {DragLawName::koch_hill, r.koch_hill}};
    for (const auto& [name, f] : values)
      EXPECT_NEAR(multiplier(name, 1 - r.phi, r.re) / f, 1, 5e-4) << name_of(name) << " " << r.phi << " " << r.re;
  }
}

TEST(DragLaws, ErgunGivesTheGradientOfAPackedBed) {
  // dp/dz = 150 mu phi^2 U/(eps^3 d^2) + 1.75 rho phi U^2/(eps^3 d). Of it the share phi is buoyancy on the grains, so that
  // drag per volume is eps of it, on n = 6 phi/(pi d^3) grains: F 3 pi mu d U n = eps dp/dz.
  const double mu = 1e-3, rho = 1000, d = 1e-3;
  for (const double eps : {0.36, 0.4, 0.6})
    for (const double u : {1e-5, 1e-3, 0.1}) {
      const double phi = 1 - eps, e3 = eps * eps * eps;
      const double gradient = 150 * mu * phi * phi * u / (e3 * d * d) + 1.75 * rho * phi * u * u / (e3 * d);
      const double drag = 3 * M_PI * mu * d * u * Ergun{}.multiplier(eps, rho * u * d / mu);
      EXPECT_NEAR(drag * 6 * phi / (M_PI * d * d * d) / (eps * gradient), 1, 1e-12);
    }
}

TEST(DragLaws, GidaspowBlendsWithoutAJump) {
  for (const double re : {0.0, 1.0, 100.0, 1000.0}) {
    EXPECT_EQ(Gidaspow{}.multiplier(0.75, re), Ergun{}.multiplier(0.75, re));
    EXPECT_NEAR(Gidaspow{}.multiplier(0.85, re) / (SchillerNaumann{}.multiplier(1, re) * std::pow(0.85, -3.65)), 1,
                1e-14);
    for (double eps = 0.7; eps < 0.9; eps += 1e-4)
      EXPECT_NEAR(Gidaspow{}.multiplier(eps, re) / Gidaspow{}.multiplier(eps + 1e-4, re), 1, 1e-2) << eps << " " << re;
  }
}

TEST(DragLaws, RongIsDiFeliceForALoneGrainAndAboveItInABed) {
  // chi at eps 1 is 5.3 - 1.8 B against 3.7 - 0.65 B: no matter for a lone grain. At eps 0.5 and Re -> 0 the drag is
  // 0.96 x 2^3.975.
  EXPECT_EQ(Rong{}.multiplier(1, 7), DiFelice{}.multiplier(1, 7));
  EXPECT_NEAR(Rong{}.multiplier(0.5, 0) / (0.96 * std::pow(2, 3.975)), 1, 1e-5);
  // At the bottom of the dip, Re = 10^1.5: chi = 3.975 - (5.3 - 1.75)/4.
  const double re = std::pow(10, 1.5);
  EXPECT_NEAR(Rong{}.multiplier(0.5, re) / (std::pow(0.63 * std::sqrt(re) + 4.8, 2) / 24 * std::pow(2, 3.0875)), 1,
              1e-9);
}

TEST(DragLaws, SchillerNaumannMeetsNewtonsPlateauNearRe1000) {
  EXPECT_NEAR(SchillerNaumann{}.multiplier(1, 999.9) / SchillerNaumann{}.multiplier(1, 1000.1), 1, 0.02);
}

TEST(DragLaws, GrowWithPackingAndSpeed) {
  for (const auto name : all_laws)
    for (double re = 1e-8; re < 1e6; re *= 3) {
      const auto drag = [&](double eps, double at) { return at * multiplier(name, eps, at); };
      for (double eps = 0.26; eps < 0.97; eps += 0.02) {
        EXPECT_TRUE(std::isfinite(multiplier(name, eps, 0)) && multiplier(name, eps, 0) > 0) << name_of(name);
        EXPECT_LT(drag(eps, re), drag(eps, 1.01 * re)) << name_of(name) << " " << eps << " " << re;
        if (name == DragLawName::stokes || name == DragLawName::schiller_naumann) continue;
        if (re > range_of(name).highest_re || eps < range_of(name).lowest_void) continue;
        EXPECT_GT(drag(eps, re), drag(eps + 0.02, re)) << name_of(name) << " " << eps << " " << re;
      }
    }
}

TEST(DragLaws, AreContinuousAtStandstill) {
  for (const auto name : all_laws)
    for (const double eps : {0.26, 0.4, 0.7, 1.0})
      EXPECT_NEAR(multiplier(name, eps, 1e-14), multiplier(name, eps, 0), 1e-5 * multiplier(name, eps, 0) + 1e-12)
          << name_of(name) << " " << eps;
}

TEST(DragLaws, KnowTheirRange) {
  for (const auto name : all_laws) {
    const auto [lowest, highest, re] = range_of(name);
    EXPECT_TRUE(0.26 <= lowest && lowest < highest && highest <= 1 && re > 0) << name_of(name);
  }
  EXPECT_LT(range_of(DragLawName::ergun).highest_void, 1);   // beds only
  EXPECT_EQ(range_of(DragLawName::tang).highest_re, 1000);
}

TEST(DragLaws, SettleALoneGrainAtTheirPublishedSpeed) {
  // d 0.1 mm, 3000 kg/m3 in water: physics reference values, seven digits.
  const auto speed = [](DragLawName law) { return terminal_speed(law, 1e-6, 3, 1e-4, 9.81); };
  EXPECT_NEAR(speed(DragLawName::stokes), 1.090000e-2, 1e-8);
  EXPECT_NEAR(speed(DragLawName::schiller_naumann), 9.519559e-3, 1e-8);
  EXPECT_NEAR(speed(DragLawName::di_felice), 8.981035e-3, 1e-8);
  EXPECT_EQ(speed(DragLawName::gidaspow), speed(DragLawName::schiller_naumann));   // Wen & Yu's lone sphere
  EXPECT_EQ(speed(DragLawName::rong), speed(DragLawName::di_felice));              // Dallavalle's
  EXPECT_EQ(speed(DragLawName::ergun), speed(DragLawName::schiller_naumann));      // a law for beds has no lone grain
}

TEST(DragLaws, TerminalSpeedBalancesWeightForEveryLaw) {
  // From dust in air to pebbles in water: W' = 3 pi mu d F U holds, and the search starts from a bracket that contains U.
  for (const auto name : all_laws) {
    if (name == DragLawName::ergun) continue;
    for (const double d : {1e-6, 1e-4, 1e-3, 0.05})
      for (const double nu : {1e-6, 1.5e-5, 1e-2}) {
        const double u = terminal_speed(name, nu, 2.65, d, 9.81), stokes = 1.65 * 9.81 * d * d / (18 * nu);
        EXPECT_NEAR(multiplier(name, 1, u * d / nu) * u / stokes, 1, 1e-12) << name_of(name) << " " << d << " " << nu;
      }
  }
}

// A state that has gone wrong must not look right to those who judge it.
TEST(DragLaws, PassOnWhatIsNoNumber) {
  const double no_number = std::nan("");
  for (const DragLawName name : {DragLawName::di_felice, DragLawName::ergun, DragLawName::gidaspow,
                                 DragLawName::koch_hill, DragLawName::beetstra, DragLawName::tang, DragLawName::rong}) {
    EXPECT_TRUE(std::isnan(multiplier(name, no_number, 1))) << name_of(name);
    EXPECT_TRUE(std::isnan(multiplier(name, 0.5, no_number))) << name_of(name);
  }
  EXPECT_TRUE(std::isnan(multiplier(DragLawName::schiller_naumann, 1, no_number)));
}

}   // namespace
}   // namespace bedload

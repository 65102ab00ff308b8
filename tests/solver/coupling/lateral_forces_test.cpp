// Shear lift and Magnus force: signs, limits, scaling, symmetry, and that an explicit lift cannot grow.
#include <gtest/gtest.h>

#include <numbers>

#include "solver/coupling/drag_laws.hpp"
#include "solver/coupling/lateral_forces.hpp"

namespace bedload {
namespace {

constexpr double pi = std::numbers::pi, d = 1e-3, nu = 1e-4;

/// u = (rate z, 0, 0) has the vorticity (0, rate, 0).
Vec3 vorticity_of_shear(double rate) { return {0, rate, 0}; }
Vec3 saffman_force(Vec3 slip, Vec3 vorticity, double diameter = d, double viscosity = nu) {
  return cross(slip, saffman_mei(slip, vorticity, diameter, viscosity));
}
Vec3 magnus_force(Vec3 slip, Vec3 spin, double diameter = d, double viscosity = nu) {
  return cross(slip, magnus(slip, spin, diameter, viscosity));
}

TEST(SaffmanMei, LiftsAGrainThatLagsAndPressesDownOneThatLeads) {
  const Vec3 lags = saffman_force({1e-3, 0, 0}, vorticity_of_shear(10));
  EXPECT_GT(lags.z, 0);   // towards the faster fluid, away from the wall below
  EXPECT_EQ(lags.x, 0);
  EXPECT_EQ(lags.y, 0);
  EXPECT_EQ(saffman_force({-1e-3, 0, 0}, vorticity_of_shear(10)).z, -lags.z);
  EXPECT_EQ(saffman_force({1e-3, 0, 0}, vorticity_of_shear(-10)).z, -lags.z);
}

TEST(SaffmanMei, LiftsAFixedSphereInShear) {
  // Neither moves nor spins: the lift comes from the fluid's vorticity. Saffman's limit, Re << sqrt(Re_g) << 1:
  // 6.46 rho nu^(1/2) gdot^(1/2) a^2 u (per fluid density).
  const double rate = 1e-3, u = 1e-9;
  const Vec3 lift = saffman_force({u, 0, 0}, vorticity_of_shear(rate));
  EXPECT_NEAR(lift.z / (6.46 * std::sqrt(nu * rate) * 0.25 * d * d * u), 1, 1e-3);
}

TEST(SaffmanMei, IsZeroWithoutSlipOrVorticity) {
  EXPECT_EQ(saffman_force({}, vorticity_of_shear(10)), Vec3{});
  EXPECT_EQ(saffman_force({1, 0, 0}, {}), Vec3{});
  EXPECT_EQ(saffman_force({0, 1, 0}, vorticity_of_shear(10)), Vec3{});   // slip along the vortex lines
}

TEST(SaffmanMei, FollowsMeisFitWhereItWasMade) {
  // Mei 1992, b = d omega/(2 w): f = (1 - 0.3314 b^0.5) exp(-Re/10) + 0.3314 b^0.5 to Re 40, 0.0524 (b Re)^0.5 beyond.
  for (const double b : {0.01, 0.1, 0.4})
    for (const double re : {0.1, 1.0, 10.0, 39.0, 60.0, 100.0}) {
      const double w = re * nu / d, omega = 2 * b * w / d;
      const double mei = re < 40 ? (1 - 0.3314 * std::sqrt(b)) * std::exp(-re / 10) + 0.3314 * std::sqrt(b)
                                 : 0.0524 * std::sqrt(b * re);
      const double f =
          saffman_force({w, 0, 0}, vorticity_of_shear(omega)).z / (1.615 * d * d * std::sqrt(nu * omega) * w);
      EXPECT_NEAR(f, mei, re < 40 ? 1e-12 : std::exp(-re / 10) + 1e-4) << b << " " << re;
    }
}

TEST(LiftOfFourGrains, IsThatOfEachAlone) {
  // Lanes without slip, or without rotation, leave the others alone.
  const Quad slip{1e-3, 0.2, 0, 5e-2}, turn{10, 3, 7, 0}, diameter{1e-3, 2e-3, 5e-4, 0};
  const Quad by_shear = saffman_mei(slip, turn, diameter, nu), by_spin = magnus(slip, turn, diameter, nu);
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(by_shear[k] * turn[k], saffman_mei({slip[k], 0, 0}, {0, turn[k], 0}, diameter[k], nu).y) << k;
    EXPECT_EQ(by_spin[k] * turn[k], magnus({slip[k], 0, 0}, {0, turn[k], 0}, diameter[k], nu).y) << k;
  }
  EXPECT_GT(by_shear[1], 0);
  EXPECT_GT(by_spin[1], 0);
  EXPECT_EQ(by_shear[2], 0);
  EXPECT_EQ(by_spin[3], 0);
}

TEST(Magnus, FollowsOesterleAndBuiDinhsFit) {
  // Oesterle & Bui Dinh 1998: C_L = 0.45 + (Re_r/Re - 0.45) exp(-0.05684 Re_r^0.4 Re^0.3), force (pi/8) d^2 C_L w^2 at right angles.
  for (const double re : {1.0, 20.0, 140.0})
    for (const double slow : {1.0, 2.0, 6.0}) {   // Re_r/Re
      const double w = re * nu / d, spin = slow * w / d;
      const double coefficient =
          0.45 + (slow - 0.45) * std::exp(-0.05684 * std::pow(slow * re, 0.4) * std::pow(re, 0.3));
      const double force = norm(magnus_force({w, 0, 0}, {0, spin, 0}));
      EXPECT_NEAR(force / (pi / 8 * d * d * coefficient * w * w), 1, 1e-13) << re << " " << slow;
    }
}

TEST(SaffmanMei, ScalesAsDimensionsDemand) {
  // Lengths x 3, times x 5: forces per density x 3^4/5^2.
  const double length = 3, time = 5;
  const Vec3 small = saffman_force({2e-3, 0, 1e-3}, {1, 20, 3});
  const Vec3 large = saffman_force(length / time * Vec3{2e-3, 0, 1e-3}, 1 / time * Vec3{1, 20, 3}, length * d,
                                   length * length / time * nu);
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(large[c], std::pow(length, 4) / (time * time) * small[c], 1e-12 * norm(large));
}

/// A rotation by 120 degrees about (1, 1, 1), and one by an odd angle about z: neither favours an axis of the grid.
Vec3 turned(Vec3 v) { return {v.z, v.x, v.y}; }
Vec3 swung(Vec3 v) { return {0.6 * v.x - 0.8 * v.y, 0.8 * v.x + 0.6 * v.y, v.z}; }

TEST(LateralForces, TurnWithTheAxesAndDoNoWorkOnTheSlip) {
  const Vec3 w{3e-2, -1e-2, 2e-2}, omega{5, 40, -30};
  for (const auto& force : {saffman_force(w, omega), magnus_force(w, omega)})
    EXPECT_NEAR(dot(force, w), 0, 1e-15 * norm(force) * norm(w));
  for (const auto rotate : {turned, swung}) {
    EXPECT_NEAR(norm(saffman_force(rotate(w), rotate(omega)) - rotate(saffman_force(w, omega))), 0,
                1e-12 * norm(saffman_force(w, omega)));
    EXPECT_NEAR(norm(magnus_force(rotate(w), rotate(omega)) - rotate(magnus_force(w, omega))), 0,
                1e-12 * norm(magnus_force(w, omega)));
  }
}

TEST(Magnus, BackspinCarriesABallUp) {
  // Flies along +x through still fluid (slip -x), its top moving backwards: spin about -y. Rubinow & Keller: pi a^3 spin x v.
  const double v = 1e-6, spin = 1e-3;
  const Vec3 force = magnus_force({-v, 0, 0}, {0, -spin, 0});
  EXPECT_NEAR(force.z / (pi * std::pow(0.5 * d, 3) * spin * v), 1, 1e-4);
  EXPECT_LT(magnus_force({-v, 0, 0}, {0, spin, 0}).z, 0);
  EXPECT_EQ(magnus_force({}, {0, spin, 0}), Vec3{});
  EXPECT_EQ(magnus_force({v, 0, 0}, {}), Vec3{});
}

TEST(Magnus, FadesToOesterleAndBuiDinhAtHigherRe) {
  // Their coefficient for spin ratio g = d spin/(2 w): 0.45 + (2 g - 0.45) exp(-0.075 g^0.4 Re^0.7), lift over (pi/8) d^2 w^2.
  for (const double g : {1.0, 3.0, 6.0})
    for (const double re : {10.0, 50.0, 140.0}) {
      const double w = re * nu / d, spin = 2 * g * w / d;
      const double coefficient = magnus_force({-w, 0, 0}, {0, -spin, 0}).z / (pi / 8 * d * d * w * w);
      EXPECT_NEAR(coefficient, 0.45 + (2 * g - 0.45) * std::exp(-0.075 * std::pow(g, 0.4) * std::pow(re, 0.7)),
                  2e-4 * coefficient);
    }
}

TEST(Magnus, IsNeverAboveItsCreepingLimit) {
  for (double w = 1e-7; w < 10; w *= 3)
    for (double spin = 1e-4; spin < 1e4; spin *= 7) {
      const double k = norm(magnus({w, 0, 0}, {0, spin, 0}, d, nu));
      EXPECT_LE(k, pi / 8 * d * d * d * spin * (1 + 1e-12));
      EXPECT_GT(k, 0);
    }
}

TEST(WallLift, IsLeightonAndAcrivosForASlowSphereAtTheWall) {
  // At rest on a wall, u = rate z: lift 9.22 gdot^2 a^4.
  const double rate = 1e-2, a = 0.5 * d;
  const Vec3 slip{rate * a, 0, 0};
  const Vec3 lift = cross(slip, shear_lift_near_wall(slip, {}, vorticity_of_shear(rate), d, nu, a));
  EXPECT_NEAR(lift.z / (9.22 * rate * rate * a * a * a * a), 1, 0.01);
  EXPECT_EQ(lift.x, 0);
}

TEST(WallLift, GivesZengsCoefficients) {
  EXPECT_NEAR(wall_lift_coefficient(0, 0), 5.87, 0.005);   // (32/pi) 0.576
  EXPECT_NEAR(wall_lift_coefficient(0, 10), 3.663 / std::pow(100.1173, 0.22), 1e-12);
  // gap 1, Re 10: evaluated by hand from the published formula.
  EXPECT_NEAR(wall_lift_coefficient(1, 10), 0.510, 0.001);
}

TEST(WallLift, GoesOverToShearLiftOneDiameterAway) {
  const Vec3 slip{1e-2, 0, 0}, vorticity = vorticity_of_shear(20);
  const auto lift = [&](double z) { return cross(slip, shear_lift_near_wall(slip, vorticity, vorticity, d, nu, z)).z; };
  EXPECT_EQ(lift(1.5 * d), saffman_force(slip, vorticity).z);
  EXPECT_EQ(lift(3 * d), saffman_force(slip, vorticity).z);
  for (double z = 0.4 * d; z < 1.6 * d; z += 0.01 * d) {
    EXPECT_GT(lift(z), 0);
    EXPECT_NEAR(lift(z + 1e-6 * d) / lift(z), 1, 1e-4) << z / d;   // no jump
  }
}

/// Slip of a grain after one step of length T in fluid that keeps its velocity: drag implicit, lift explicit, a = beta T/M.
Vec3 slip_after_a_step(Vec3 slip, Vec3 lift, double drag, double a) { return (slip - a / drag * lift) / (1 + a); }

TEST(LiftForce, NeverGrowsHoweverStiffTheStep) {
  // Re_g = gdot d^2/nu = 60, a grain that goes along with the flow but for a tiny slip: Saffman's lift is 1.3 of its drag.
  const double rate = 60 * nu / (d * d), drag = 3 * pi * nu * d;
  for (const double a : {0.2, 2.0, 20.0, 200.0, 1e4}) {
    Vec3 slip{1e-6, 0, 0}, free_slip = slip;
    for (int step = 0; step < 200; ++step) {
      const Vec3 k = saffman_mei(slip, vorticity_of_shear(rate), d, nu);
      slip = slip_after_a_step(slip, cross(slip, limited_lift(k, drag)), drag, a);
      const Vec3 uncut = cross(free_slip, saffman_mei(free_slip, vorticity_of_shear(rate), d, nu));
      free_slip = slip_after_a_step(free_slip, uncut, drag, a);
    }
    EXPECT_LT(norm(slip), 1e-9) << a;
    if (a < 200) continue;
    EXPECT_GT(norm(free_slip), 1e-4) << "uncut it grows";
  }
}

TEST(LiftForce, IsNotCutWithinTheRangeOfTheLaws) {
  for (double re = 1e-3; re < 100; re *= 1.5)
    for (const double b : {0.005, 0.1, 0.4}) {
      const Vec3 slip{re * nu / d, 0, 0}, vorticity = vorticity_of_shear(2 * b * slip.x / d);
      const double drag = 3 * pi * nu * d * SchillerNaumann{}.multiplier(1, re);
      EXPECT_EQ(cross(slip, limited_lift(saffman_mei(slip, vorticity, d, nu), drag)), saffman_force(slip, vorticity));
    }
  for (double re = 1e-3; re < 200; re *= 1.5) {   // at rest on a wall
    const Vec3 slip{re * nu / d, 0, 0}, vorticity = vorticity_of_shear(2 * slip.x / d);
    const Vec3 k = shear_lift_near_wall(slip, vorticity, vorticity, d, nu, 0.5 * d);
    const double drag = 3 * pi * nu * d * SchillerNaumann{}.multiplier(1, re);
    EXPECT_EQ(cross(slip, limited_lift(k, drag)), cross(slip, k)) << re;
  }
}

}   // namespace
}   // namespace bedload

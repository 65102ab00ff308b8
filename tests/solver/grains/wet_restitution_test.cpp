#include "solver/grains/wet_restitution.hpp"

#include <gtest/gtest.h>

#include "solver/grains/contact_laws.hpp"
#include "tests/solver/grains/grain_scenes.hpp"

namespace bedload {
namespace {

constexpr double pi = std::numbers::pi;
constexpr ContactTerms wet{.wet_restitution = true};

BedScene liquid_scene(double restitution, double viscosity) {
  BedScene scene = grain_scene(Side::periodic, Side::wall);
  scene.grains.restitution = restitution;
  scene.grains.young_modulus = 1e7;
  scene.fluid = {1000, viscosity};
  return scene;
}

/// Thrown at the floor; the rebound speed per speed of approach.
double bounce(const BedScene& scene, double speed, double stretch = 1) {
  Grains grains;
  add_grain(grains, {20e-3, 20e-3, 0.5e-3}, {0, 0, -speed});
  GrainDynamics dynamics(scene, wet);
  ContactHistory contacts;
  const double dt = stretch * contact_time(1e-3, 2500, 1e7, 0.3, speed) / 200;
  do coast(dynamics, grains, contacts, dt);
  while (grains.position[0].z < 0.5e-3);
  return grains.velocity[0].z / speed;
}

// Legendre et al. 2006: e/e_dry = exp(-35/St), St = (rho_p + rho_f/2) d U/(9 mu) against a wall.
TEST(WetRestitution, IsThatOfTheStokesNumberOfABounceOnAWall) {
  const double speed = 0.2;
  for (const double dry : {0.7, 0.97})
    for (const double stokes : {20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0}) {
      const double expected = std::exp(-35 / stokes);
      if (expected * dry < HertzMindlin::lowest_restitution) continue;
      const BedScene scene = liquid_scene(dry, 3000 * 1e-3 * speed / (9 * stokes) / 1000);
      EXPECT_NEAR(bounce(scene, speed) / dry, expected, 0.01) << dry << " at St " << stokes;
    }
}

TEST(WetRestitution, IsThatOfADryCollisionWithoutViscosity) {
  EXPECT_NEAR(bounce(liquid_scene(0.8, 0), 0.2), 0.8, 0.01);
  EXPECT_NEAR(bounce(liquid_scene(1, 1e-12), 0.2), 1, 0.005);
}

TEST(WetRestitution, FallsToTheLowestAndNoFurther) {
  for (const double dry : {0.0, 0.05, 0.1, 0.97})
    for (const double viscosity : {1e-2, 1e3}) {
      const double e = bounce(liquid_scene(dry, viscosity), 0.2);
      EXPECT_GT(e, 0) << dry;
      EXPECT_LT(e, HertzMindlin::lowest_restitution + 0.01) << dry;
    }
}

SolidSphere sphere_of(double diameter, double density) {
  return {diameter / 2, 1 / sphere_inertia(density * sphere_volume(diameter), diameter)};
}

// St = m* U/(6 pi mu R*^2) is 35 at the viscous speed.
TEST(WetRestitution, CountsReducedMassAndRadiusOfUnlikeGrains) {
  const WetRestitution law({1000, 1e-6}, 0.9);
  const double d1 = 1e-3, d2 = 3e-3, rho1 = 2500, rho2 = 8000, r = d1 * d2 / (d1 + d2) / 2;
  const double m1 = (rho1 + 500) * sphere_volume(d1), m2 = (rho2 + 500) * sphere_volume(d2);
  const double drag = 35 * 6 * pi * 1e-3 * r * r;
  EXPECT_NEAR(law.viscous_speed(sphere_of(d1, rho1), sphere_of(d2, rho2)) / (drag * (m1 + m2) / (m1 * m2)), 1, 1e-12);
  SolidSphere fixed = sphere_of(d2, rho2);
  fixed.inverse_inertia = 0;
  EXPECT_NEAR(law.viscous_speed(sphere_of(d1, rho1), fixed) / (drag / m1), 1, 1e-12);
  // A wall: (rho_p + rho_f/2) d U/(9 mu) = 35.
  EXPECT_NEAR(law.viscous_speed_at_wall(sphere_of(d1, rho1)) * (rho1 + 500) * d1 / (9 * 1e-3), 35, 1e-9);
}

TEST(WetRestitution, TabulatesTheDampingOfEveryRestitution) {
  for (const double dry : {1.0, 0.8, 0.3}) {
    const WetRestitution law({1000, 1e-6}, dry);
    double before = -1;
    for (double x = 0.001; x < 3; x += 0.0173) {   // viscous speed/approach = -ln(e/e_dry)
      const double e = std::max(dry * std::exp(-x), HertzMindlin::lowest_restitution), alpha = law.damping(x, 1);
      EXPECT_NEAR(restitution_of_damping(alpha), e, 0.002) << x;
      EXPECT_GE(alpha, before);
      before = alpha;
    }
    EXPECT_EQ(law.damping(1, 0), law.damping(100, 1));
    EXPECT_EQ(law.damping(1, -5), law.damping(100, 1)) << "a contact that begins while parting";
  }
}

TEST(WetRestitution, IsChosenWhenAContactBeginsAndAnewWhenItBeginsAgain) {
  const BedScene scene = liquid_scene(0.9, 3000 * 1e-3 * 0.4 / (9 * 100.0) / 1000);   // St = 100 at 0.4 m/s
  Grains grains;
  add_grain(grains, {20e-3, 20e-3, 0.5e-3}, {0, 0, -0.4});
  ContactHistory contacts;
  const auto dynamics = std::make_unique<GrainDynamics>(scene, wet);
  const double dt = scene.dem_step / 40;
  for (const double speed : {0.4, 0.2}) {
    grains.velocity[0].z = -speed;
    double first = -1, rebound = 0;
    do {
      coast(*dynamics, grains, contacts, dt);
      if (contacts.size() == 0) continue;
      ASSERT_EQ(contacts.damping.size(), 1u);
      if (first < 0) first = contacts.damping[0];
      EXPECT_EQ(contacts.damping[0], first);
      rebound = grains.velocity[0].z;
    } while (grains.position[0].z < 0.501e-3);
    EXPECT_NEAR(rebound / speed, 0.9 * std::exp(-0.35 * 0.4 / speed), 0.01);
    EXPECT_TRUE(contacts.damping.empty());
  }
}

TEST(WetRestitution, IsNotRememberedWithoutTheTerm) {
  const BedScene scene = liquid_scene(0.9, 1e-6);
  Grains grains;
  add_grain(grains, {20e-3, 20e-3, 0.5e-3}, {0, 0, -0.1});
  GrainDynamics dynamics(scene);
  ContactHistory contacts;
  coast(dynamics, grains, contacts, scene.dem_step, 3);
  EXPECT_EQ(contacts.size(), 1u);
  EXPECT_TRUE(contacts.damping.empty() && contacts.rolling.empty());
}

}   // namespace
}   // namespace bedload

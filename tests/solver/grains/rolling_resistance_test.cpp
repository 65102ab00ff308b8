#include "solver/grains/rolling_resistance.hpp"

#include <gtest/gtest.h>

#include "tests/solver/grains/grain_scenes.hpp"

namespace bedload {
namespace {

GrainProperties rough(double rolling_friction, double restitution = 0.6) {
  GrainProperties grains{1e-3, 2500, 0, 0.8, restitution, 0.3, 1e7};
  grains.rolling_friction = rolling_friction;
  return grains;
}

Overlap resting_overlap() {
  Overlap o;
  o.depth = 5e-6, o.root_radius = std::sqrt(0.25e-3), o.mass = 6.5e-7;
  o.normal = {0, 0, 1};
  return o;
}

// Iwashita & Oda 1998: a spring of R*^2 S_t, S_t Mindlin's, and Ai et al. 2011 (type C): at most mu_r R* F_n.
TEST(RollingResistance, IsASpringWithACap) {
  const HertzMindlin law(rough(0.2));
  const RollingResistance rolling(0.2);
  const Overlap o = resting_overlap();
  const double shear = 8 * 1e7 / (2 * 1.3) / (2 * 1.7) * std::sqrt(0.25e-3 * 5e-6), r = 0.25e-3;
  const Vec3 angle{1e-7, -2e-7, 0};
  const RollingTorque small = rolling.respond(law, law.damping(), o, {}, angle, 1e-6);
  EXPECT_LE(norm(small.torque + r * r * shear * angle), 1e-12 * norm(small.torque));
  EXPECT_EQ(small.spring, angle);
  const RollingTorque large = rolling.respond(law, law.damping(), o, {}, {0.5, 0, 0}, 1e-6);
  EXPECT_NEAR(norm(large.torque), 0.2 * r * law.normal_force(o, law.damping()), 1e-12 * norm(large.torque));
  EXPECT_NEAR(norm(large.spring) * r * r * shear, norm(large.torque), 1e-12 * norm(large.torque))
      << "the spring yields with its torque";
}

TEST(RollingResistance, HasTheNormalForceOfTheContactLaw) {
  const HertzMindlin law(rough(0.2));
  for (const double closing : {-1.0, -0.01, 0.0, 0.01}) {
    Overlap o = resting_overlap();
    o.velocity = {0.2, 0, closing};
    EXPECT_NEAR(law.normal_force(o, law.damping()), -law.respond(o, {}, 1e-6).force.z, 1e-15);
  }
}

TEST(RollingResistance, ResistsNeitherSpinAboutTheNormalNorGrainsApart) {
  const HertzMindlin law(rough(0.2));
  const RollingResistance rolling(0.2);
  Overlap o = resting_overlap();
  EXPECT_EQ(rolling.respond(law, law.damping(), o, {0, 0, 50}, {}, 1e-6).torque, Vec3{});
  o.depth = -1e-9;
  const RollingTorque apart = rolling.respond(law, law.damping(), o, {7, 0, 50}, {1e-3, 0, 0}, 1e-6);
  EXPECT_EQ(apart.torque, Vec3{});
  EXPECT_EQ(apart.spring, Vec3{});
}

// Two grains that turn about each other as one body do not roll, and a spring turns with them.
TEST(RollingResistance, IsTheSameForAnObserverWhoTurns) {
  BedScene scene = grain_scene(Side::wall, Side::wall);
  scene.grains = rough(0.2);
  Grains grains;
  const double rate = 40, distance = 0.995e-3;
  add_grain(grains, {20e-3 - distance / 2, 20e-3, 20e-3}, {0, -rate * distance / 2, 0});
  add_grain(grains, {20e-3 + distance / 2, 20e-3, 20e-3}, {0, rate * distance / 2, 0});
  grains.spin = {{0, 0, rate}, {0, 0, rate}};
  ContactHistory contacts{{0}, {1}, {{}}, {}, {{0, 1e-5, 0}}};   // bent across the plane of the turning
  GrainDynamics dynamics(scene);
  const double dt = scene.dem_step / 20;
  for (int n = 0; n < 50; ++n) {
    coast(dynamics, grains, contacts, dt);
    ASSERT_EQ(contacts.size(), 1u);
    const Vec3 apart = grains.position[1] - grains.position[0];
    EXPECT_LE(std::abs(dot(contacts.rolling[0], apart)), 1e-3 * norm(contacts.rolling[0]) * norm(apart));
    EXPECT_LE(std::abs(contacts.rolling[0].z), 1e-9);
  }
}

/// A sphere on a slope; its place and speed along it at 50 ms and 100 ms.
struct Descent {
  double early, late, speed;   // [m], [m], [m/s]
};

Descent descend(double slope, double rolling_friction, double restitution) {
  constexpr double g = 9.81;
  BedScene scene = grain_scene(Side::periodic, Side::wall);
  scene.grains = rough(rolling_friction, restitution);
  scene.dem_step = 0.2 * rayleigh_time(1e-3, 2500, 1e7, 0.3);
  Grains grains;
  const double modulus = 1e7 / (2 * 0.91), weight = 2500 * sphere_volume(1e-3) * g * std::cos(slope);
  add_grain(grains, {20e-3, 20e-3, 0.5e-3 - std::pow(0.75 * weight / (modulus * std::sqrt(0.5e-3)), 2.0 / 3)});
  GrainDynamics dynamics(scene);
  ContactHistory contacts;
  Descent descent{};
  const int steps = static_cast<int>(0.05 / scene.dem_step);
  for (double* place : {&descent.early, &descent.late}) {
    coast(dynamics, grains, contacts, scene.dem_step, steps, {g * std::sin(slope), 0, -g * std::cos(slope)});
    *place = grains.position[0].x - 20e-3;
  }
  descent.speed = grains.velocity[0].x;
  return descent;
}

TEST(RollingResistance, HoldsASphereOnASlopeBelowItsAngleForGood) {
  for (const double restitution : {0.3, 1.0})
    for (const double slope : {0.02, 0.1, 0.19}) {
      const Descent d = descend(slope, 0.2, restitution);
      EXPECT_GT(d.early, 0) << "the spring has bent";
      EXPECT_LT(d.early, 1e-3 * 1e-3) << slope;
      EXPECT_LE(std::abs(d.late - d.early), 1e-12) << slope;
      EXPECT_LE(std::abs(d.speed), 1e-10) << slope;
    }
}

TEST(RollingResistance, SpringsBackWithoutMakingEnergy) {
  for (const double friction : {0.0, 0.4, 1.0})
    for (const double angle : {0.0, 0.5, 1.0, 1.3})
      for (const double spin : {-500.0, 0.0, 200.0}) {
        BedScene scene = grain_scene(Side::periodic, Side::wall);
        scene.grains = rough(0.5, 1);
        scene.grains.friction = friction;
        Grains grains;
        add_grain(grains, {20e-3, 20e-3, 0.5e-3}, {0.3 * std::sin(angle), 0, -0.3 * std::cos(angle)});
        grains.spin[0] = {50, spin, -20};
        const double before = kinetic_energy(grains);
        GrainDynamics dynamics(scene);
        ContactHistory contacts;
        do {
          coast(dynamics, grains, contacts, contact_time(1e-3, 2500, 1e7, 0.3, 0.3) / 200);
          EXPECT_LE(kinetic_energy(grains), before * (1 + 1e-3));
        } while (grains.position[0].z < 0.5e-3);
      }
}

TEST(RollingResistance, ConservesMomentumAndAngularMomentum) {
  BedScene scene = grain_scene(Side::wall, Side::wall);
  scene.grains.rolling_friction = 0.3;
  Grains grains;
  add_grain(grains, {20e-3, 20e-3, 20e-3}, {0.2, 0.05, 0}, 1e-3);
  add_grain(grains, {21.4e-3, 20.3e-3, 20.1e-3}, {-0.2, 0, 0.03}, 1.6e-3, 4000);
  grains.spin = {{300, -100, 50}, {0, 80, -20}};
  const Vec3 before = momentum(grains), turning = angular_momentum(grains);
  const double energy = kinetic_energy(grains);
  GrainDynamics dynamics(scene);
  ContactHistory contacts;
  bool rolled = false;
  for (int n = 0; n < 100; ++n) {
    coast(dynamics, grains, contacts, scene.dem_step, 10);
    rolled = rolled || (contacts.size() == 1 && norm(contacts.rolling[0]) > 0);
  }
  EXPECT_TRUE(rolled);
  EXPECT_LT(kinetic_energy(grains), energy);
  EXPECT_LE(norm(momentum(grains) - before), 1e-13 * norm(before));
  EXPECT_LE(norm(angular_momentum(grains) - turning), 0x1p-24 * norm(turning));   // torques of contacts are float
}

}   // namespace
}   // namespace bedload

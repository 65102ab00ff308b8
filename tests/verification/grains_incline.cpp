// A sphere on an incline and one thrown along a plane: friction and spin against exact answers, band 0.5 %.
#include <gtest/gtest.h>

#include "tests/solver/grains/grain_scenes.hpp"

namespace bedload {
namespace {

constexpr double g = 9.81;

/// A sphere at rest on the floor, its overlap carrying its weight.
Grains resting_sphere(const BedScene& scene, double normal_gravity) {
  Grains grains;
  add_grain(grains, {20e-3, 20e-3, 0.5e-3});
  const double modulus = scene.grains.young_modulus / (2 * (1 - 0.09));
  grains.position[0].z -= std::pow(0.75 * mass_of(grains, 0) * normal_gravity / (modulus * std::sqrt(0.5e-3)), 2.0 / 3);
  return grains;
}

/// Acceleration down a slope, from the speed gained over 50 ms, once springs have bent.
double acceleration_down(double slope, double friction, double rolling_friction = 0) {
  BedScene scene = grain_scene(Side::periodic, Side::wall);
  scene.grains.friction = friction;
  scene.grains.rolling_friction = rolling_friction;
  Grains grains = resting_sphere(scene, g * std::cos(slope));
  GrainDynamics dynamics(scene);
  ContactHistory contacts;
  const int steps = static_cast<int>(0.05 / scene.dem_step);
  const Vec3 pull{g * std::sin(slope), 0, -g * std::cos(slope)};
  coast(dynamics, grains, contacts, scene.dem_step, steps, pull);
  const double before = grains.velocity[0].x;
  coast(dynamics, grains, contacts, scene.dem_step, steps, pull);
  return (grains.velocity[0].x - before) / (steps * scene.dem_step);
}

TEST(SphereOnAnIncline, SlidesWhereTheSlopeIsSteeperThanSevenHalvesOfFriction) {
  const double slope = 0.6, friction = 0.15;   // tan .6 = .684 > 3.5 x .15
  const double exact = g * (std::sin(slope) - friction * std::cos(slope));
  EXPECT_NEAR(acceleration_down(slope, friction), exact, 0.005 * exact);
}

TEST(SphereOnAnIncline, RollsWhereItIsNot) {
  for (const double slope : {0.05, 0.3}) {
    const double exact = 5.0 / 7 * g * std::sin(slope);
    EXPECT_NEAR(acceleration_down(slope, 0.4), exact, 0.005 * exact) << slope;
  }
}

// m a = m g sin b - f, 2/5 m R a = f R - mu_r m g R cos b.
TEST(SphereOnAnIncline, RollsMoreSlowlyAgainstRollingFriction) {
  for (const double rolling : {0.02, 0.1, 0.25}) {
    const double slope = 0.3, exact = 5.0 / 7 * g * (std::sin(slope) - rolling * std::cos(slope));
    EXPECT_NEAR(acceleration_down(slope, 0.4, rolling), exact, 0.005 * exact) << rolling;
  }
}

TEST(SphereOnAnIncline, RestsWhereTheSlopeIsLessThanRollingFriction) {
  EXPECT_NEAR(acceleration_down(0.3, 0.4, 0.32), 0, 1e-8);   // tan .3 = .309
}

TEST(SphereOnAPlane, EndsRollingAtFiveSeventhsOfItsSpeedAfterItsTime) {
  BedScene scene = grain_scene(Side::periodic, Side::wall);
  const double v0 = 0.2, friction = 0.3, exact_time = 2 * v0 / (7 * friction * g);
  scene.grains.friction = friction;
  Grains grains = resting_sphere(scene, g);
  grains.velocity[0].x = v0;
  GrainDynamics dynamics(scene);
  ContactHistory contacts;
  double time = 0;
  while (grains.velocity[0].x - 0.5e-3 * grains.spin[0].y > 0.001 * v0) {
    coast(dynamics, grains, contacts, scene.dem_step, 1, {0, 0, -g});
    time += scene.dem_step;
  }
  EXPECT_NEAR(time, exact_time, 0.005 * exact_time);
  coast(dynamics, grains, contacts, scene.dem_step, 2000, {0, 0, -g});
  EXPECT_NEAR(grains.velocity[0].x, 5.0 / 7 * v0, 0.005 * v0);
}

}   // namespace
}   // namespace bedload

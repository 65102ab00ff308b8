#include <gtest/gtest.h>

#include "solver/grains/contact_laws.hpp"
#include "tests/solver/grains/grain_scenes.hpp"

namespace bedload {
namespace {

BedScene soft_scene(double diameter, double density_ratio, double viscosity) {
  BedScene scene;
  scene.fluid = {1000, viscosity};
  scene.grains = {diameter, 1000 * density_ratio, 0.05, 0.4, 0.6, 0.3, 0};
  scene.source = {BedSource::Kind::poured, 1500, "", 1};
  scene.length = {20 * diameter, 12 * diameter, 13 * diameter};
  scene.sides = {Side::periodic, Side::periodic, Side::wall};
  scene.gravity = {0, 0, -9.81};
  return scene;
}

// The scene whose cost was measured when the rule was chosen: 1500 grains on 20 x 12 d, E 1.3-3.2e5 Pa, steps of
// 2.6-3.3e-5 s.
TEST(Stiffness, IsThatOfTheReferenceScene) {
  for (const double d : {0.5e-3, 0.6e-3})
    for (const double s : {2.0, 3.0}) {
      const BedScene scene = soft_scene(d, s, 1e-5);
      const double modulus = automatic_young_modulus(scene, bed_layers(scene));
      EXPECT_GE(modulus, 1.25e5);
      EXPECT_LE(modulus, 3.25e5);
      const double dt = 0.2 * rayleigh_time(0.9 * d, 1000 * s, modulus, 0.3);
      EXPECT_GE(dt, 2.55e-5);
      EXPECT_LE(dt, 3.35e-5);
    }
}

TEST(Stiffness, LetsTheLowestGrainSinkHalfAPercentUnderTheBed) {
  BedScene scene = soft_scene(0.5e-3, 2, 1e-5);
  const double layers = 8, weight = 1000 * 9.81 * sphere_volume(0.5e-3);
  scene.grains.young_modulus = automatic_young_modulus(scene, layers);
  Overlap o;
  o.depth = 0.005 * 0.5e-3, o.root_radius = std::sqrt(0.125e-3), o.mass = 1, o.normal = {0, 0, 1};
  EXPECT_NEAR(-HertzMindlin(scene.grains).respond(o, {}, 1e-6).force.z, layers * weight, 0.001 * layers * weight);
}

TEST(Stiffness, LetsTheFastestCollisionOverlapTwoPercent) {
  BedScene scene =
      soft_scene(1e-3, 2.65, 1e-6);   // Ga = 127: the speed is the greater of U_t and sqrt((s-1) g d) = 0.127
  scene.grains.young_modulus = automatic_young_modulus(scene, 1e-6);
  const double mass = 2650 * sphere_volume(1e-3) / 2, modulus = scene.grains.young_modulus / (2 * 0.91);
  // overlap (15 m* v^2/(16 Y* sqrt R*))^(2/5) = 2 % solved for v
  const double v = std::sqrt(std::pow(0.02 * 1e-3, 2.5) * 16 * modulus * std::sqrt(0.25e-3) / (15 * mass));
  EXPECT_NEAR(v, 0.153, 0.003);   // Schiller and Naumann's terminal speed of quartz of 1 mm in water, Re 153
}

TEST(Stiffness, CountsTheLayersOfABed) {
  BedScene scene = soft_scene(0.5e-3, 2, 1e-5);
  EXPECT_NEAR(bed_layers(scene), 5.8 / std::sqrt(2.0 / 3) * 0.94, 0.1);   // the reference bed was 5.8 d high at .565
  scene.source.count = 3;
  EXPECT_EQ(bed_layers(scene), 1);
}

}   // namespace
}   // namespace bedload

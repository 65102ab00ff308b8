#include "solver/grains/films.hpp"

#include <gtest/gtest.h>

#include "tests/solver/grains/grain_scenes.hpp"

namespace bedload {
namespace {

constexpr double pi = std::numbers::pi;
constexpr ContactTerms lubricated{.lubrication = true};

TEST(FilmLaw, TakesFifthRoots) {
  EXPECT_EQ(fifth_root(0), 0);
  EXPECT_EQ(fifth_root(1), 1);
  for (int n = -200; n < 100; ++n) {
    const double q = 1.37 * std::pow(10, n);
    const double s = fifth_root(q);
    EXPECT_NEAR(s * s * s * s * s / q, 1, 4e-15) << q;
  }
}

BedScene stiff_scene() {
  BedScene scene = grain_scene(Side::wall, Side::wall);
  scene.grains.young_modulus = 1e12;   // elasticity out of the way
  scene.fluid = {1000, 1e-4};
  return scene;
}

// Brenner 1961, Jeffrey & Onishi 1984, to leading order: 6 pi mu R*^2 v/g; here less its value at the thickest film.
TEST(FilmLaw, IsThatOfRigidSpheresAndBeginsFromZero) {
  const FilmLaw law(stiff_scene());
  const double r = 0.25e-3, thickest = FilmLaw::thickest * r;
  for (const double gap : {1e-6, 1e-5, 9e-5})
    EXPECT_NEAR(law.resistance(gap, r, 1e-3) / (6 * pi * 0.1 * r * r * (1 / gap - 1 / thickest)), 1, 1e-12);
  EXPECT_EQ(law.resistance(thickest, r, 1e-3), 0);
  EXPECT_EQ(law.resistance(1, r, 1e-3), 0);
  EXPECT_LT(law.resistance(thickest * (1 - 1e-9), r, 1e-3), 1e-7 * law.resistance(thickest / 2, r, 1e-3));
}

TEST(FilmLaw, GoesOnThroughAContactAtTheElasticGap) {
  BedScene scene = stiff_scene();
  scene.grains.young_modulus = 1e7;
  const FilmLaw law(scene);
  const double r = 0.25e-3, v = 0.05, modulus = 1e7 / (2 * 0.91);
  const double h = std::pow(3 * pi / std::sqrt(2.0) * 0.1 * std::pow(r, 1.5) * v / modulus, 0.4);
  EXPECT_NEAR(law.elastic_gap(r, v) / h, 1, 1e-12);
  EXPECT_EQ(law.elastic_gap(r, -v), law.elastic_gap(r, v));
  EXPECT_EQ(law.resistance(-1e-6, r, v), law.resistance(0, r, v));
  EXPECT_EQ(law.resistance(0.99 * h, r, v), law.resistance(0, r, v));
  EXPECT_LT(law.resistance(1.01 * h, r, v), law.resistance(0, r, v));
  EXPECT_LE(law.resistance(0, r, 0), 6 * pi * 0.1 * r / FilmLaw::thinnest) << "roughness bounds it at rest";
  EXPECT_GT(law.resistance(0, r, 1e6), 0) << "never vanishes, however soft";
}

// The pressure of a film of uniform approach is 3 mu R v/h^2, h = x + r^2/(2 R) (Reynolds); on an elastic half-space it
// bends the surface at the centre by the integral of p/(pi Y*) over dA/r (Boussinesq). At the elastic gap that is the gap.
TEST(FilmLaw, HasTheElasticGapAtWhichItsPressureBendsTheSurfaceAsMuch) {
  BedScene scene = stiff_scene();
  scene.grains.young_modulus = 1e7;
  const double r = 0.25e-3, v = 0.05, modulus = 1e7 / (2 * 0.91), x = FilmLaw(scene).elastic_gap(r, v);
  double bend = 0;
  const double width = std::sqrt(r * x), step = 1e-3;
  for (double s = step / 2; s < 100; s += step) {   // distance from the centre, in widths
    const double h = x + s * s * width * width / (2 * r);
    bend += 3 * 0.1 * r * v / (h * h) / (pi * modulus) * 2 * pi * width * step;
  }
  EXPECT_NEAR(bend / x, 1, 1e-3);
}

/// The first force of a film on two grains of these diameters, `gap` apart in units of R*, or on one before the floor.
double film_force(double first, double second, double gap) {
  BedScene scene = stiff_scene();
  Grains grains;
  if (second > 0) {
    const double r = first * second / (first + second) / 2, distance = (first + second) / 2 + gap * r;
    add_grain(grains, {20e-3 - distance / 2, 20e-3, 20e-3}, {0.01, 0, 0}, first);
    add_grain(grains, {20e-3 + distance / 2, 20e-3, 20e-3}, {-0.01, 0, 0}, second);
  } else {
    add_grain(grains, {20e-3, 20e-3, first / 2 * (1 + gap)}, {0, 0, -0.01}, first);
  }
  GrainDynamics dynamics(scene, lubricated);
  ContactHistory contacts;
  coast(dynamics, grains, contacts, 1e-9);
  if (second > 0) {
    EXPECT_EQ(grains.mean_contact_force[0], -grains.mean_contact_force[1]);
  }
  EXPECT_EQ(contacts.size(), 0u) << "a film is no contact";
  return norm(grains.mean_contact_force[0]);
}

TEST(Films, ReachAsFarAsTheThickestFilm) {
  for (const double second : {1e-3, 5e-3, 0.0}) {
    EXPECT_GT(film_force(1e-3, second, FilmLaw::thickest * 0.999), 0) << second;
    EXPECT_EQ(film_force(1e-3, second, FilmLaw::thickest * 1.001), 0) << second;
  }
}

TEST(Films, ResistPartingAsTheyResistApproach) {
  BedScene scene = stiff_scene();
  for (const double speed : {0.01, -0.01}) {
    Grains grains;
    add_grain(grains, {20e-3, 20e-3, 0.52e-3}, {0, 0, -speed});
    GrainDynamics dynamics(scene, lubricated);
    ContactHistory contacts;
    const GrainHealth health = coast(dynamics, grains, contacts, 1e-9);
    EXPECT_GT(grains.mean_contact_force[0].z * speed, 0);
    EXPECT_EQ(health.force_on_walls.z, -grains.mean_contact_force[0].z);
  }
}

TEST(Films, DoNotHinderSlidingOrTurning) {
  BedScene scene = stiff_scene();
  Grains grains;
  add_grain(grains, {20e-3, 20e-3, 20e-3}, {0, 0.01, 0.02});
  add_grain(grains, {21.01e-3, 20e-3, 20e-3}, {0, 0, -0.01});
  grains.spin[0] = {10, 20, 30};
  GrainDynamics dynamics(scene, lubricated);
  ContactHistory contacts;
  coast(dynamics, grains, contacts, 1e-9);
  EXPECT_EQ(grains.mean_contact_force[0], Vec3{});
  EXPECT_EQ(grains.mean_contact_torque[0], Vec3{});
}

// Under its weight a grain before a wall sinks as the film lets it: v = m g/(6 pi mu a^2 (1/g - 1/g_max)).
TEST(Films, LetAGrainSinkAsSlowlyAsReynoldsSays) {
  const BedScene scene = stiff_scene();
  Grains grains;
  add_grain(grains, {20e-3, 20e-3, 0.53e-3});
  GrainDynamics dynamics(scene, lubricated);
  ContactHistory contacts;
  const double dt = 2e-6, a = 0.5e-3;   // film: 1/(dt c/m) = 0.8 steps
  coast(dynamics, grains, contacts, dt, 500, {0, 0, -9.81});
  const double gap = grains.position[0].z - a;
  EXPECT_GT(gap, 0.02e-3);
  const double exact = mass_of(grains, 0) * 9.81 / (6 * pi * 0.1 * a * a * (1 / gap - 1 / (FilmLaw::thickest * a)));
  EXPECT_NEAR(-grains.velocity[0].z / exact, 1, 0.01);
}

/// Grains of 20 micron, one in eight five times as large, in a liquid 10 000 times as viscous as water.
struct FineGas {
  BedScene scene;
  Grains grains;
};

FineGas fine_gas(double viscosity) {
  FineGas gas{grain_scene(Side::periodic, Side::wall), {}};
  gas.scene.length = {0.6e-3, 0.6e-3, 0.6e-3};
  gas.scene.fluid = {1000, viscosity};
  gas.scene.dem_step = 3e-7;
  for (int n = 0; n < 216; ++n) {
    const Vec3 place = 1e-4 * Vec3{n % 6 + 0.5, n / 6 % 6 + 0.5, n / 36 + 0.51};
    add_grain(gas.grains, place + 1e-6 * Vec3{std::sin(n), std::cos(n), 0},
              0.05 * Vec3{std::sin(12.9 * n), std::sin(78.2 * n), std::sin(37.7 * n)}, n % 8 ? 20e-6 : 99e-6);
  }
  return gas;
}

TEST(Films, NeverGiveEnergyHoweverLongTheStep) {
  for (const double viscosity : {1e-6, 1e-3, 1e-2})
    for (const double stretch : {1.0, 100.0}) {
      FineGas gas = fine_gas(viscosity);
      gas.scene.grains.young_modulus = 1e6 / (stretch * stretch);   // contacts are explicit and need that
      GrainDynamics dynamics(gas.scene, lubricated);
      ContactHistory contacts;
      double before = kinetic_energy(gas.grains);
      const double begin = before;
      for (int n = 0; n < 300; ++n) {
        coast(dynamics, gas.grains, contacts, gas.scene.dem_step * stretch);
        const double now = kinetic_energy(gas.grains);
        if (contacts.size() == 0) {
          EXPECT_LE(now, before * (1 + 1e-12)) << n;
        }
        EXPECT_LE(now, begin * 1.001) << n;
        before = now;
      }
      EXPECT_LT(before, begin);
    }
}

TEST(Films, NeverTurnAGrainRoundHoweverManyItHas) {
  // The densest cage: twelve fixed neighbours, sum of n n = 4. Were each film to stop the grain alone, all would give it -3 v.
  const BedScene scene = stiff_scene();
  const double distance = 1.001e-3 / std::sqrt(2.0);
  const Vec3 middle{20e-3, 20e-3, 20e-3}, v{1e-3, 2e-3, -0.5e-3};
  Grains grains;
  add_grain(grains, middle, v);
  for (int c = 0; c < 3; ++c)
    for (const double a : {-1.0, 1.0})
      for (const double b : {-1.0, 1.0}) {
        Vec3 place = middle;
        place[(c + 1) % 3] += a * distance, place[(c + 2) % 3] += b * distance;
        grains.fixed[add_grain(grains, place)] = 1;
      }
  GrainDynamics dynamics(scene, lubricated);
  ContactHistory contacts;
  coast(dynamics, grains, contacts, 1e-2);   // some thousand times m/c
  EXPECT_LT(norm(grains.velocity[0]), 0.9 * norm(v)) << "films have acted";
  EXPECT_GE(dot(grains.velocity[0], v), 0);
}

TEST(Films, ConserveMomentumAndAngularMomentum) {
  const BedScene scene = [] {
    BedScene s = grain_scene(Side::wall, Side::wall);
    s.fluid = {1000, 1e-4};
    return s;
  }();
  Grains grains;
  add_grain(grains, {20e-3, 20e-3, 20e-3}, {0.2, 0.05, 0}, 1e-3);
  add_grain(grains, {21.4e-3, 20.3e-3, 20.1e-3}, {-0.2, 0, 0.03}, 1.6e-3, 4000);
  add_grain(grains, {20.2e-3, 21.1e-3, 20.4e-3}, {0, -0.3, -0.1}, 0.7e-3);
  grains.spin = {{300, -100, 50}, {0, 80, -20}, {-500, 10, 900}};
  const Vec3 before = momentum(grains), turning = angular_momentum(grains);
  const double energy = kinetic_energy(grains);
  GrainDynamics dynamics(scene, lubricated);
  ContactHistory contacts;
  for (int n = 0; n < 100; ++n) coast(dynamics, grains, contacts, scene.dem_step, 10);
  EXPECT_LT(kinetic_energy(grains), 0.7 * energy) << "films have acted";
  EXPECT_LE(norm(momentum(grains) - before), 1e-13 * norm(before));
  EXPECT_LE(norm(angular_momentum(grains) - turning), 1e-11 * norm(turning));
}

// The mirror image of a cluster moves as the mirror image: nothing depends on the order of films.
TEST(Films, KnowNoDirection) {
  BedScene scene = stiff_scene();
  scene.fluid.viscosity = 1e-2;
  Grains grains;
  const double gap = 1.003e-3;
  add_grain(grains, {20e-3 - gap, 20e-3, 20e-3}, {0.01, 0, 0});
  add_grain(grains, {20e-3, 20e-3, 20e-3});
  add_grain(grains, {20e-3 + gap, 20e-3, 20e-3}, {-0.01, 0, 0});
  GrainDynamics dynamics(scene, lubricated);
  ContactHistory contacts;
  coast(dynamics, grains, contacts, 1e-5, 20);
  EXPECT_EQ(grains.velocity[1], Vec3{});
  EXPECT_EQ(grains.velocity[0].x, -grains.velocity[2].x);
}

}   // namespace
}   // namespace bedload

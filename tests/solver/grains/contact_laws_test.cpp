#include "solver/grains/contact_laws.hpp"

#include <gtest/gtest.h>

#include "tests/solver/grains/grain_scenes.hpp"

namespace bedload {
namespace {

constexpr double pi = std::numbers::pi;

/// Two grains that meet head on along x at a relative speed; followed until they part.
struct Collision {
  double duration, deepest, restitution;
};

Collision collide_head_on(const GrainProperties& properties, double speed, double dt) {
  BedScene scene = grain_scene(Side::wall, Side::wall);
  scene.grains = properties;
  const double d = properties.diameter;
  Grains grains;
  add_grain(grains, {20e-3 - d / 2, 20e-3, 20e-3}, {speed / 2, 0, 0}, d, properties.density);
  add_grain(grains, {20e-3 + d / 2, 20e-3, 20e-3}, {-speed / 2, 0, 0}, d, properties.density);
  GrainDynamics dynamics(scene);
  ContactHistory contacts;
  Collision c{};
  double gap_before = 0;
  for (int step = 0; step < 1000000; ++step) {
    coast(dynamics, grains, contacts, dt);
    const double gap = grains.position[1].x - grains.position[0].x - d;
    c.deepest = std::max(c.deepest, -gap);
    if (gap > 0) {   // when it opened, within the step
      c.duration = (step + gap_before / (gap_before - gap)) * dt;
      break;
    }
    gap_before = gap;
  }
  c.restitution = (grains.velocity[1].x - grains.velocity[0].x) / speed;
  return c;
}

GrainProperties glassy(double restitution, double friction) { return {1e-3, 2500, 0, friction, restitution, 0.3, 1e7}; }

// Hertz 1882: 2.87 (m*^2/(R* Y*^2 v))^(1/5), and (15 m* v^2/(16 Y* sqrt R*))^(2/5).
TEST(ContactLaws, CollideAsLongAndAsDeepAsHertzSays) {
  for (const double v : {0.01, 0.1, 0.5}) {
    const double tc = contact_time(1e-3, 2500, 1e7, 0.3, v);
    const Collision c = collide_head_on(glassy(1, 0), v, tc / 400);
    const double mass = 2500 * pi / 6 * 1e-9 / 2, modulus = 1e7 / (2 * (1 - 0.09)), radius = 0.25e-3;
    EXPECT_NEAR(c.duration / tc, 1, 0.01) << v;
    EXPECT_NEAR(c.deepest / std::pow(15 * mass * v * v / (16 * modulus * std::sqrt(radius)), 0.4), 1, 0.01) << v;
  }
}

TEST(ContactLaws, ReboundWithTheRestitutionTheyWereGiven) {
  for (const double e : {0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.97, 1.0})
    for (const double v : {0.02, 0.5}) {
      const double tc = contact_time(1e-3, 2500, 1e7, 0.3, v);
      EXPECT_NEAR(collide_head_on(glassy(e, 0.3), v, tc / 200).restitution, e, 0.01) << "at " << v << " m/s";
    }
}

TEST(ContactLaws, ReboundLikewiseAtTheStepOfARun) {
  // A collision at 0.1 m/s lasts 19 such steps. It begins and ends somewhere within one, and forces miss that part of it:
  // half a step of 19 is 0.03.
  for (const double e : {0.3, 0.5, 0.6, 0.8, 1.0}) {
    const double dt = 0.2 * rayleigh_time(1e-3, 2500, 1e7, 0.3);
    EXPECT_NEAR(collide_head_on(glassy(e, 0.3), 0.1, dt).restitution, e, 0.03) << e;
  }
}

TEST(ContactLaws, HardlyReboundWithoutRestitution) {
  const double tc = contact_time(1e-3, 2500, 1e7, 0.3, 0.1);
  const Collision c = collide_head_on(glassy(0, 0.3), 0.1, tc / 200);
  EXPECT_GE(c.restitution, 0);
  EXPECT_LE(c.restitution, HertzMindlin::lowest_restitution + 0.01);
}

TEST(ContactLaws, CalibrateDampingAndRestitutionToEachOther) {
  EXPECT_EQ(damping_of_restitution(1), 0);
  EXPECT_NEAR(restitution_of_damping(0), 1, 1e-6);
  for (const double e : {0.1, 0.3, 0.7, 0.99}) EXPECT_NEAR(restitution_of_damping(damping_of_restitution(e)), e, 1e-5);
  // Where contacts may pull, ln e/sqrt(ln^2 e + pi^2) would do; where they may not, it gives .548 for .5.
  const double log_e = std::log(0.5),
               uncalibrated = -2 * std::sqrt(5.0 / 6) * log_e / std::sqrt(log_e * log_e + pi * pi);
  EXPECT_NEAR(restitution_of_damping(uncalibrated), 0.548, 0.005);
}

Overlap resting_overlap() {
  Overlap o;
  o.depth = 5e-6, o.root_radius = std::sqrt(0.25e-3), o.mass = 6.5e-7;
  o.normal = {0, 0, 1};
  return o;
}

// Mindlin 1949: dF_t/dxi = 8 G* sqrt(R* delta), G* = G/(2 (2 - nu)) for like grains.
TEST(ContactLaws, HaveMindlinsTangentialStiffness) {
  const HertzMindlin law(glassy(1, 10));
  Overlap o = resting_overlap();
  o.velocity = {1e-3, 0, 0};
  const double dt = 1e-6, shear_modulus = 1e7 / (2 * 1.3) / (2 * 1.7);
  const ContactForce r = law.respond(o, {}, dt);
  EXPECT_NEAR(r.force.x, -8 * shear_modulus * std::sqrt(0.25e-3 * 5e-6) * 1e-9, 1e-9 * std::abs(r.force.x));
  EXPECT_NEAR(r.force.z, -4.0 / 3 * 1e7 / (2 * 0.91) * std::sqrt(0.25e-3) * std::pow(5e-6, 1.5),
              1e-12 * std::abs(r.force.z));
  EXPECT_EQ(r.force.y, 0);
}

TEST(ContactLaws, NeverPullAndNeverPassCoulombsCap) {
  for (const double friction : {0.0, 0.3, 1.0}) {
    const HertzMindlin elastic(glassy(1, friction)), damped(glassy(0.5, friction));
    for (int n = 0; n < 2000; ++n) {
      const HertzMindlin& law = n % 2 ? damped : elastic;
      Overlap o = resting_overlap();
      o.depth *= std::sin(1.7 * n);   // apart, too
      o.velocity = 0.3 * Vec3{std::sin(3.0 * n), std::sin(5.0 * n), std::sin(7.0 * n)};
      const ContactForce r =
          law.respond(o, 1e-5 * Vec3{std::sin(11.0 * n), std::sin(13.0 * n), std::sin(17.0 * n)}, 1e-6);
      EXPECT_LE(r.force.z, 0);
      EXPECT_LE(std::hypot(r.force.x, r.force.y), friction * -r.force.z * (1 + 1e-12));
      if (o.depth <= 0) {
        EXPECT_TRUE(r.force == Vec3{} && r.spring == Vec3{});
      }
    }
  }
}

TEST(ContactLaws, KeepTheTangentialForceOfAGrowingContactAndLetItFallWithAShrinkingOne) {
  const HertzMindlin law(glassy(1, 10));
  const double dt = 1e-6, step = 1e-7;
  Overlap o = resting_overlap();
  const Vec3 spring{1e-8, 0, 0};
  const double before = law.respond(o, spring, dt).force.x;
  o.depth += step, o.velocity = {0, 0, step / dt};
  EXPECT_NEAR(law.respond(o, spring, dt).force.x / before, 1, 2e-4);   // second order in the step
  o.depth -= 2 * step, o.velocity = {0, 0, -step / dt};
  EXPECT_NEAR(law.respond(o, spring, dt).force.x / before, std::sqrt(o.depth / 5e-6), 1e-9);
}

/// A grain thrown against the floor at an angle; returns its rebound.
Grains bounce_off_floor(const GrainProperties& properties, Vec3 velocity, Vec3 spin, double* most_energy = nullptr) {
  BedScene scene = grain_scene(Side::periodic, Side::wall);
  scene.grains = properties;
  Grains grains;
  add_grain(grains, {20e-3, 20e-3, 0.5e-3}, velocity, 1e-3, properties.density);
  grains.spin[0] = spin;
  GrainDynamics dynamics(scene);
  ContactHistory contacts;
  const double dt = contact_time(1e-3, 2500, 1e7, 0.3, -velocity.z) / 200;
  do {
    coast(dynamics, grains, contacts, dt);
    if (most_energy) *most_energy = std::max(*most_energy, kinetic_energy(grains));
  } while (grains.position[0].z < 0.5e-3);
  return grains;
}

// Foerster et al. 1994: gross sliding takes mu (1 + e) v_n off the tangential speed, and 5/2 of it goes into spin, so
// that the speed of the contact point falls by 7/2 (1 + e) mu v_n.
TEST(ContactLaws, SlideThroughAnObliqueCollisionAsCoulombSays) {
  const double e = 0.87, mu = 0.25, vn = 0.2, vt = 0.5;   // Psi_1 = 2.5 > 7/2 (1 + e) mu = 1.64
  const Grains after = bounce_off_floor(glassy(e, mu), {vt, 0, -vn}, {});
  const double contact_speed = after.velocity[0].x - after.spin[0].y * 0.5e-3;
  EXPECT_NEAR(contact_speed / vn, vt / vn - 3.5 * (1 + e) * mu, 0.01 * vt / vn);
  EXPECT_NEAR(after.velocity[0].x, vt - mu * (1 + e) * vn, 0.01 * vt);
}

TEST(ContactLaws, NeverGainEnergyInAnElasticCollisionWithFriction) {
  for (const double friction : {0.0, 0.1, 0.4, 1.0})
    for (const double angle : {0.0, 0.2, 0.5, 1.0, 1.3})
      for (const double spin : {-500.0, 0.0, 200.0}) {
        const Vec3 velocity{0.3 * std::sin(angle), 0, -0.3 * std::cos(angle)};
        Grains before;
        add_grain(before, {}, velocity);
        before.spin[0] = {50, spin, -20};
        double most = 0;
        const Grains after = bounce_off_floor(glassy(1, friction), velocity, before.spin[0], &most);
        EXPECT_LE(kinetic_energy(after), kinetic_energy(before) * (1 + 1e-3))
            << friction << " " << angle << " " << spin;
        EXPECT_LE(most, kinetic_energy(before) * (1 + 1e-3)) << friction << " " << angle << " " << spin;
      }
}

}   // namespace
}   // namespace bedload

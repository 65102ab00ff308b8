// Collisions with a wall, dry and oblique, and wet: against exact answers and against the fit of experiments.
#include <gtest/gtest.h>

#include "tests/solver/grains/grain_scenes.hpp"

namespace bedload {
namespace {

BedScene impact_scene(GrainProperties grains) {
  BedScene scene = grain_scene(Side::periodic, Side::wall);
  scene.grains = grains;
  return scene;
}

/// Thrown at the floor from `gap` above it; followed until it is as far away again, or has stopped.
Grains bounce(const BedScene& scene, ContactTerms terms, Vec3 velocity, double gap, double dt) {
  const double radius = scene.grains.diameter / 2;
  Grains grains;
  add_grain(grains, {20e-3, 20e-3, radius + gap}, velocity, 2 * radius, scene.grains.density);
  GrainDynamics dynamics(scene, terms);
  ContactHistory contacts;
  const double patience = 100 * (gap + radius) / -velocity.z;
  for (double time = 0; time < patience; time += dt) {
    coast(dynamics, grains, contacts, dt);
    if (grains.velocity[0].z > 0 && grains.position[0].z >= radius + gap) break;
  }
  return grains;
}

/// Foerster, Louge, Chang & Allia 1994: glass and cellulose acetate.
struct Material {
  double diameter, density, restitution, friction;
};

// Gross sliding takes 7/2 (1 + e) mu v_n off the speed of the contact point: Psi = v_t/v_n after = before - 7/2 (1 + e) mu.
TEST(ObliqueImpact, SlidesAsCoulombSays) {
  for (const Material m : {Material{3.18e-3, 2500, 0.97, 0.092}, Material{6e-3, 1319, 0.87, 0.25}})
    for (const double excess : {1.3, 2.0, 4.0}) {
      const BedScene scene = impact_scene({m.diameter, m.density, 0, m.friction, m.restitution, 0.25, 1e8});
      const double vn = 0.3, fall = 3.5 * (1 + m.restitution) * m.friction, before = excess * fall;
      const double dt = contact_time(m.diameter, m.density, 1e8, 0.25, vn) / 400;
      const Grains after = bounce(scene, {}, {before * vn, 0, -vn}, 0, dt);
      const double psi = (after.velocity[0].x - after.spin[0].y * m.diameter / 2) / vn;
      EXPECT_NEAR(psi, before - fall, 0.01 * before) << m.friction << " " << before;
    }
}

constexpr double wet_dry_restitution = 0.97, wet_speed = 0.1;

/// Rebound per dry rebound of a bead of 1 mm, 2500 kg/m3 at a Stokes number of (rho_p + added rho_f) d U/(9 mu).
double wet_rebound(double stokes, ContactTerms terms, double added, double young_modulus) {
  BedScene scene = impact_scene({1e-3, 2500, 0, 0.1, wet_dry_restitution, 0.3, young_modulus});
  scene.fluid = {1000, (2500 + added * 1000) * 1e-3 * wet_speed / (9 * stokes) / 1000};
  const double dt = 0.1 * rayleigh_time(1e-3, 2500, young_modulus, 0.3);
  const double rebound = bounce(scene, terms, {0, 0, -wet_speed}, 0.25e-3, dt).velocity[0].z;
  return rebound / wet_speed / wet_dry_restitution;
}

// exp(-35/St) fits Joseph et al. 2001 and Gondret, Lance & Petit 2002 (Legendre et al. 2006).
TEST(WetBounce, HasTheRestitutionOfItsStokesNumber) {
  for (const double stokes : {20.0, 31.0, 50.0, 100.0, 200.0, 500.0, 2000.0})
    EXPECT_NEAR(wet_rebound(stokes, {.wet_restitution = true}, 0.5, 1e7), std::exp(-35 / stokes), 0.02) << stokes;
}

// The film alone, nothing fitted, for overlaps of a collision of 0.5 and 0.2 % of the diameter.
TEST(WetBounce, IsThatOfTheFilm) {
  for (const double young_modulus : {1e7, 1e8})
    for (const double stokes : {31.0, 50.0, 100.0, 200.0, 500.0, 2000.0})
      EXPECT_NEAR(wet_rebound(stokes, {.lubrication = true}, 0, young_modulus), std::exp(-35 / stokes), 0.1)
          << stokes << " " << young_modulus;
}

TEST(WetBounce, FailsBelowStokesNumberTen) { EXPECT_LE(wet_rebound(10, {.lubrication = true}, 0, 1e7), 1e-9); }

}   // namespace
}   // namespace bedload

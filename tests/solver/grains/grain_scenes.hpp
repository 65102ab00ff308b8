// Small scenes and oracles for tests of grains.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "solver/grains/bed_packing.hpp"
#include "solver/grains/grain_dynamics.hpp"

namespace bedload {

/// Every choice that GrainDynamics has.
inline constexpr ContactTerms all_contact_terms[] = {{}, {.wet_restitution = true}, {.lubrication = true}};

/// A box of 40 x 40 x 40 mm for grains of 1 mm, 2500 kg/m3, E 1 MPa; no gravity, no fluid to speak of.
inline BedScene grain_scene(Side across, Side vertical) {
  BedScene scene;
  scene.fluid = {1000, 1e-6};
  scene.grains = {1e-3, 2500, 0, 0.5, 0.7, 0.3, 1e6};
  scene.length = {40e-3, 40e-3, 40e-3};
  scene.sides = {across, across, vertical};
  scene.dem_step = 0.2 * rayleigh_time(1e-3, 2500, 1e6, 0.3);
  return scene;
}

inline std::uint32_t add_grain(Grains& grains, Vec3 position, Vec3 velocity = {}, double diameter = 1e-3,
                               double density = 2500) {
  const std::size_t i = grains.size();
  grains.resize(i + 1);
  grains.position[i] = position;
  grains.velocity[i] = velocity;
  grains.diameter[i] = diameter;
  grains.density[i] = density;
  return static_cast<std::uint32_t>(i);
}

inline double mass_of(const Grains& grains, std::size_t i) {
  return grains.density[i] * sphere_volume(grains.diameter[i]);
}

inline Vec3 momentum(const Grains& grains) {
  Vec3 sum;
  for (std::size_t i = 0; i < grains.size(); ++i) sum += mass_of(grains, i) * grains.velocity[i];
  return sum;
}

/// Of places and spins, about the origin (grains must not be wrapped).
inline Vec3 angular_momentum(const Grains& grains) {
  Vec3 sum;
  for (std::size_t i = 0; i < grains.size(); ++i) {
    const double m = mass_of(grains, i);
    sum += m * cross(grains.position[i], grains.velocity[i]) + sphere_inertia(m, grains.diameter[i]) * grains.spin[i];
  }
  return sum;
}

inline double kinetic_energy(const Grains& grains) {
  double sum = 0;
  for (std::size_t i = 0; i < grains.size(); ++i) {
    const double m = mass_of(grains, i);
    sum += 0.5 * m * norm2(grains.velocity[i]) + 0.5 * sphere_inertia(m, grains.diameter[i]) * norm2(grains.spin[i]);
  }
  return sum;
}

inline GrainHealth coast(GrainDynamics& dynamics, Grains& grains, ContactHistory& contacts, double dt, int substeps = 1,
                         Vec3 push = {}) {
  const std::vector<Vec3> pushes(grains.size(), push);
  return dynamics.advance(grains, contacts, {.push = pushes}, dt, substeps, 0);
}

/// A dense gas of unequal grains that moves fast enough for lists to be made anew often; one in ten is fixed.
inline Grains agitated_grains(BedScene scene, std::uint64_t count) {
  scene.source = {BedSource::Kind::poured, count, "", 3};
  scene.grains.spread = 0.2;
  Grains grains = place_grains(scene);
  for (std::size_t i = 0; i < grains.size(); ++i) {
    const double phase = static_cast<double>(i);
    grains.velocity[i] = 0.1 * Vec3{std::sin(12.9 * phase), std::sin(78.2 * phase), std::sin(37.7 * phase)};
    grains.spin[i] = 100.0 * Vec3{std::sin(3.1 * phase), std::sin(5.7 * phase), std::sin(9.3 * phase)};
    if (i % 10 == 0) grains.fixed[i] = 1, grains.velocity[i] = {}, grains.spin[i] = {};
  }
  return grains;
}

}   // namespace bedload

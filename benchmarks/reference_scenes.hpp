// Small scenes that between them use every part of a step, and as many steps of them as asked for.
#pragma once

#include <vector>

#include "solver/coupler.hpp"
#include "solver/grains/grain_dynamics.hpp"
#include "tests/support/scenes.hpp"

namespace bedload::benchmarks {

// --- contacts and motion alone -------------------------------------------------------------------------------------------

/// 560 grains, 1 mm +-5 %, loosely stacked; nothing here depends on how beds are packed.
inline BedScene loose_bed(std::array<Side, 3> sides) {
  BedScene bed;
  bed.fluid = {1000, 1e-6};
  bed.grains = {1e-3, 2650, 0.05, 0.4, 0.6, 0.3, 1e6};
  bed.length = {12e-3, 10e-3, 12e-3};
  bed.sides = sides;
  bed.gravity = {0, 0, -9.81};
  bed.dem_step = 0.2 * rayleigh_time(0.9e-3, 2650, 1e6, 0.3);
  return bed;
}

inline State stack(const BedScene& bed) {
  Scene scene;
  scene.bed = bed;
  const std::vector<Vec3> places = test::cubic_places({10, 8, 7}, {}, {12e-3, 10e-3, 8e-3}, 0.08e-3, 5);
  State state = test::state_of(scene, places, false);
  for (std::size_t i = 0; i < places.size(); ++i)
    state.grains.diameter[i] = 1e-3 * (1 + 0.05 * (static_cast<double>(i * 37 % 101) / 50 - 1));
  for (std::size_t i = 0; i < places.size(); i += 97) state.grains.fixed[i] = 1;
  return state;
}

/// Falls into place, then a push along x on its upper half, under a lid that moves: ten times `calls` sub-steps of each.
inline State collide(const BedScene& bed, ContactTerms terms, int calls) {
  State state = stack(bed);
  GrainDynamics dynamics(bed, terms);
  const std::size_t n = state.grains.size();
  const std::vector<Vec3> weight(n, bed.gravity);
  const std::vector<double> added(n, 0.5 * 1000 * sphere_volume(1e-3));
  const GrainDrive settle{.push = weight, .added_mass = added};
  for (int call = 0; call < calls; ++call) dynamics.advance(state.grains, state.contacts, settle, bed.dem_step, 10, 0);
  std::vector<Vec3> push = weight, turn(n);
  std::vector<double> relaxation(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    if (state.grains.position[i].z < 4e-3) continue;
    push[i].x = 15, turn[i].y = 100, relaxation[i] = 50;
  }
  const GrainDrive shear{.push = push, .relaxation = relaxation, .spin_push = turn, .added_mass = added};
  for (int call = 0; call < calls; ++call) dynamics.advance(state.grains, state.contacts, shear, bed.dem_step, 10, 0.1);
  return state;
}

// --- fluid, and both -----------------------------------------------------------------------------------------------------

inline State take_steps(const Scene& scene, State state, double lid_speed, int steps) {
  state.search.lid_speed = lid_speed;
  Coupler coupler(scene);
  for (int n = 0; n < steps; ++n) coupler.step(state, scene.steps.fluid_interval);
  return state;
}

/// A lid over a closed box: no grain, Re 1000.
inline State cavity(int steps) {
  Scene scene = test::fluid_scene({24, 20, 28}, {1e-3, 1e-3, 0.5e-3}, test::closed_box, 2.4e-5);
  scene.steps.fluid_interval = 2e-4;
  return take_steps(scene, test::state_of(scene, {}, false), 1, steps);
}

/// 800 grains of a stacked bed on flat cells under a lid.
inline State sheared_bed(Terms terms, double viscosity, int steps, Smoothing smoothing = {}) {
  constexpr double d = 1e-3;
  Scene scene = test::fluid_scene({10, 5, 24}, {2e-3, 2e-3, 0.5e-3}, test::channel, viscosity);
  scene.bed.gravity = {0, 0, -9.81};
  test::add_grains(scene, d, 2.65, 0.05);
  scene.terms = terms;
  scene.smoothing = smoothing;
  const std::vector<Vec3> places = test::cubic_places({20, 10, 4}, {}, {20 * d, 10 * d, 4 * d}, 0.02 * d, 1);
  return take_steps(scene, test::state_of(scene, places, false), 0.5, steps);
}

inline Terms laminar_terms() {
  Terms terms;
  terms.self_disturbance = terms.added_mass = terms.viscous_torque = terms.wet_restitution = true;
  return terms;
}

inline Terms turbulent_terms() {
  Terms terms = laminar_terms();
  terms.turbulence = terms.shear_lift = terms.exposure = terms.wall_forces = terms.magnus = true;
  return terms;
}

inline Terms film_terms() {
  Terms terms;
  terms.lubrication = true;
  return terms;
}

}   // namespace bedload::benchmarks

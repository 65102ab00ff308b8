// State digests of short runs that between them use every part of a step: printed before and after a change of the code,
// they tell whether it kept the bits. benchmarks/reference_digests.txt has those of the present physics_version.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "solver/experiment.hpp"
#include "solver/grains/bed_packing.hpp"
#include "studies/study_file.hpp"
#include "tests/restart/tiny_scenes.hpp"
#include "tests/support/scenes.hpp"

namespace bedload {
namespace {

using test::TinyScene;

struct ReferenceRun {
  std::string name;
  std::function<State()> run;
};

// --- contacts and motion alone -------------------------------------------------------------------------------------------

/// 600 grains, 1 mm +-5 %, loosely stacked; nothing here depends on how beds are packed.
BedScene loose_bed(std::array<Side, 3> sides) {
  BedScene bed;
  bed.fluid = {1000, 1e-6};
  bed.grains = {1e-3, 2650, 0.05, 0.4, 0.6, 0.3, 1e6};
  bed.length = {12e-3, 10e-3, 12e-3};
  bed.sides = sides;
  bed.gravity = {0, 0, -9.81};
  bed.dem_step = 0.2 * rayleigh_time(0.9e-3, 2650, 1e6, 0.3);
  return bed;
}

State stack(const BedScene& bed) {
  Scene scene;
  scene.bed = bed;
  const std::vector<Vec3> places = test::cubic_places({10, 8, 7}, {}, {12e-3, 10e-3, 8e-3}, 0.08e-3, 5);
  State state = test::state_of(scene, places, false);
  for (std::size_t i = 0; i < places.size(); ++i)
    state.grains.diameter[i] = 1e-3 * (1 + 0.05 * (static_cast<double>(i * 37 % 101) / 50 - 1));
  for (std::size_t i = 0; i < places.size(); i += 97) state.grains.fixed[i] = 1;
  return state;
}

/// Falls into place, then 2000 sub-steps of a push along x on its upper half, under a lid that moves.
State collide(const BedScene& bed, ContactTerms terms) {
  State state = stack(bed);
  GrainDynamics dynamics(bed, terms);
  const std::size_t n = state.grains.size();
  const std::vector<Vec3> weight(n, bed.gravity);
  const std::vector<double> added(n, 0.5 * 1000 * sphere_volume(1e-3));
  const GrainDrive settle{.push = weight, .added_mass = added};
  for (int call = 0; call < 200; ++call) dynamics.advance(state.grains, state.contacts, settle, bed.dem_step, 10, 0);
  std::vector<Vec3> push = weight, turn(n);
  std::vector<double> relaxation(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    if (state.grains.position[i].z < 4e-3) continue;
    push[i].x = 15, turn[i].y = 100, relaxation[i] = 50;
  }
  const GrainDrive shear{.push = push, .relaxation = relaxation, .spin_push = turn, .added_mass = added};
  for (int call = 0; call < 200; ++call) dynamics.advance(state.grains, state.contacts, shear, bed.dem_step, 10, 0.1);
  return state;
}

State collide_with_rolling_friction() {
  BedScene bed = loose_bed(test::channel);
  bed.grains.rolling_friction = 0.1;
  return collide(bed, {});
}

/// A poured bed, dry and between walls across, brought to rest.
State pack(BedSource::Kind kind) {
  BedScene bed = loose_bed({Side::periodic, Side::wall, Side::wall});
  bed.source = {.kind = kind, .count = 500, .seed = 3};
  State state;
  state.grains = place_grains(bed);
  BedPacking packing(bed);
  while (!packing.advance(state.grains, state.contacts).settled) {
  }
  renumber_in_space(bed, state.grains, state.contacts);
  return state;
}

// --- fluid, and both -----------------------------------------------------------------------------------------------------

State take_steps(const Scene& scene, State state, double lid_speed, int steps) {
  state.search.lid_speed = lid_speed;
  Coupler coupler(scene);
  for (int n = 0; n < steps; ++n) coupler.step(state, scene.steps.fluid_interval);
  return state;
}

/// A lid over a closed box: no grain, Re 1000.
State cavity() {
  Scene scene = test::fluid_scene({24, 20, 28}, {1e-3, 1e-3, 0.5e-3}, test::closed_box, 2.4e-5);
  scene.steps.fluid_interval = 2e-4;
  return take_steps(scene, test::state_of(scene, {}, false), 1, 200);
}

/// 800 grains of a stacked bed on flat cells under a lid.
State sheared_bed(Terms terms, double viscosity, Smoothing smoothing = {}) {
  constexpr double d = 1e-3;
  Scene scene = test::fluid_scene({10, 5, 24}, {2e-3, 2e-3, 0.5e-3}, test::channel, viscosity);
  scene.bed.gravity = {0, 0, -9.81};
  test::add_grains(scene, d, 2.65, 0.05);
  scene.terms = terms;
  scene.smoothing = smoothing;
  const std::vector<Vec3> places = test::cubic_places({20, 10, 4}, {}, {20 * d, 10 * d, 4 * d}, 0.02 * d, 1);
  return take_steps(scene, test::state_of(scene, places, false), 0.5, 150);
}

Terms laminar_terms() {
  Terms terms;
  terms.self_disturbance = terms.added_mass = terms.viscous_torque = terms.wet_restitution = true;
  return terms;
}

Terms turbulent_terms() {
  Terms terms = laminar_terms();
  terms.turbulence = terms.shear_lift = terms.exposure = terms.wall_forces = terms.magnus = true;
  return terms;
}

Terms film_terms() {
  Terms terms;
  terms.lubrication = true;
  return terms;
}

State whole_ramp(const Scene& scene) {
  Experiment experiment(scene);
  State state = experiment.begin();
  while (!Experiment::finished(state)) experiment.step(state);
  return state;
}

/// The smallest of the example studies, its first case: packing, and as much of the ramp as ends within a second.
State quickstart() {
  const Scene scene = unfold(read_study(BEDLOAD_SOURCE_DIR "/studies/examples/quickstart.toml")).front().scene;
  Experiment experiment(scene);
  State state = experiment.begin();
  while (!Experiment::finished(state) && state.clock.time < 1) experiment.step(state);
  return state;
}

std::vector<ReferenceRun> reference_runs() {
  std::vector<ReferenceRun> runs{
      {"contacts_dry", [] { return collide(loose_bed(test::channel), {}); }},
      {"contacts_closed_box", [] { return collide(loose_bed(test::closed_box), {}); }},
      {"contacts_wet_restitution", [] { return collide(loose_bed(test::channel), {.wet_restitution = true}); }},
      {"contacts_films", [] { return collide(loose_bed(test::channel), {.lubrication = true}); }},
      {"contacts_rolling", collide_with_rolling_friction},
      {"packing_poured", [] { return pack(BedSource::Kind::poured); }},
      {"packing_lattice", [] { return pack(BedSource::Kind::lattice); }},
      {"fluid_cavity", cavity},
      {"coupled_drag_alone", [] { return sheared_bed({}, 1e-6); }},
      {"coupled_laminar", [] { return sheared_bed(laminar_terms(), 1e-5); }},
      {"coupled_turbulent", [] { return sheared_bed(turbulent_terms(), 1e-6); }},
      {"coupled_films", [] { return sheared_bed(film_terms(), 1e-5); }},
      {"coupled_smoothed",
       [] {
         return sheared_bed(laminar_terms(), 1e-5, {3e-3, 1e-3});
       }},
  };
  for (const TinyScene& tiny : test::tiny_scenes())
    runs.push_back({"ramp_" + tiny.name, [scene = tiny.scene] { return whole_ramp(scene); }});
  runs.push_back({"quickstart", quickstart});
  return runs;
}

}   // namespace
}   // namespace bedload

/// All runs, or those whose name holds one of the arguments.
int main(int argc, char** argv) {
  const std::vector<std::string_view> wanted(argv + 1, argv + argc);
  fmt::print("physics_version {}\n", bedload::physics_version);
  for (const auto& reference : bedload::reference_runs()) {
    const auto named = [&](std::string_view part) { return reference.name.find(part) != std::string::npos; };
    if (!wanted.empty() && std::ranges::none_of(wanted, named)) continue;
    fmt::print("{} {}\n", reference.name, bedload::state_digest(reference.run()));
    std::fflush(stdout);
  }
}

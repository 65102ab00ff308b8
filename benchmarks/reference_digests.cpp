// State digests of short runs that between them use every part of a step: printed before and after a change of the code,
// they tell whether it kept the bits. benchmarks/reference_digests.txt has those of the present physics_version.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "benchmarks/reference_scenes.hpp"
#include "solver/experiment.hpp"
#include "solver/grains/bed_packing.hpp"
#include "studies/study_file.hpp"
#include "tests/restart/tiny_scenes.hpp"

namespace bedload {
namespace {

using namespace benchmarks;
using test::TinyScene;

constexpr int calls = 200, steps = 150;

struct ReferenceRun {
  std::string name;
  std::function<State()> run;
};

State collide_with_rolling_friction() {
  BedScene bed = loose_bed(test::channel);
  bed.grains.rolling_friction = 0.1;
  return collide(bed, {}, calls);
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
      {"contacts_dry", [] { return collide(loose_bed(test::channel), {}, calls); }},
      {"contacts_closed_box", [] { return collide(loose_bed(test::closed_box), {}, calls); }},
      {"contacts_wet_restitution", [] { return collide(loose_bed(test::channel), {.wet_restitution = true}, calls); }},
      {"contacts_films", [] { return collide(loose_bed(test::channel), {.lubrication = true}, calls); }},
      {"contacts_rolling", collide_with_rolling_friction},
      {"packing_poured", [] { return pack(BedSource::Kind::poured); }},
      {"packing_lattice", [] { return pack(BedSource::Kind::lattice); }},
      {"fluid_cavity", [] { return cavity(200); }},
      {"coupled_drag_alone", [] { return sheared_bed({}, 1e-6, steps); }},
      {"coupled_laminar", [] { return sheared_bed(laminar_terms(), 1e-5, steps); }},
      {"coupled_turbulent", [] { return sheared_bed(turbulent_terms(), 1e-6, steps); }},
      {"coupled_films", [] { return sheared_bed(film_terms(), 1e-5, steps); }},
      {"coupled_smoothed",
       [] {
         return sheared_bed(laminar_terms(), 1e-5, steps, {3e-3, 1e-3});
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

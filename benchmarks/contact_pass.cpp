// Speed of contacts and motion, together and apart: a bed at rest, and one whose upper layers move.
// 1 000 000 grains only when asked for: --benchmark_filter=million.
#include <benchmark/benchmark.h>

#include <string_view>

#include "benchmarks/settled_bed.hpp"
#include "solver/grains/contact_forces.hpp"

namespace bedload {
namespace {

using namespace benchmarks;

constexpr int substeps = 10;   // of a call, as in a coupled step
constexpr int warm_calls = 100;

void count_grain_steps(benchmark::State& run, std::size_t grains, int steps_per_iteration = 1) {
  run.counters["grain_steps/s"] =
      benchmark::Counter(double(grains) * steps_per_iteration, benchmark::Counter::kIsIterationInvariantRate);
}

/// Mean kinetic energy of translation of a grain, per (submerged weight x diameter) of the mean grain [-].
double energy(const Grains& grains) {
  double sum = 0, mass = 0;
  for (std::size_t i = 0; i < grains.size(); ++i) {
    const double m = grains.density[i] * sphere_volume(grains.diameter[i]);
    sum += 0.5 * m * norm2(grains.velocity[i]), mass += m;
  }
  return sum / (mass * submerged_weight * grain_diameter);
}

/// The whole of it: 1000 steps to warm up, then as many calls as the benchmark is registered with: every run of it ends in
/// the same state, which the counters describe.
void advance_bed(benchmark::State& run, bool eroding, const GrainKernels& kernels) {
  Bed bed = settled_bed(std::size_t(run.range(0)));
  GrainDynamics dynamics(bed.scene, {}, kernels);
  const Drive drive = drive_of(bed, eroding);
  GrainHealth health;
  const auto advance = [&] {
    health = dynamics.advance(bed.grains, bed.contacts, drive.drive(), bed.scene.dem_step, substeps, 0);
  };
  for (int call = 0; call < warm_calls; ++call) advance();
  for (auto _ : run) advance();
  const double n = double(bed.grains.size());
  count_grain_steps(run, bed.grains.size(), substeps);
  run.counters["contacts_per_grain"] =   // without walls
      double(std::ranges::count_if(bed.contacts.higher, [&](std::uint32_t id) { return id < bed.grains.size(); })) / n;
  run.counters["energy"] = energy(bed.grains);
}

/// The grains of a bed as the kernels see them, and its list.
struct Workspace {
  explicit Workspace(const Bed& bed) : list(bed.scene, nullptr, false, grains_at_once), loads(bed.grains.size()) {
    const Grains& g = bed.grains;
    for (std::size_t i = 0; i < g.size(); ++i) {
      const double mass = g.density[i] * sphere_volume(g.diameter[i]);
      bodies.spheres.push_back(sphere_of(g.position[i], 0.5 * g.diameter[i], g.velocity[i], g.spin[i]));
      bodies.motions.push_back({g.velocity[i], 1 / mass, g.spin[i], 1 / sphere_inertia(mass, g.diameter[i])});
    }
    list.rebuild(bodies, bed.scene.dem_step, bed.contacts);
  }
  NeighbourList list;
  Bodies bodies;
  std::vector<Load> loads;
  const GrainKernels& kernels = grain_kernels();
};

/// Overlap, law and loads of all pairs, and the loads of grains from them.
void contact_pass(benchmark::State& run) {
  const Bed& bed = settled_bed(std::size_t(run.range(0)));
  const HertzMindlin law(bed.scene.grains);
  Workspace work(bed);
  const PairPass pairs = pair_pass(law, nullptr, work.bodies, bed.scene.dem_step, work.list);
  const std::size_t n = work.bodies.size();
  for (auto _ : run) {
    PairWave wave(work.kernels, pairs, work.list);
    SumPass sum = sum_pass(work.bodies, work.list);
    for (std::size_t first = 0; first < n; first += grains_at_once) {
      const std::size_t last = std::min(n, first + grains_at_once);
      wave.meet_below(last);
      work.kernels.add_up(sum, first, last, &work.loads[first]);
    }
  }
  count_grain_steps(run, work.bodies.size());
  run.counters["listed_per_grain"] = double(work.list.pairs.size()) / double(work.bodies.size());
}

void motion(benchmark::State& run) {
  const Bed& bed = settled_bed(std::size_t(run.range(0)));
  Workspace work(bed);
  std::vector<LoadSum> sums(work.loads.size());
  const std::vector<Push> push(work.loads.size(), Push{{}, 1});   // none: the grains stay
  const MotionPass pass{work.bodies.spheres.data(),
                        work.bodies.motions.data(),
                        push.data(),
                        nullptr,
                        work.list.inverse_skins().data(),
                        sums.data(),
                        false,
                        bed.scene.dem_step};
  for (auto _ : run) work.kernels.move(pass, 0, work.bodies.size(), work.loads.data());
  count_grain_steps(run, work.bodies.size());
}

void list_rebuild(benchmark::State& run) {
  const Bed& bed = settled_bed(std::size_t(run.range(0)));
  Workspace work(bed);
  for (auto _ : run) work.list.rebuild(work.bodies, bed.scene.dem_step, bed.contacts);
  run.counters["ns_per_grain"] = benchmark::Counter(
      double(work.bodies.size()) * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void register_size(std::int64_t grains, std::int64_t calls) {
  const std::string million = grains == 1'000'000 ? "million/" : "";
  const std::pair<std::string, const GrainKernels*> kinds[] = {{"", &grain_kernels()}, {"avx2/", &grain_kernels_v3}};
  for (const auto& [kind, kernels] : kinds)
    for (const bool eroding : {false, true})
      benchmark::RegisterBenchmark((kind + million + "advance_bed/" + (eroding ? "eroding" : "at_rest")).c_str(),
                                   advance_bed, eroding, *kernels)
          ->Arg(grains)
          ->Iterations(calls)
          ->Unit(benchmark::kMillisecond);
  const auto part = [&](const char* name, void (*function)(benchmark::State&)) {
    benchmark::RegisterBenchmark((million + name).c_str(), function)->Arg(grains)->Unit(benchmark::kMillisecond);
  };
  part("contact_pass", contact_pass), part("motion", motion), part("list_rebuild", list_rebuild);
}

}   // namespace
}   // namespace bedload

int main(int argc, char** argv) {
  using namespace bedload;
  register_size(2'000, 1000), register_size(20'000, 200), register_size(200'000, 30);
  for (int i = 1; i < argc; ++i)
    if (std::string_view(argv[i]).find("million") != std::string_view::npos) register_size(1'000'000, 10);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 64;
  benchmark::RunSpecifiedBenchmarks();
}

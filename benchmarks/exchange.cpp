// What passes between grains and grid in a coupled step: stencils, void fraction, solid flux, the flow at the grains.
#include <benchmark/benchmark.h>

#include "benchmarks/settled_bed.hpp"
#include "solver/coupling/hydrodynamic_forces.hpp"
#include "solver/grains/box_walls.hpp"

namespace bedload {
namespace {

using namespace benchmarks;

/// The settled bed on cubic cells; arguments: grains, cell in halves of a diameter.
struct OnGrid {
  explicit OnGrid(const benchmark::State& run) : bed(settled_bed(std::size_t(run.range(0)))) {
    const double cell = 0.5 * grain_diameter * double(run.range(1));
    grid.sides = bed.scene.sides;
    for (int c = 0; c < 3; ++c) {
      grid.cells[c] = int(std::lround(bed.scene.length[c] / cell));
      grid.h[c] = bed.scene.length[c] / grid.cells[c];
    }
    find_stencils(grid, bed.grains, stencils);
    moved.assign(bed.grains.size(), {0.01 * cell, 0.02 * cell, -0.01 * cell});
    Grains after = bed.grains;
    for (std::size_t p = 0; p < after.size(); ++p)
      after.position[p] = PeriodicBox(bed.scene).wrapped(after.position[p] + moved[p]);
    Stencils stencils_after;
    find_stencils(grid, after, stencils_after);
    reach = united(stencils.reach, stencils_after.reach);
  }
  const Bed& bed;
  StaggeredGrid grid;
  Stencils stencils;
  Reach reach;   // of the grains before and after they moved
  std::vector<Vec3> moved;
};

void count_grains(benchmark::State& run) {
  run.counters["ns_per_grain"] = benchmark::Counter(
      double(run.range(0)) * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void stencils(benchmark::State& run) {
  OnGrid on(run);
  for (auto _ : run) find_stencils(on.grid, on.bed.grains, on.stencils);
  count_grains(run);
}

void void_fraction(benchmark::State& run) {
  const OnGrid on(run);
  VoidFraction eps(on.grid);
  for (auto _ : run) deposit_void_fraction(on.grid, on.bed.grains, on.stencils, eps);
  count_grains(run);
}

void solid_flux(benchmark::State& run) {
  const OnGrid on(run);
  SolidFlux flux(on.grid);
  for (auto _ : run) deposit_solid_flux(on.grid, on.bed.grains, on.stencils, flux);
  count_grains(run);
}

void swept_flux(benchmark::State& run) {
  const OnGrid on(run);
  SolidFlux flux(on.grid);
  for (auto _ : run) deposit_swept_flux(on.grid, on.bed.grains, on.bed.grains.position, on.moved, on.reach, 1e-4, flux);
  count_grains(run);
}

void flow_at_grains(benchmark::State& run) {
  const OnGrid on(run);
  VoidFraction eps(on.grid);
  deposit_void_fraction(on.grid, on.bed.grains, on.stencils, eps);
  FaceFields velocity(on.grid, 0.1), acceleration(on.grid, 1);
  FlowAtGrains flow;
  for (auto _ : run)
    sample_flow(on.grid, on.bed.grains, on.stencils, velocity, acceleration, eps.centre,
                drag_law(DragLawName::di_felice), 1e-6, {}, flow);
  count_grains(run);
}

void sizes(benchmark::internal::Benchmark* b) {
  b->ArgNames({"grains", "cell"})->ArgsProduct({{2'000, 20'000, 200'000}, {10, 5}})->Unit(benchmark::kMicrosecond);
}
BENCHMARK(stencils)->Apply(sizes);
BENCHMARK(void_fraction)->Apply(sizes);
BENCHMARK(solid_flux)->Apply(sizes);
BENCHMARK(swept_flux)->Apply(sizes);
BENCHMARK(flow_at_grains)->Apply(sizes);

}   // namespace
}   // namespace bedload

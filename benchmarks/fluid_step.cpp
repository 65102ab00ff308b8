// The fluid's parts of a step: ghosts, operators, transport; and the whole step of a box without grains.
#include <benchmark/benchmark.h>

#include <random>

#include "solver/coupler.hpp"
#include "solver/fluid/boundaries.hpp"
#include "solver/fluid/face_loops.hpp"
#include "solver/fluid/momentum.hpp"
#include "solver/fluid/operators.hpp"

namespace bedload {
namespace {

/// A channel of 1 mm by 1 mm by 0.25 mm cells; arguments: cells along x, y and z.
StaggeredGrid channel(const benchmark::State& state) {
  const std::array<int, 3> cells{int(state.range(0)), int(state.range(1)), int(state.range(2))};
  return {cells, {1e-3, 1e-3, 0.25e-3}, {Side::periodic, Side::periodic, Side::wall}, Top::lid};
}

FaceFields random_velocity(const StaggeredGrid& g) {
  FaceFields u(g);
  std::mt19937 random(3);
  for (int c = 0; c < 3; ++c)
    for (std::size_t n = 0; n < g.padded_size(); ++n)
      u.component(c)[n] = 1e-3 * (double(random()) / random.max() - 0.5);
  fill_velocity_ghosts(g, u, 0);
  return u;
}

void report_cells(benchmark::State& state, const StaggeredGrid& g) {
  state.counters["ns_per_cell"] = benchmark::Counter(
      double(g.cell_count()) * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void velocity_ghosts(benchmark::State& state) {
  const StaggeredGrid g = channel(state);
  FaceFields u = random_velocity(g);
  for (auto _ : state) fill_velocity_ghosts(g, u, 1e-3);
  report_cells(state, g);
}

void momentum_transport(benchmark::State& state) {
  const StaggeredGrid g = channel(state);
  const FaceFields flux = random_velocity(g), one(g, 1);
  FaceFields u = flux;
  TransportScratch scratch;
  for (auto _ : state) transport(g, flux, one, one, 1e-12, flux, u, scratch);
  report_cells(state, g);
}

void gradient_divergence_laplacian(benchmark::State& state) {
  const StaggeredGrid g = channel(state);
  const FaceFields u = random_velocity(g);
  FaceFields lap(g), grad(g);
  Field<Centre> div(g);
  for (auto _ : state) {
    laplacian(g, u, lap);
    divergence(g, u, div);
    gradient(g, div, grad);
  }
  report_cells(state, g);
}

void step_without_grains(benchmark::State& state) {
  Scene scene;
  scene.grid = channel(state);
  scene.bed.length = scene.grid.length(), scene.bed.sides = scene.grid.sides;
  scene.bed.fluid = {1000, 1e-5};
  scene.bed.dem_step = 1e-4;
  State flow;
  flow.fluid = FluidState(scene.grid);
  flow.fluid.velocity = random_velocity(scene.grid);
  flow.search.phase = Search::holding;
  flow.search.lid_speed = 0.01;
  Coupler coupler(scene);
  for (auto _ : state) coupler.step(flow, 1e-4);
  report_cells(state, scene.grid);
}

/// A closed box of 1 x 1 x 5 cm, its lid at 0.5 m/s, from rest: what benchmarks/against has icoFoam do.
void lid_driven_box(benchmark::State& state) {
  Scene scene;
  scene.grid = {{int(state.range(0)), int(state.range(1)), int(state.range(2))},
                {},
                {Side::wall, Side::wall, Side::wall},
                Top::lid};
  for (int c = 0; c < 3; ++c) scene.grid.h[c] = (c == 2 ? 0.05 : 0.01) / scene.grid.cells[c];
  scene.bed.length = scene.grid.length(), scene.bed.sides = scene.grid.sides;
  scene.bed.fluid = {1000, 1e-5};
  scene.bed.dem_step = 1e-4;
  State flow;
  flow.fluid = FluidState(scene.grid);
  flow.search.phase = Search::holding;
  flow.search.lid_speed = 0.5;
  Coupler coupler(scene);
  for (int n = 0; n < 5; ++n) coupler.step(flow, 1e-4);
  StepHealth health;
  double iterations = 0, steps = 0;
  for (auto _ : state) {
    health = coupler.step(flow, 1e-4);
    iterations += health.pressure_iterations, ++steps;
  }
  report_cells(state, scene.grid);
  state.counters["pressure_iterations"] = iterations / steps;
  Field<Centre> div(scene.grid);
  divergence(scene.grid, flow.fluid.velocity, div);
  double sum = 0;
  for_each_cell_row(scene.grid, [&](std::size_t row, int length) {
    for (std::size_t n = row; n < row + length; ++n) sum += std::abs(div[n]);
  });
  state.counters["continuity_error"] = health.dt * sum / double(scene.grid.cell_count());   // mean of |div u| T
}

void boxes(benchmark::internal::Benchmark* b) {
  b->ArgNames({"nx", "ny", "nz"})
      ->Args({10, 6, 26})
      ->Args({32, 32, 40})
      ->Args({64, 64, 80})
      ->Unit(benchmark::kMicrosecond);
}
BENCHMARK(velocity_ghosts)->Apply(boxes);
BENCHMARK(momentum_transport)->Apply(boxes);
BENCHMARK(gradient_divergence_laplacian)->Apply(boxes);
BENCHMARK(step_without_grains)->Apply(boxes);
void box_of_cells(int nx, int nz, int steps) {   // as many steps as benchmarks/against takes
  benchmark::RegisterBenchmark("lid_driven_box", lid_driven_box)
      ->ArgNames({"nx", "ny", "nz"})
      ->Args({nx, nx, nz})
      ->Iterations(steps)
      ->Unit(benchmark::kMicrosecond);
}
[[maybe_unused]] const bool registered =
    (box_of_cells(4, 20, 2000), box_of_cells(20, 100, 100), box_of_cells(40, 200, 20), true);

}   // namespace
}   // namespace bedload

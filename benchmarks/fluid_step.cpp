// The fluid's parts of a step: ghosts, operators, transport; and the whole step of a box without grains, or with fixed ones.
#include <benchmark/benchmark.h>

#include <random>

#include "solver/coupler.hpp"
#include "solver/coupling/face_void_fraction.hpp"
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

/// Fixed grains in the lower half, about one to a cell, of uneven sizes and places: a void fraction that varies from face to face.
Grains fixed_bed(const StaggeredGrid& g) {
  Grains grains;
  std::mt19937 random(5);
  const auto between = [&](double low, double high) { return low + (high - low) * double(random()) / random.max(); };
  const int deep = g.cells[2] / 2;
  grains.resize(std::size_t(g.cells[0]) * g.cells[1] * deep);
  std::size_t p = 0;
  for (int i = 0; i < g.cells[0]; ++i)
    for (int j = 0; j < g.cells[1]; ++j)
      for (int k = 0; k < deep; ++k, ++p) {
        grains.position[p] = {(i + between(0.4, 0.6)) * g.h.x, (j + between(0.4, 0.6)) * g.h.y,
                              (k + between(0.4, 0.6)) * g.h.z};
        grains.diameter[p] = between(0.7, 1) * g.h.x;
        grains.density[p] = 2500;
        grains.fixed[p] = 1;
      }
  return grains;
}

/// A closed box of 1 x 1 x 5 cm, its lid at 0.5 m/s, from rest: what benchmarks/against has icoFoam do; with a bed, also half
/// full of fixed grains. `fluid_ns_per_cell` is the part of transport and pressure.
void lid_driven_box(benchmark::State& state, bool bed) {
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
  if (bed) flow.grains = fixed_bed(scene.grid);
  flow.search.phase = Search::holding;
  flow.search.lid_speed = 0.5;
  Coupler coupler(scene);
  for (int n = 0; n < 5; ++n) coupler.step(flow, 1e-4);
  const auto fluid = [&] { return coupler.times().transport + coupler.times().pressure; };
  const double before = fluid();
  StepHealth health;
  double iterations = 0, steps = 0;
  for (auto _ : state) {
    health = coupler.step(flow, 1e-4);
    iterations += health.pressure_iterations, ++steps;
  }
  report_cells(state, scene.grid);
  state.counters["fluid_ns_per_cell"] = 1e9 * (fluid() - before) / steps / double(scene.grid.cell_count());
  state.counters["pressure_iterations"] = iterations / steps;
  FaceFields flux = face_void_fraction(scene.grid, flow.grains, scene.smoothing);
  for (int c = 0; c < 3; ++c)
    for (std::size_t n = 0; n < scene.grid.padded_size(); ++n)
      flux.component(c)[n] *= flow.fluid.velocity.component(c)[n];
  Field<Centre> div(scene.grid);
  divergence(scene.grid, flux, div);
  double sum = 0;
  for_each_cell_row(scene.grid, [&](std::size_t row, int length) {
    for (std::size_t n = row; n < row + length; ++n) sum += std::abs(div[n]);
  });
  state.counters["continuity_error"] = health.dt * sum / double(scene.grid.cell_count());   // mean of |div eps u| T
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
  for (const bool bed : {false, true})
    benchmark::RegisterBenchmark(bed ? "lid_driven_box_on_bed" : "lid_driven_box", lid_driven_box, bed)
        ->ArgNames({"nx", "ny", "nz"})
        ->Args({nx, nx, nz})
        ->Iterations(steps)
        ->Unit(benchmark::kMicrosecond);
}
[[maybe_unused]] const bool registered =
    (box_of_cells(4, 20, 2000), box_of_cells(20, 100, 100), box_of_cells(40, 200, 20), true);

}   // namespace
}   // namespace bedload

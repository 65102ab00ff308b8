// Pressure solve to 1e-8 over beds of several shapes: coefficient 1 in clear fluid, 1/contrast inside the bed.
#include <benchmark/benchmark.h>

#include <random>

#include "solver/fluid/pressure_projection.hpp"
#include "tests/support/bed_coefficient.hpp"

namespace bedload {
namespace {

constexpr int most_iterations = 17;   // whatever the bed, its contrast and the size of the box

/// Arguments: cells along x and y, cells along z, contrast, flatness h_x/h_z, shape (in the order of test::Bed).
void pressure_solve(benchmark::State& state) {
  const int nx = int(state.range(0)), nz = int(state.range(1));
  const StaggeredGrid g{
      {nx, nx, nz}, {1, 1, 1.0 / double(state.range(3))}, {Side::periodic, Side::periodic, Side::wall}, Top::lid};
  const FaceFields c = test::bed_coefficient(g, test::Bed(state.range(4)), double(state.range(2)));
  Field<Centre> rhs(g), p(g);
  std::mt19937 random(11);
  for (double& value : rhs.values) value = double(random()) / random.max() - 0.5;
  PressureSolver solver(g);
  PressureSolve result;
  for (auto _ : state) result = solver.solve(c, rhs, p, 1e-8, 0);
  if (result.iterations > most_iterations) state.SkipWithError("more than 17 iterations");
  state.counters["pressure_iterations"] = result.iterations;
  state.counters["ns_per_cell_and_iteration"] =
      benchmark::Counter(double(g.cell_count()) * result.iterations * 1e-9,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
void rough_beds(benchmark::internal::Benchmark* b) {
  b->Args({16, 40, 100, 1, 1})
      ->Args({32, 40, 100, 1, 1})
      ->Args({64, 80, 100, 1, 1})
      ->Args({64, 80, 10000, 1, 1})
      ->Args({32, 40, 100, 4, 1})
      ->Args({64, 80, 100, 4, 1});
}

/// Whose iterations must not grow with the box.
void two_million_cells(benchmark::internal::Benchmark* b) {
  b->ArgsProduct({{128}, {120}, {2, 100, 10000}, {1, 4}, {0, 1, 2, 3}})->Iterations(1);
}

BENCHMARK(pressure_solve)
    ->ArgNames({"nxy", "nz", "contrast", "flatness", "shape"})
    ->Apply(rough_beds)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(pressure_solve)
    ->Name("pressure_solve_large")
    ->ArgNames({"nxy", "nz", "contrast", "flatness", "shape"})
    ->Apply(two_million_cells)
    ->Unit(benchmark::kMillisecond);

}   // namespace
}   // namespace bedload

// Pressure solve to 1e-8 over a rough bed: coefficient 1 in clear fluid, 1/contrast inside the bed.
#include <benchmark/benchmark.h>

#include <random>

#include "solver/fluid/boundaries.hpp"
#include "solver/fluid/pressure_projection.hpp"
#include "solver/fluid/rows.hpp"

namespace bedload {
namespace {

FaceFields rough_bed(const StaggeredGrid& g, double contrast) {
  Field<Centre> clear(g);
  std::mt19937 random(7);
  for (int i = 0; i < g.cells[0]; ++i)
    for (int j = 0; j < g.cells[1]; ++j) {
      const int top = g.cells[2] / 2 + int(random() % 7) - 3;
      for (int k = 0; k < g.cells[2]; ++k) clear[g.index(i, j, k)] = k < top ? 1 / contrast : 1;
    }
  fill_centre_ghosts(g, clear);
  FaceFields c(g);
  for (int component = 0; component < 3; ++component)
    for_each_face_row(g, component, [&](std::size_t row, int length) {
      for (std::size_t n = row; n < row + length; ++n)
        c.component(component)[n] = 0.5 * (clear[n] + clear[n - g.stride(component)]);
    });
  return c;
}

/// Arguments: cells along x and y, cells along z, contrast, flatness h_x/h_z.
void pressure_solve(benchmark::State& state) {
  const int nx = int(state.range(0)), nz = int(state.range(1));
  const StaggeredGrid g{
      {nx, nx, nz}, {1, 1, 1.0 / double(state.range(3))}, {Side::periodic, Side::periodic, Side::wall}, Top::lid};
  const FaceFields c = rough_bed(g, double(state.range(2)));
  Field<Centre> rhs(g), p(g);
  std::mt19937 random(11);
  for (double& value : rhs.values) value = double(random()) / random.max() - 0.5;
  PressureSolver solver(g);
  PressureSolve result;
  for (auto _ : state) {
    p = Field<Centre>(g);
    result = solver.solve(c, rhs, p, 1e-8, 0);
  }
  state.counters["iterations"] = result.iterations;
  state.counters["ns_per_cell_and_iteration"] =
      benchmark::Counter(double(g.cell_count()) * result.iterations * 1e-9,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(pressure_solve)
    ->ArgNames({"nxy", "nz", "contrast", "flatness"})
    ->Args({16, 40, 100, 1})
    ->Args({32, 40, 100, 1})
    ->Args({64, 80, 100, 1})
    ->Args({64, 80, 10000, 1})
    ->Args({32, 40, 100, 4})
    ->Args({64, 80, 100, 4})
    ->Unit(benchmark::kMillisecond);

}   // namespace
}   // namespace bedload

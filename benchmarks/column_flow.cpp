// A fluid step of the column: its solve, laminar and turbulent, and its exchange with the grains of a settled bed.
#include <benchmark/benchmark.h>

#include "benchmarks/settled_bed.hpp"
#include "solver/coupling/column_exchange.hpp"

namespace bedload {
namespace {

using namespace benchmarks;

/// Argument: layers, turbulent or not. Half of the column is a bed.
void solve(benchmark::State& run) {
  const auto layers = std::size_t(run.range(0));
  const Column column{.layers = int(layers), .thickness = 5e-5, .viscosity = 1e-6, .packing = run.range(1) ? 0.6 : 0};
  ColumnFlow flow(column);
  std::vector<double> u(layers);
  SolidLayers solid{u, u};
  LayerExchange exchange{u, u};
  for (std::size_t k = 0; k < layers / 2; ++k) solid.fraction[k] = 0.6, exchange.rate[k] = 1e3;
  for (auto _ : run) {
    flow.step(u, solid, exchange, {0, 1}, 1e-4);
    benchmark::DoNotOptimize(u.data());
  }
}
BENCHMARK(solve)
    ->ArgNames({"layers", "turbulent"})
    ->ArgsProduct({{100, 200, 400}, {0, 1}})
    ->Unit(benchmark::kMicrosecond);

/// Argument: grains. Layers of a tenth of a diameter.
void exchange(benchmark::State& run) {
  const Bed& bed = settled_bed(std::size_t(run.range(0)));
  const Vec3 box = bed.scene.length;
  const double thickness = grain_diameter / 10;
  const Column column{.layers = int(box.z / thickness), .thickness = thickness, .viscosity = 1e-6};
  const std::vector<Vec3> drag(bed.grains.size(), {1e-8, 0, 0}), none(bed.grains.size());
  const GrainResponse response{drag, none, none, {}};
  std::vector<double> u(std::size_t(column.layers), 0.1), forces;
  GrainSlices slices;
  SolidLayers solid;
  LayerExchange given;
  for (auto _ : run) {
    find_slices(column, bed.grains, slices);
    average_grains(column, bed.grains, slices, box.x * box.y, solid);
    find_exchange(column, slices, response, box.x * box.y, given);
    find_forces(slices, response, u, forces);
    benchmark::DoNotOptimize(forces.data());
  }
  run.counters["ns_per_grain"] = benchmark::Counter(
      double(run.range(0)) * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(exchange)->ArgName("grains")->Arg(2'000)->Arg(20'000)->Unit(benchmark::kMicrosecond);

}   // namespace
}   // namespace bedload

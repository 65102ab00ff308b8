// The coupled step on a sheared bed of free grains: 2 000 and 20 000 grains, cells of 5 d (those of
// "Numerical Simulation of Incipient Sediment Motion Driven by Fluid Flow") and 2.5 d.
#include <benchmark/benchmark.h>

#include "solver/coupler.hpp"
#include "tests/support/scenes.hpp"

namespace {

using namespace bedload;

void coupled_step(benchmark::State& bench) {
  const bool large = bench.range(0) == 20000;
  const double d = 1e-3, edge = 0.5 * d * static_cast<double>(bench.range(1)), length = (large ? 50 : 20) * d,
               depth = (large ? 20 : 5) * d;
  const auto cells = [&](double size) { return static_cast<int>(size / edge + 0.5); };
  Scene scene =
      test::fluid_scene({cells(length), cells(20 * d), cells(depth + 10 * d)}, {edge, edge, edge}, test::channel, 1e-6);
  scene.bed.gravity = {0, 0, -9.81};
  test::add_grains(scene, d, 3, 0.05);
  const std::array<int, 3> count = {large ? 50 : 20, 20, large ? 20 : 5};
  State state = test::state_of(scene, test::cubic_places(count, {}, {length, 20 * d, depth}, 0.02 * d, 1), false);
  state.search.lid_speed = 1;
  Coupler coupler(scene);
  for (int i = 0; i < 20; ++i) coupler.step(state, scene.steps.fluid_interval);
  const StepTimes before = coupler.times();
  double grain_steps = 0, cell_steps = 0;
  for (auto _ : bench) {
    grain_steps += coupler.step(state, scene.steps.fluid_interval).substeps * static_cast<double>(state.grains.size());
    cell_steps += static_cast<double>(scene.grid.cell_count());
  }
  const StepTimes& after = coupler.times();
  const double total = after.total - before.total;
  bench.counters["grain_steps/s"] = benchmark::Counter(grain_steps, benchmark::Counter::kIsRate);
  bench.counters["cell_steps/s"] = benchmark::Counter(cell_steps, benchmark::Counter::kIsRate);
  bench.counters["contacts_share"] = (after.contacts - before.contacts) / total;
  bench.counters["drag_share"] = (after.drag - before.drag) / total;
  bench.counters["grid_share"] = (after.deposit + after.sample - before.deposit - before.sample) / total;
  bench.counters["pressure_share"] = (after.pressure - before.pressure) / total;
}
BENCHMARK(coupled_step)->Args({2000, 10})->Args({20000, 10})->Args({20000, 5})->Unit(benchmark::kMillisecond);

}   // namespace

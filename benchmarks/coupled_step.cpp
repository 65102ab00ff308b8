// The coupled step of a case, with all that surrounds it (counting, sampling, judging), on the settled bed under a lid: the
// scene of studies/examples/seed-erosion.toml (theta 0.03, water taken for laminar, drag and buoyancy alone, ten sub-steps) on
// cells of 5 d and of 2.5 d; and with all terms that water in truth requires.
#include <benchmark/benchmark.h>

#include "benchmarks/settled_bed.hpp"
#include "solver/experiment.hpp"

namespace bedload {
namespace {

using namespace benchmarks;

Terms drag_and_buoyancy() {
  Terms terms;
  terms.pressure_gradient = terms.viscous_stress = false;
  return terms;
}

Terms terms_of_water() {
  Terms terms;
  terms.self_disturbance = terms.added_mass = terms.shear_lift = terms.magnus = terms.viscous_torque = true;
  terms.wall_forces = terms.wet_restitution = terms.exposure = terms.turbulence = true;
  return terms;
}

Scene erosion(const Bed& bed, double cell, const Terms& terms) {
  Scene scene;
  scene.bed = bed.scene;
  scene.bed.fluid.viscosity = 1e-6;
  scene.terms = terms;
  scene.grid.sides = scene.bed.sides, scene.grid.top = scene.bed.top;
  for (int c = 0; c < 3; ++c) {
    scene.grid.cells[c] = int(std::lround(scene.bed.length[c] / cell));
    scene.grid.h[c] = scene.bed.length[c] / scene.grid.cells[c];
  }
  scene.steps.fluid_interval = 10 * scene.bed.dem_step;
  scene.drive = {.kind = FlowRamp::Kind::lid, .quantity = FlowRamp::Quantity::shields, .levels = {0.03}};
  scene.drive.dwell = 1e3;   // for ever
  scene.onset.method = Onset::Method::none;
  scene.record.every = 0.01;
  validate(scene);
  return scene;
}

/// Arguments: grains, cell in halves of a diameter.
void coupled_step(benchmark::State& run, const Terms& terms) {
  const Bed& bed = settled_bed(std::size_t(run.range(0)));
  const Scene scene = erosion(bed, 0.5 * grain_diameter * double(run.range(1)), terms);
  Experiment experiment(scene);
  State state;
  state.fluid = FluidState(scene.grid);
  state.grains = bed.grains, state.contacts = bed.contacts;
  state = experiment.begin_on(std::move(state));
  for (int i = 0; i < 20; ++i) experiment.step(state);
  const StepTimes before = experiment.coupler().times();
  double substeps = 0, iterations = 0, steps = 0;
  for (auto _ : run) {
    const StepHealth health = experiment.step(state);
    substeps += health.substeps, iterations += health.pressure_iterations, ++steps;
  }
  const StepTimes& after = experiment.coupler().times();
  const double total = after.total - before.total;
  const auto per_second = [](double count) { return benchmark::Counter(count, benchmark::Counter::kIsRate); };
  run.counters["grain_steps/s"] = per_second(substeps * double(state.grains.size()));
  run.counters["cell_steps/s"] = per_second(steps * double(scene.grid.cell_count()));
  run.counters["substeps"] = substeps / steps;
  run.counters["pressure_iterations"] = iterations / steps;
  run.counters["share_contacts"] = (after.contacts - before.contacts) / total;
  run.counters["share_drag"] = (after.drag - before.drag) / total;
  run.counters["share_exchange"] = (after.deposit + after.sample - before.deposit - before.sample) / total;
  run.counters["share_transport"] = (after.transport - before.transport) / total;
  run.counters["share_pressure"] = (after.pressure - before.pressure) / total;
}

void sizes(benchmark::internal::Benchmark* b) {
  b->ArgNames({"grains", "cell"})
      ->ArgsProduct({{2'000, 20'000, 200'000}, {10, 5}})
      ->MinTime(2)
      ->Unit(benchmark::kMillisecond);
}
BENCHMARK_CAPTURE(coupled_step, seed, drag_and_buoyancy())->Apply(sizes);
BENCHMARK_CAPTURE(coupled_step, water, terms_of_water())->Apply(sizes);

}   // namespace
}   // namespace bedload

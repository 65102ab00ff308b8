// Speed of contacts and motion: grain-steps per second of a bed at rest and of one whose upper layers move.
#include <benchmark/benchmark.h>

#include <map>

#include "solver/grains/bed_packing.hpp"

namespace bedload {
namespace {

/// d = 1 mm +-5 %, softened to 1 MPa; the box grows with the grains, so that every bed is about 6 d deep.
BedScene bench_scene(std::uint64_t count) {
  BedScene scene;
  scene.fluid = {1000, 1e-5};
  scene.grains = {1e-3, 3000, 0.05, 0.4, 0.6, 0.3, 1e6};
  scene.source = {BedSource::Kind::poured, count, "", 1};
  scene.length = {static_cast<double>(count) / 1500 * 20e-3, 12e-3, 13e-3};
  scene.sides = {Side::periodic, Side::periodic, Side::wall};
  scene.gravity = {0, 0, -9.81};
  scene.dem_step = 0.2 * rayleigh_time(0.9e-3, 3000, 1e6, 0.3);
  return scene;
}

struct Bed {
  BedScene scene;
  Grains grains;
  ContactHistory contacts;
};

/// Packed once for all runs.
const Bed& settled_bed(std::uint64_t count) {
  static std::map<std::uint64_t, Bed> beds;
  auto [at, fresh] = beds.try_emplace(count);
  Bed& bed = at->second;
  if (!fresh) return bed;
  bed.scene = bench_scene(count);
  bed.grains = place_grains(bed.scene);
  BedPacking packing(bed.scene);
  while (!packing.advance(bed.grains, bed.contacts).settled) {
  }
  renumber_in_space(bed.scene, bed.grains, bed.contacts);
  return bed;
}

/// `shear`: push along x on grains in the top four diameters, as drag would give them [their weight].
void advance_bed(benchmark::State& state, double shear) {
  Bed bed = settled_bed(static_cast<std::uint64_t>(state.range(0)));
  GrainDynamics dynamics(bed.scene);
  double top = 0;
  for (const Vec3& p : bed.grains.position) top = std::max(top, p.z);
  std::vector<Vec3> push(bed.grains.size(), Vec3{0, 0, -6.54});
  std::vector<double> relaxation(bed.grains.size(), 0.0);
  for (std::size_t i = 0; i < bed.grains.size(); ++i) {
    if (bed.grains.position[i].z < top - 4e-3) continue;
    push[i].x = shear * 6.54;
    relaxation[i] = 100;
  }
  constexpr int substeps = 10;
  GrainHealth health;
  const GrainDrive drive{.push = push, .relaxation = relaxation};
  for (int warm = 0; warm < 100; ++warm)
    dynamics.advance(bed.grains, bed.contacts, drive, bed.scene.dem_step, substeps, 0);
  for (auto _ : state) health = dynamics.advance(bed.grains, bed.contacts, drive, bed.scene.dem_step, substeps, 0);
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * substeps * bed.grains.size()));
  state.counters["contacts_per_grain"] = static_cast<double>(health.contacts) / static_cast<double>(bed.grains.size());
  double speed = 0;
  for (const Vec3& v : bed.grains.velocity) speed = std::max(speed, norm(v));
  state.counters["fastest_m_per_s"] = speed;
}

BENCHMARK_CAPTURE(advance_bed, at_rest, 0.0)->Arg(1500)->Arg(20000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(advance_bed, eroding, 1.5)->Arg(1500)->Arg(20000)->Unit(benchmark::kMillisecond);

}   // namespace
}   // namespace bedload

BENCHMARK_MAIN();

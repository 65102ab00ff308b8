#include "tests/support/plain_pouring.hpp"

#include <algorithm>
#include <cmath>

#include "solver/grains/bed_packing.hpp"
#include "solver/grains/box_walls.hpp"

namespace bedload::test {

PouredBed pour_plainly(BedScene scene) {
  constexpr int substeps = 50, most_intervals = 4000;
  scene.grains.restitution = std::min(scene.grains.restitution, 0.9);
  PouredBed bed;
  Grains& grains = bed.grains;
  grains = place_grains(scene);
  const std::size_t n = grains.size();
  const double weight = (1 - scene.fluid.density / scene.grains.density) * norm(scene.gravity);   // [m/s2]
  std::vector<Vec3> push(n, Vec3{0, 0, -weight});
  std::vector<double> drag(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double d = grains.diameter[i];
    drag[i] = std::min(18 * scene.fluid.viscosity * scene.fluid.density / (grains.density[i] * d * d),
                       100 * std::sqrt(weight / d));
  }
  GrainDynamics dynamics(scene);
  for (int interval = 0; interval < most_intervals && !bed.settled; ++interval) {
    dynamics.advance(grains, bed.contacts, {.push = push, .relaxation = drag}, scene.dem_step, substeps, 0);
    bed.grain_steps += substeps * static_cast<double>(n);
    double energy = 0;
    bool carried = true;
    for (std::size_t i = 0; i < n; ++i) {
      grains.position[i] = PeriodicBox(scene).wrapped(grains.position[i]);
      const double mass = grains.density[i] * sphere_volume(grains.diameter[i]);
      energy += 0.5 * norm2(grains.velocity[i]) / (weight * grains.diameter[i]) / static_cast<double>(n);
      carried = carried && norm(grains.mean_contact_force[i] + mass * push[i]) <= 0.5 * mass * weight;
    }
    bed.settled = carried && energy < 1e-6;
  }
  return bed;
}

}   // namespace bedload::test

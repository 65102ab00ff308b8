// Sums by planes of height, in order.
#include "solver/mixture_momentum.hpp"

#include <algorithm>

namespace bedload {

MixtureMomentum::MixtureMomentum(const Scene& scene)
    : grid_(scene.grid),
      smoothing_(scene.grid, scene.smoothing),
      fluid_density_(scene.bed.fluid.density),
      void_fraction_(scene.grid) {}

StreamwiseMomentum MixtureMomentum::operator()(const State& state, double level) {
  find_stencils(grid_, state.grains, stencils_);
  deposit_void_fraction(grid_, state.grains, stencils_, void_fraction_, smoothing_);

  std::vector<double> plane(static_cast<std::size_t>(grid_.cells[2]));
  for (int i = grid_.first_face(0); i < grid_.cells[0]; ++i)
    for (int j = 0; j < grid_.cells[1]; ++j)
      for (int k = 0; k < grid_.cells[2]; ++k) {
        const std::size_t n = grid_.index(i, j, k);
        plane[static_cast<std::size_t>(k)] += void_fraction_.face.x[n] * state.fluid.velocity.x[n];
      }

  StreamwiseMomentum sum;
  const double cell_mass = fluid_density_ * grid_.cell_volume();
  for (int k = 0; k < grid_.cells[2]; ++k) {
    const double momentum = cell_mass * plane[static_cast<std::size_t>(k)];
    sum.total += momentum;
    sum.fluid_below += momentum * std::clamp(level / grid_.h.z - k, 0.0, 1.0);
  }
  const Grains& grains = state.grains;
  for (std::size_t p = 0; p < grains.size(); ++p)
    sum.total += grains.density[p] * sphere_volume(grains.diameter[p]) * grains.velocity[p].x;
  return sum;
}

}   // namespace bedload

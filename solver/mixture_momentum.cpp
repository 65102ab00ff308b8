// Sums by planes of height, in order.
#include "solver/mixture_momentum.hpp"

#include <algorithm>

#include "solver/coupler_layers.hpp"

namespace bedload {

MixtureMomentum::MixtureMomentum(const Scene& scene)
    : rung_(scene.fluid),
      column_(column_of(scene)),
      grid_(scene.grid),
      smoothing_(scene.grid, scene.smoothing),
      fluid_density_(scene.bed.fluid.density),
      void_fraction_(scene.grid) {}

/// eps of the middles of layers, as the column conserves eps u; an imposed profile is nobody's momentum.
void MixtureMomentum::add_layers(const State& state, std::vector<double>& plane) {
  if (rung_ == FluidRung::profile) return;
  SolidLayers solid;
  GrainSlices slices;
  find_slices(column_, state.grains, slices);
  average_grains(column_, state.grains, slices, grid_.h.x * grid_.h.y, solid);
  for (std::size_t k = 0; k < plane.size(); ++k)
    plane[k] += std::max(1 - solid.fraction[k], ColumnFlow::least_void) *
                state.fluid.velocity.x[grid_.index(0, 0, static_cast<int>(k))];
}

void MixtureMomentum::add_cells(const State& state, std::vector<double>& plane) {
  find_stencils(grid_, state.grains, stencils_);
  deposit_void_fraction(grid_, state.grains, stencils_, void_fraction_, smoothing_);

  for (int i = grid_.first_face(0); i < grid_.cells[0]; ++i)
    for (int j = 0; j < grid_.cells[1]; ++j)
      for (int k = 0; k < grid_.cells[2]; ++k) {
        const std::size_t n = grid_.index(i, j, k);
        plane[static_cast<std::size_t>(k)] += void_fraction_.face.x[n] * state.fluid.velocity.x[n];
      }
}

StreamwiseMomentum MixtureMomentum::operator()(const State& state, double level) {
  std::vector<double> plane(static_cast<std::size_t>(grid_.cells[2]));
  rung_ == FluidRung::box ? add_cells(state, plane) : add_layers(state, plane);
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

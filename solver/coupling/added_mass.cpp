#include "solver/coupling/added_mass.hpp"

namespace bedload {
namespace {

constexpr double densest = 1 - 0.26;   // packing density above which the drag laws' void fraction is clamped

/// Sum of the squares of a spline's weights on the cells where they end up, once ghosts have gone home.
template <class Weights>
double square_sum(const Weights& w, int cell, int cells, bool periodic) noexcept {
  const auto home = [=](int m) {
    const int i = cell - 1 + m;
    return periodic ? (i + cells) % cells : std::clamp(i, 0, cells - 1);
  };
  double sum = 0;
  for (int m = 0; m < 3; ++m)
    for (int n = 0; n < 3; ++n)
      if (home(m) == home(n)) sum += w[m] * w[n];
  return sum;
}

/// What a grain sees of itself in the packing density sampled at its place: V_p/V_c sum_c w_pc^2.
double own_share(const StaggeredGrid& g, const Stencil& s, Vec3 x, double volume) noexcept {
  const auto part = [&](const auto& weights, int c) {
    return square_sum(weights, cell_of(x[c] / g.h[c], g.cells[c]), g.cells[c], g.periodic(c));
  };
  return volume / g.cell_volume() * part(s.cell_x, 0) * part(s.cell_y, 1) * part(s.cell_z, 2);
}

}   // namespace

void find_added_mass(const StaggeredGrid& grid, const Grains& grains, std::span<const Stencil> stencils,
                     std::span<const double> void_fraction, bool model_b, std::vector<double>& added) {
  added.resize(grains.size());
  for (std::size_t p = 0; p < grains.size(); ++p) {
    const double volume = sphere_volume(grains.diameter[p]), packing = std::clamp(1 - void_fraction[p], 0.0, densest);
    const double others = std::max(0.0, packing - own_share(grid, stencils[p], grains.position[p], volume));
    added[p] = added_mass_coefficient(others) * volume / (model_b ? 1 - packing : 1);
  }
}

}   // namespace bedload

#include "solver/initial_flow.hpp"

#include <cmath>
#include <numbers>

namespace bedload {
namespace {

/// A stream function at the grid's edges along z, differenced to faces: its discrete divergence vanishes exactly.
void add_taylor_green(const StaggeredGrid& grid, double speed, FluidState& fluid) {
  const Vec3 length = grid.length();
  const double k = 2 * std::numbers::pi / length.x, l = 2 * std::numbers::pi / length.y;
  const auto stream = [&](int i, int j) { return speed / l * std::sin(k * i * grid.h.x) * std::sin(l * j * grid.h.y); };
  for (int i = 0; i < grid.cells[0]; ++i)
    for (int j = 0; j < grid.cells[1]; ++j)
      for (int n = 0; n < grid.cells[2]; ++n) {
        const std::size_t here = grid.index(i, j, n);
        fluid.velocity.x[here] = (stream(i, j + 1) - stream(i, j)) / grid.h.y;
        fluid.velocity.y[here] = -(stream(i + 1, j) - stream(i, j)) / grid.h.x;
      }
}

}   // namespace

FluidState initial_flow(const Scene& scene) {
  FluidState fluid(scene.grid);
  if (scene.fluid_start == FluidStart::taylor_green) add_taylor_green(scene.grid, scene.start_speed, fluid);
  return fluid;
}

}   // namespace bedload

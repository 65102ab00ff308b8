// Plane means of the flow, slice-weighted means of the grains.
#include "solver/bed/bed_profiles.hpp"

#include <algorithm>
#include <cmath>

#include "solver/bed/bed_surface.hpp"

namespace bedload {

std::vector<double> plane_means(const Field<FaceX>& u, const StaggeredGrid& grid) {
  const auto [nx, ny, nz] = grid.cells;
  std::vector<double> mean(static_cast<std::size_t>(nz));
  for (int i = 0; i < nx; ++i)   // in walled boxes face 0 is the wall and stands for face n too
    for (int j = 0; j < ny; ++j)
      for (int k = 0; k < nz; ++k) mean[static_cast<std::size_t>(k)] += u[grid.index(i, j, k)];
  for (double& m : mean) m /= double(nx) * ny;
  return mean;
}

namespace {

/// Linear between plane middles; between the outermost planes and the walls, between them and the walls' speed.
double velocity_at(double z, const std::vector<double>& plane, const StaggeredGrid& grid, double lid_speed) {
  const bool walls = grid.sides[2] == Side::wall;
  const double top = walls && grid.top == Top::lid ? lid_speed : plane.back();
  const double bottom = walls ? 0 : plane.front();
  const double at = z / grid.h.z - 0.5, last = double(plane.size() - 1);
  if (at <= 0) return plane.front() + (bottom - plane.front()) * std::min(1.0, -2 * at);
  if (at >= last) return plane.back() + (top - plane.back()) * std::min(1.0, 2 * (at - last));
  const auto k = static_cast<std::size_t>(at);
  return plane[k] + (plane[k + 1] - plane[k]) * (at - double(k));
}

struct LayerOfGrains {
  double solid = 0;     // volume [m3]
  Vec3 momentum;        // volume x velocity
  double squares = 0;   // volume x squared fluctuation; filled once the mean is known
};

/// use(layer, slice [m3]) for every layer that grain p reaches into.
template <class Use>
void each_slice(const Grains& grains, std::size_t p, double bin, std::size_t bins, Use&& use) {
  const double radius = grains.diameter[p] / 2, z = grains.position[p].z;
  const auto first = std::size_t(std::max(0.0, (z - radius) / bin));
  for (std::size_t k = first; k < bins && double(k) * bin < z + radius; ++k)
    use(k, slice_volume(radius, double(k) * bin - z, double(k + 1) * bin - z));
}

std::vector<LayerOfGrains> layers_of(const Grains& grains, double height, std::size_t bins) {
  std::vector<LayerOfGrains> layers(bins);
  const double bin = height / double(bins);
  for (std::size_t p = 0; p < grains.size(); ++p)
    each_slice(grains, p, bin, bins, [&](std::size_t k, double slice) {
      layers[k].solid += slice;
      layers[k].momentum += slice * grains.velocity[p];
    });
  for (std::size_t p = 0; p < grains.size(); ++p)
    each_slice(grains, p, bin, bins, [&](std::size_t k, double slice) {
      if (slice > 0)
        layers[k].squares += slice * norm2(grains.velocity[p] - (1 / layers[k].solid) * layers[k].momentum);
    });
  return layers;
}

}   // namespace

void record_profiles(const Grains& grains, const FluidState& fluid, const StaggeredGrid& grid, double diameter,
                     double lid_speed, double hold, BedRecord::Profiles& out) {
  const Vec3 length = grid.length();
  const auto bins = std::size_t(std::max(1L, std::lround(4 * length.z / diameter)));
  const double bin = length.z / double(bins);
  const std::vector<double> plane = plane_means(fluid.velocity.x, grid);
  const std::vector<LayerOfGrains> layers = layers_of(grains, length.z, bins);
  for (std::size_t k = 0; k < bins; ++k) {
    const double z = (double(k) + 0.5) * bin;
    out.hold.push_back(hold);
    out.z.push_back(z);
    out.porosity.push_back(1 - layers[k].solid / (length.x * length.y * bin));
    out.fluid_velocity.push_back(velocity_at(z, plane, grid, lid_speed));
    out.grain_velocity.push_back(layers[k].solid > 0 ? layers[k].momentum.x / layers[k].solid : 0);
    out.granular_temperature.push_back(layers[k].solid > 0 ? layers[k].squares / (3 * layers[k].solid) : 0);
  }
}

}   // namespace bedload

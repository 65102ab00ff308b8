// Plane means of the flow, slice-weighted means of the grains.
#include "solver/bed/bed_profiles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

/// use(layer, slice [m3]) for every layer that grain p reaches into.
template <class Use>
void each_slice(const Grains& grains, std::size_t p, double bin, std::size_t bins, Use&& use) {
  const double radius = grains.diameter[p] / 2, z = grains.position[p].z;
  const auto first = std::size_t(std::max(0.0, (z - radius) / bin));
  for (std::size_t k = first; k < bins && double(k) * bin < z + radius; ++k)
    use(k, slice_volume(radius, double(k) * bin - z, double(k + 1) * bin - z));
}

}   // namespace

void add_instant(const Grains& grains, const FluidState& fluid, const StaggeredGrid& grid, double diameter,
                 double lid_speed, ProfileSums& sums) {
  const double height = grid.length().z;
  const auto bins = std::size_t(std::max(1L, std::lround(4 * height / diameter)));
  const double bin = height / double(bins);
  sums.solid.resize(bins), sums.motion.resize(bins), sums.squares.resize(bins), sums.fluid_velocity.resize(bins);
  sums.instants += 1;
  for (std::size_t p = 0; p < grains.size(); ++p) {
    const Vec3 v = grains.velocity[p];
    each_slice(grains, p, bin, bins, [&](std::size_t k, double slice) {
      sums.solid[k] += slice, sums.motion[k] += slice * v, sums.squares[k] += slice * norm2(v);
    });
  }
  const std::vector<double> plane = plane_means(fluid.velocity.x, grid);
  for (std::size_t k = 0; k < bins; ++k)
    sums.fluid_velocity[k] += velocity_at((double(k) + 0.5) * bin, plane, grid, lid_speed);
}

void record_profiles(const ProfileSums& sums, Vec3 length, double hold, BedRecord::Profiles& out) {
  const std::size_t bins = sums.solid.size();
  const double bin = length.z / double(bins);
  for (std::size_t k = 0; k < bins; ++k) {
    const double solid = sums.solid[k];
    const Vec3 mean = solid > 0 ? (1 / solid) * sums.motion[k] : Vec3{};
    const double fluctuation = solid > 0 ? sums.squares[k] / solid - norm2(mean) : 0;
    out.hold.push_back(hold);
    out.z.push_back((double(k) + 0.5) * bin);
    out.porosity.push_back(1 - solid / (sums.instants * length.x * length.y * bin));
    out.fluid_velocity.push_back(sums.fluid_velocity[k] / sums.instants);
    out.grain_velocity.push_back(mean.x);
    out.granular_temperature.push_back(std::max(0.0, fluctuation / 3));   // rounding may leave less than nothing
  }
}

double rebound_level(std::span<const double> z, std::span<const double> porosity,
                     std::span<const double> grain_velocity) {
  constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();
  if (z.size() < 2) return nowhere;
  const std::size_t faces = z.size() - 1;
  std::vector<double> work(faces);   // P_s dv_x/dz between layers, but for constant factors
  double above = 0;
  for (std::size_t k = faces; k-- > 0;) {
    above += 1 - porosity[k + 1];
    const bool grains = porosity[k] < 1 && porosity[k + 1] < 1;
    work[k] = grains ? above * (grain_velocity[k + 1] - grain_velocity[k]) : 0;
  }
  const auto k = std::size_t(std::max_element(work.begin(), work.end()) - work.begin());
  if (!(work[k] > 0)) return nowhere;
  const double bin = z[1] - z[0], face = z[k] + bin / 2;
  if (k == 0 || k + 1 == faces) return face;
  return face + bin / 2 * (work[k + 1] - work[k - 1]) / (2 * work[k] - work[k - 1] - work[k + 1]);   // of a parabola
}

}   // namespace bedload

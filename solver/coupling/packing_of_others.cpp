#include "solver/coupling/packing_of_others.hpp"

namespace bedload {
namespace {

/// What a grain reads along one direction of 1 that it has deposited, whatever folds onto what.
double own_share_of_any(const StaggeredGrid& grid, const KernelSmoothing& smoothing, int direction, int cell,
                        const std::array<double, 3>& weights) {
  const int n = grid.cells[direction];
  const auto home = [&](int i) { return grid.periodic(direction) ? (i + n) % n : std::clamp(i, 0, n - 1); };
  double sum = 0;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      sum += weights[a] * weights[b] * smoothing.read_back(direction, home(cell - 1 + a), home(cell - 1 + b));
  return sum;
}

/// The same: without smoothing the sum of the squares of its spline weights, those that fold onto one cell at a wall added
/// first.
inline double own_share(const StaggeredGrid& grid, const KernelSmoothing& smoothing, int direction, int cell,
                        std::array<double, 3> w) {
  const int n = grid.cells[direction];
  if (smoothing || n < 3) return own_share_of_any(grid, smoothing, direction, cell, w);
  if (!grid.periodic(direction)) {
    if (cell == 0) w = {0, w[0] + w[1], w[2]};
    else if (cell == n - 1) w = {w[0], w[1] + w[2], 0};
  }
  return w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
}

/// Mean packing density of every plane of cells, with one plane of ghosts at either end.
std::vector<double> plane_means(const StaggeredGrid& grid, const Field<Centre>& void_fraction) {
  const int n = grid.cells[2];
  std::vector<double> means(n + 2);
  for (int i = 0; i < grid.cells[0]; ++i)
    for (int j = 0; j < grid.cells[1]; ++j) {
      const double* row = void_fraction.data() + grid.index(i, j, 0);
      for (int k = 0; k < n; ++k) means[k + 1] += 1 - row[k];
    }
  for (double& mean : means) mean /= grid.cells[0] * grid.cells[1];
  means.front() = grid.periodic(2) ? means[n] : means[1];
  means.back() = grid.periodic(2) ? means[1] : means[n];
  return means;
}

}   // namespace

void find_packing(const StaggeredGrid& grid, const Grains& grains, const Field<Centre>& void_fraction,
                  std::span<const double> sampled, GrainPacking& packing, const KernelSmoothing& smoothing) {
  packing.own.resize(grains.size()), packing.others.resize(grains.size());
  const std::vector<double> means = plane_means(grid, void_fraction);
  for (std::size_t p = 0; p < grains.size(); ++p) {
    const double volume = sphere_volume(grains.diameter[p]) / grid.cell_volume();
    double across = 1, along = 1;
    int k = 0;
    std::array<double, 3> w;   // along z, at the end
    for (int c = 0; c < 3; ++c) {
      const double s = grains.position[p][c] / grid.h[c];
      k = cell_of(s, grid.cells[c]), w = quadratic_spline(s - k - 0.5);
      (c < 2 ? across : along) *= own_share(grid, smoothing, c, k, w);
    }
    packing.own[p] = volume * across * along;
    const double plane = w[0] * means[k] + w[1] * means[k + 1] + w[2] * means[k + 2];
    packing.others[p] =
        std::max(1 - sampled[p] - packing.own[p], plane - volume * along / (grid.cells[0] * grid.cells[1]));
  }
}

}   // namespace bedload

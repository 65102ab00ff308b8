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

/// The same for all directions at once.
class OwnShare {
 public:
  OwnShare(const StaggeredGrid& grid, const CellFinder& cells, const KernelSmoothing& smoothing)
      : grid_(grid), smoothing_(smoothing), highest_(cells.highest()) {
    for (int c = 0; c < 3; ++c) {
      any_ |= smoothing || grid.cells[c] < 3;
      walls_[c] = grid.periodic(c) ? 0 : 1;
    }
  }

  /// Without smoothing the sum of the squares of the spline weights, those that fold onto one cell at a wall added first.
  Quad operator()(Quad cell, const std::array<Quad, 3>& w) const {
    if (any_) return of_any(cell, w);
    const Quad none{};
    const auto folds_down = (cell == none) & (walls_ > none), folds_up = (cell == highest_) & (walls_ > none);
    const Quad first = folds_down ? none : w[0], last = folds_up ? none : w[2];
    Quad middle = w[1];
    middle = folds_down ? w[0] + w[1] : middle;
    middle = folds_up ? w[1] + w[2] : middle;
    return first * first + middle * middle + last * last;
  }

 private:
  Quad of_any(Quad cell, const std::array<Quad, 3>& w) const {
    Quad share{};
    for (int c = 0; c < 3; ++c)
      share[c] = own_share_of_any(grid_, smoothing_, c, static_cast<int>(cell[c]), {w[0][c], w[1][c], w[2][c]});
    return share;
  }

  const StaggeredGrid& grid_;
  const KernelSmoothing& smoothing_;
  Quad highest_, walls_{};
  bool any_ = false;
};

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
  const CellFinder cells(grid);
  const OwnShare own_share(grid, cells, smoothing);
  const double columns = grid.cells[0] * grid.cells[1];
  for (std::size_t p = 0; p < grains.size(); ++p) {
    const double volume = sphere_volume(grains.diameter[p]) / grid.cell_volume();
    const Quad scaled = cells.scaled(grains.position[p]), cell = cells.cell_of(scaled);
    const auto w = quadratic_spline(scaled - cell - 0.5);
    const Quad share = own_share(cell, w);
    packing.own[p] = volume * (share[0] * share[1]) * share[2];
    const int k = static_cast<int>(cell[2]);
    const double plane = w[0][2] * means[k] + w[1][2] * means[k + 1] + w[2][2] * means[k + 2];
    packing.others[p] = std::max(1 - sampled[p] - packing.own[p], plane - volume * share[2] / columns);
  }
}

}   // namespace bedload

// The hierarchy of levels and the V-cycle through it.
#include "solver/fluid/multigrid.hpp"

#include <algorithm>

#include "solver/fluid/coarsest_solve.hpp"
#include "solver/fluid/multigrid_level.hpp"
#include "solver/fluid/rows.hpp"

namespace bedload {
namespace {

constexpr int directly_solved = 64;   // cells

/// Along which directions to pair cells: those whose edge is within sqrt(2) of the shortest (couplings go with 1/h^2).
Ratio coarsening(const std::array<int, 3>& cells, const Vec3& h) {
  double shortest = 0;
  for (int c = 0; c < 3; ++c)
    if (cells[c] > 1 && (shortest == 0 || h[c] < shortest)) shortest = h[c];
  Ratio ratio{1, 1, 1};
  for (int c = 0; c < 3; ++c)
    if (cells[c] > 1 && h[c] < 1.42 * shortest) ratio[c] = 2;
  return ratio;
}

}   // namespace

struct Multigrid::Hierarchy {
  explicit Hierarchy(const StaggeredGrid& g) : grid(g) {
    const std::array<bool, 3> periodic{g.periodic(0), g.periodic(1), g.periodic(2)};
    std::array<int, 3> cells = g.cells;
    Vec3 h = g.h;
    levels.emplace_back(cells, periodic);
    while (levels.back().layout().cell_count() > directly_solved) {
      ratios.push_back(coarsening(cells, h));
      for (int c = 0; c < 3; ++c) {
        cells[c] = (cells[c] + ratios.back()[c] - 1) / ratios.back()[c];
        h[c] *= ratios.back()[c];
      }
      levels.emplace_back(cells, periodic);
    }
    on_coarsest.resize(levels.back().layout().cell_count());
  }

  /// Returns solution . right-hand side of the level.
  double cycle(std::size_t l) noexcept {
    if (l + 1 == levels.size()) return solve_coarsest();
    levels[l].smooth_and_restrict(levels[l + 1], ratios[l]);
    cycle(l + 1);
    return levels[l].correct_and_smooth(levels[l + 1], ratios[l]);
  }

  template <class Body>
  void for_each_coarsest_cell(Body&& body) noexcept {
    const SplitGrid& at = levels.back().layout();
    int n = 0;
    for (int i = 0; i < at.cells[0]; ++i)
      for (int j = 0; j < at.cells[1]; ++j)
        for (int k = 0; k < at.cells[2]; ++k) body(at.at(i, j, k), on_coarsest[n++]);
  }

  double solve_coarsest() noexcept {
    float *r = levels.back().right_hand_side(), *z = levels.back().solution();
    for_each_coarsest_cell([&](std::size_t n, double& x) { x = r[n]; });
    coarsest.solve(on_coarsest.data());
    double product = 0;
    for_each_coarsest_cell([&](std::size_t n, double& x) {
      z[n] = static_cast<float>(x);
      product += x * r[n];
    });
    return product;
  }

  StaggeredGrid grid;
  std::vector<MultigridLevel> levels;   // finest first
  std::vector<Ratio> ratios;            // from level l to l + 1
  CoarsestSolve coarsest;
  std::vector<double> on_coarsest;
};

Multigrid::Multigrid(const StaggeredGrid& g) : hierarchy_(std::make_unique<Hierarchy>(g)) {}
Multigrid::~Multigrid() = default;

void Multigrid::set_couplings(const FaceFields& couplings, double scale) {
  Hierarchy& m = *hierarchy_;
  const StaggeredGrid& g = m.grid;
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < g.cells[0]; ++i)
      for (int j = 0; j < g.cells[1]; ++j)
        m.levels[0].set_couplings(c, i, j, couplings.component(c) + g.index(i, j, 0), scale);
  m.levels[0].finish_couplings();
  for (std::size_t l = 1; l < m.levels.size(); ++l) m.levels[l].coarsen_couplings(m.levels[l - 1], m.ratios[l - 1]);
  m.coarsest.factor(m.levels.back().layout().cell_count(), m.levels.back().matrix());
}

const SplitGrid& Multigrid::layout() const { return hierarchy_->levels[0].layout(); }
float* Multigrid::right_hand_side() noexcept { return hierarchy_->levels[0].right_hand_side(); }
const float* Multigrid::solution() const noexcept { return hierarchy_->levels[0].solution(); }
double Multigrid::cycle() noexcept { return hierarchy_->cycle(0); }
double Multigrid::apply(int plane, const float* field, float* image) const noexcept {
  return hierarchy_->levels[0].apply(plane, field, image);
}

}   // namespace bedload

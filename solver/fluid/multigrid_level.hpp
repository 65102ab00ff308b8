// One level of the multigrid: couplings, red-black sweeps, and the transfers to the next coarser level.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "solver/fluid/rows.hpp"
#include "solver/fluid/split_grid.hpp"

namespace bedload {

/// Walls are faces without coupling. Each pass below goes once through memory.
class MultigridLevel {
 public:
  MultigridLevel(std::array<int, 3> cells, std::array<bool, 3> periodic);

  const SplitGrid& layout() const { return at_; }

  /// Couplings of the cells of a row with their lower neighbours along c; to be followed by finish_couplings().
  void set_couplings(int c, int i, int j, const double* row, double scale) noexcept;
  /// Copies periodic couplings into the ghost faces and inverts the diagonal.
  void finish_couplings() noexcept;
  /// Sums of the couplings of `fine` across the interfaces between aggregates of ratio[c] cells.
  void aggregate_couplings(const MultigridLevel& fine, std::array<int, 3> ratio) noexcept;
  /// The level's matrix, dense, row by row (for the coarsest level).
  std::vector<double> matrix() const;

  /// Fields in layout(); the right-hand side has no ghosts.
  float* right_hand_side() { return right_.data(); }
  const float* right_hand_side() const { return right_.data(); }
  float* solution() { return x_.data(); }
  const float* solution() const { return x_.data(); }

  /// Two sweeps from a zero guess, red first; the right-hand side of `coarse` becomes the sums of the residual over
  /// aggregates.
  void smooth_and_restrict(MultigridLevel& coarse, std::array<int, 3> ratio) noexcept;
  /// Adds to each cell the solution of its aggregate, then two sweeps in exactly the reverse order of colours.
  /// Returns solution . right-hand side.
  double correct_and_smooth(const MultigridLevel& coarse, std::array<int, 3> ratio) noexcept;
  /// image = A field on one plane of cells; the field has its ghosts. Returns field . image of the plane.
  double apply(int plane, const float* field, float* image) const noexcept;

 private:
  struct Stencil;
  template <class Kernel>
  void for_each_row(int plane, Colour, const float* field, Kernel&& kernel) const noexcept;
  void relax(int plane, Colour) noexcept;
  void begin_with_red(int plane) noexcept;
  void wrap(int plane) noexcept;
  void add_correction(int plane, const MultigridLevel& coarse, std::array<int, 3> ratio) noexcept;
  void add_residual(int plane, Colour, std::array<int, 3> ratio) noexcept;
  void restrict_residual(int plane, MultigridLevel& coarse, std::array<int, 3> ratio) noexcept;

  SplitGrid at_;
  std::array<std::vector<float>, 3> coupling_;
  std::vector<float> inverse_diagonal_, x_, right_;   // zero on padding, so that kernels may run over it
  std::vector<float> aggregates_;                     // a plane of the next coarser level, its rows in natural order
  PlaneSums sums_;
};

}   // namespace bedload

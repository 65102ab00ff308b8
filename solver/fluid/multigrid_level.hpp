// One level of the multigrid: couplings, red-black sweeps, and the transfers to the next coarser level.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "solver/fluid/rows.hpp"
#include "solver/fluid/split_grid.hpp"

namespace bedload {

/// How many cells of a level make one of the next along x, y and z.
using Ratio = std::array<int, 3>;
inline constexpr Ratio along_z{1, 1, 2};

/// Walls are faces without coupling. Each pass below goes once through memory. Where cells are paired along z alone, the even
/// cells of a row are the coarse ones and the odd ones are interpolated; otherwise aggregates of cells are.
class MultigridLevel {
 public:
  MultigridLevel(std::array<int, 3> cells, std::array<bool, 3> periodic);

  const SplitGrid& layout() const { return at_; }

  /// Couplings of the cells of a row with their lower neighbours along c; to be followed by finish_couplings().
  void set_couplings(int c, int i, int j, const double* row, double scale) noexcept;
  /// Copies periodic couplings into the ghost faces and inverts the diagonal.
  void finish_couplings() noexcept;
  /// Couplings of this level from those of `fine`, which gets ready to restrict to it and to take its correction.
  void coarsen_couplings(MultigridLevel& fine, Ratio) noexcept;
  /// The level's matrix, dense, row by row (for the coarsest level).
  std::vector<double> matrix() const;

  /// Fields in layout(); the right-hand side has no ghosts.
  float* right_hand_side() { return right_.data(); }
  const float* right_hand_side() const { return right_.data(); }
  float* solution() { return x_.data(); }
  const float* solution() const { return x_.data(); }

  /// Two sweeps from a zero guess, red first; the residual is restricted to the right-hand side of `coarse`.
  void smooth_and_restrict(MultigridLevel& coarse, Ratio) noexcept;
  /// Adds the solution of `coarse`, then two sweeps in exactly the reverse order of colours.
  /// Returns solution . right-hand side.
  double correct_and_smooth(const MultigridLevel& coarse, Ratio) noexcept;
  /// image = A field on one plane of cells; the field has its ghosts. Returns field . image of the plane.
  double apply(int plane, const float* field, float* image) const noexcept;

 private:
  struct Stencil;
  void find_kept_planes() noexcept;
  template <class Kernel>
  void for_each_row(int plane, Colour, const float* field, Kernel&& kernel) const noexcept;
  void relax(int plane, Colour) noexcept;
  void begin_with_red(int plane) noexcept;
  void wrap(int plane) noexcept;
  void aggregate_couplings(const MultigridLevel& fine, Ratio) noexcept;
  void add_correction(int plane, const MultigridLevel& coarse, Ratio) noexcept;
  void add_residual(int plane, Colour, Ratio) noexcept;
  void restrict_residual(int plane, MultigridLevel& coarse, Ratio) noexcept;
  void find_shares() noexcept;
  void thin_couplings(const MultigridLevel& fine) noexcept;
  void find_residual(int plane, Colour) noexcept;
  void restrict_along_z(int plane, MultigridLevel& coarse) noexcept;
  void interpolate_along_z(int plane, const MultigridLevel& coarse) noexcept;

  SplitGrid at_;
  std::array<std::vector<float>, 3> coupling_;
  std::vector<float> inverse_diagonal_, x_, right_;   // zero on padding, so that kernels may run over it
  // Of each array of the matrix (couplings along x, y, z, inverse diagonal), the offset from which its x-planes 0..n are read:
  // of planes that are alike the first, which stays in cache.
  std::array<std::vector<std::size_t>, 4> kept_;
  std::vector<float> aggregates_;   // a plane of the next coarser level, its rows in natural order
  std::vector<float>
      lower_share_;   // of odd cells: what of their correction the cell below gives, the one above the rest
  PlaneSums sums_;
};

}   // namespace bedload

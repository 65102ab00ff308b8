// Geometric multigrid for div(c grad p): one symmetric V(2,2) cycle in single precision, a preconditioner.
#pragma once

#include <memory>

#include "solver/fluid/staggered_grid.hpp"

namespace bedload {

/// Red-black Gauss-Seidel, piecewise-constant transfer, coarse coupling = sum of the fine couplings across the
/// interface, halved along coarsened directions; only the strongly coupled directions are coarsened until cells are
/// nearly cubic. Symmetric positive (semi-)definite: after the coarse correction the colours run in reverse order, and
/// neighbours of one colour across an odd periodic seam see each other's old values.
class Multigrid {
 public:
  explicit Multigrid(const StaggeredGrid&);
  ~Multigrid();

  /// Couplings w = c/h^2 (any unit; only ratios matter) on faces 0..n of all directions, zero on walls.
  void set_couplings(const FaceFields& couplings);

  /// Right-hand side r of one row of cells, in units of `scale` (to be the same for all rows).
  void set_right_hand_side(int i, int j, const double* row, double scale) noexcept;
  /// z = approximately (inverse of -div c grad) r, up to a factor that only the couplings decide.
  void cycle() noexcept;
  void get_solution(int i, int j, double* row) const noexcept;

 private:
  struct Level;
  struct Hierarchy;
  std::unique_ptr<Hierarchy> hierarchy_;
};

}   // namespace bedload

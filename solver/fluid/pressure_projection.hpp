// The pressure equation div(c grad p) = rhs, by conjugate gradients preconditioned with geometric multigrid.
#pragma once

#include <memory>

#include "solver/fluid/staggered_grid.hpp"

namespace bedload {

struct PressureSolve {
  int iterations = 0;
  double residual = 0;   // 2-norm of the residual per 2-norm of the (mean-free) right-hand side
  bool converged = true;
};

/// Deterministic: sums are one partial sum per x-plane added in plane order; red-black sweeps.
class PressureSolver {
 public:
  explicit PressureSolver(const StaggeredGrid&);
  ~PressureSolver();

  /// `coefficient` c on faces (> 0 on unknown faces; walls carry no flux whatever stands there); `rhs` on centres, its
  /// mean is removed. `p`, whatever it holds, becomes the solution with zero mean and filled ghosts, found from zero. Stops
  /// when the residual 2-norm is below max(relative |rhs|, absolute * sqrt(cells)).
  PressureSolve solve(const FaceFields& coefficient, const Field<Centre>& rhs, Field<Centre>& p, double relative,
                      double absolute);
  /// The same with the coefficient of the last solve.
  PressureSolve solve_again(const Field<Centre>& rhs, Field<Centre>& p, double relative, double absolute);

 private:
  struct Levels;
  std::unique_ptr<Levels> levels_;
};

}   // namespace bedload

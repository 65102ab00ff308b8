// The coarsest level of the multigrid, solved directly.
#pragma once

#include <vector>

namespace bedload {

/// Cholesky factor of a small symmetric positive semi-definite matrix whose null space is the constant vector;
/// the matrix is regularised by a multiple of the all-ones matrix, which leaves mean-free solutions as they are.
class CoarsestSolve {
 public:
  /// `matrix` is n x n and symmetric, row by row.
  void factor(int n, std::vector<double> matrix);
  /// Overwrites the right-hand side (n numbers) by the solution.
  void solve(double* x) const noexcept;

 private:
  int n_ = 0;
  std::vector<double> factor_;   // L below the diagonal, its transpose above, the inverse of its diagonal on it
};

}   // namespace bedload

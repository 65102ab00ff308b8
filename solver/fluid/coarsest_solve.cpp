// Plain loops in one order (a library's blocked sums would depend on alignment), each update a row at a time.
#include "solver/fluid/coarsest_solve.hpp"

#include <cmath>
#include <utility>

namespace bedload {

void CoarsestSolve::factor(int n, std::vector<double> matrix) {
  n_ = n;
  factor_ = std::move(matrix);
  double trace = 0;
  for (int i = 0; i < n; ++i) trace += factor_[i * n + i];
  const double shift = trace > 0 ? trace / (double(n) * n) : 1;
  for (double& a : factor_) a += shift;
  for (int k = 0; k < n; ++k) {   // column k of L stands, by symmetry, in row k as well
    double* column = &factor_[k * n];
    column[k] = 1 / std::sqrt(column[k]);
    for (int i = k + 1; i < n; ++i) column[i] *= column[k];
    for (int i = k + 1; i < n; ++i) {
      double* row = &factor_[i * n];
      const double factor = row[k] = column[i];
      for (int j = i; j < n; ++j) row[j] -= factor * column[j];
    }
  }
}

void CoarsestSolve::solve(double* x) const noexcept {
  for (int k = 0; k < n_; ++k) {
    const double* column = &factor_[k * n_];
    const double here = x[k] *= column[k];
    for (int i = k + 1; i < n_; ++i) x[i] -= column[i] * here;
  }
  for (int i = n_ - 1; i >= 0; --i) {
    const double* row = &factor_[i * n_];
    const double here = x[i] *= row[i];
    for (int k = 0; k < i; ++k) x[k] -= row[k] * here;
  }
}

}   // namespace bedload

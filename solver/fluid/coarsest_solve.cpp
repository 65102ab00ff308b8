// Plain loops in one order: a library's blocked sums would depend on alignment.
#include "solver/fluid/coarsest_solve.hpp"

#include <cmath>
#include <utility>

namespace bedload {

void CoarsestSolve::factor(int n, std::vector<double> matrix) {
  n_ = n;
  lower_ = std::move(matrix);
  double trace = 0;
  for (int i = 0; i < n; ++i) trace += lower_[i * n + i];
  const double shift = trace > 0 ? trace / (double(n) * n) : 1;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j) {
      double sum = lower_[i * n + j] + shift;
      for (int k = 0; k < j; ++k) sum -= lower_[i * n + k] * lower_[j * n + k];
      lower_[i * n + j] = i == j ? 1 / std::sqrt(sum) : sum * lower_[j * n + j];
    }
}

void CoarsestSolve::solve(double* x) const noexcept {
  for (int i = 0; i < n_; ++i) {
    for (int k = 0; k < i; ++k) x[i] -= lower_[i * n_ + k] * x[k];
    x[i] *= lower_[i * n_ + i];
  }
  for (int i = n_ - 1; i >= 0; --i) {
    x[i] *= lower_[i * n_ + i];
    for (int k = 0; k < i; ++k) x[k] -= lower_[i * n_ + k] * x[i];
  }
}

}   // namespace bedload

// Oracle: the pressure equation as a dense matrix, solved by Eigen.
#pragma once

#include <Eigen/Dense>

#include "solver/fluid/staggered_grid.hpp"

namespace bedload::test {

/// Solution of div(c grad p) = rhs - mean(rhs) with zero mean, in the order of cells (x slowest). Faces on walls carry
/// no flux; `coefficient` is read on unknown faces only.
inline Eigen::VectorXd dense_pressure(const StaggeredGrid& g, const FaceFields& coefficient, const Field<Centre>& rhs) {
  const int nx = g.cells[0], ny = g.cells[1], nz = g.cells[2], n = nx * ny * nz;
  const auto number = [&](int i, int j, int k) { return ((i + nx) % nx * ny + (j + ny) % ny) * nz + (k + nz) % nz; };
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd b(n);
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j)
      for (int k = 0; k < nz; ++k) {
        const int m[] = {i, j, k}, p = number(i, j, k);
        b(p) = rhs[g.index(i, j, k)];
        for (int c = 0; c < 3; ++c) {
          if (m[c] < g.first_face(c)) continue;
          const int q = number(i - (c == 0), j - (c == 1), k - (c == 2));
          const double w = coefficient.component(c)[g.index(i, j, k)] / (g.h[c] * g.h[c]);
          a(p, p) -= w, a(q, q) -= w, a(p, q) += w, a(q, p) += w;
        }
      }
  b.array() -= b.mean();
  Eigen::VectorXd x = a.completeOrthogonalDecomposition().solve(b);
  return x.array() - x.mean();
}

}   // namespace bedload::test

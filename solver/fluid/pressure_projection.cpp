// Conjugate gradients for -div(c grad p) = -rhs in double precision, preconditioned by one multigrid cycle in single.
#include "solver/fluid/pressure_projection.hpp"

#include <algorithm>
#include <cmath>

#include "solver/fluid/boundaries.hpp"
#include "solver/fluid/multigrid.hpp"
#include "solver/fluid/rows.hpp"

namespace bedload {
namespace {

constexpr int most_iterations = 200;

/// w = c/h^2 on faces 0..n, zero on walls.
void set_couplings(const StaggeredGrid& g, const FaceFields& coefficient, FaceFields& w) {
  for (int c = 0; c < 3; ++c) {
    const double per_h2 = 1 / (g.h[c] * g.h[c]);
    for_each_face_row(g, c, [&](std::size_t row, int length) {
      for (std::size_t n = row; n < row + length; ++n) w.component(c)[n] = coefficient.component(c)[n] * per_h2;
    });
  }
  fill_face_ghosts(g, w);
}

/// A p = -div(c grad p) on one row of cells; p has its ghosts filled.
inline double minus_divergence(const FaceFields& w, const double* p, std::size_t n, std::ptrdiff_t sx, std::ptrdiff_t sy) noexcept {
  const double here = p[n];
  return (w.x[n] * (here - p[n - sx]) + w.x[n + sx] * (here - p[n + sx])) +
         (w.y[n] * (here - p[n - sy]) + w.y[n + sy] * (here - p[n + sy])) +
         (w.z[n] * (here - p[n - 1]) + w.z[n + 1] * (here - p[n + 1]));
}

}  // namespace

struct PressureSolver::Levels {
  explicit Levels(const StaggeredGrid& g)
      : grid(g), multigrid(g), couplings(g), residual(g), preconditioned(g), direction(g), image(g) {}

  double mean(const Field<Centre>& f) const {
    return sum_over_cells(grid, [&](std::size_t n) { return f[n]; }) / grid.cell_count();
  }
  double dot(const Field<Centre>& a, const Field<Centre>& b) const {
    return sum_over_cells(grid, [&](std::size_t n) { return a[n] * b[n]; });
  }
  template <class Value>
  void on_cells(Field<Centre>& f, Value&& value) const {
    for_each_cell_row(grid, [&](std::size_t row, int length) {
      for (std::size_t n = row; n < row + length; ++n) f[n] = value(n);
    });
  }
  void apply(Field<Centre>& p, Field<Centre>& out) {
    fill_centre_ghosts(grid, p);
    const std::ptrdiff_t sx = grid.stride(0), sy = grid.stride(1);
    on_cells(out, [&](std::size_t n) { return minus_divergence(couplings, p.data(), n, sx, sy); });
  }

  StaggeredGrid grid;
  Multigrid multigrid;
  FaceFields couplings;
  Field<Centre> residual, preconditioned, direction, image;
};

PressureSolver::PressureSolver(const StaggeredGrid& g) : levels_(std::make_unique<Levels>(g)) {}
PressureSolver::~PressureSolver() = default;

PressureSolve PressureSolver::solve(const FaceFields& coefficient, const Field<Centre>& rhs, Field<Centre>& p, double relative,
                                    double absolute) {
  Levels& s = *levels_;
  Field<Centre>&r = s.residual, &z = s.preconditioned, &d = s.direction, &ad = s.image;
  set_couplings(s.grid, coefficient, s.couplings);

  const double rhs_mean = s.mean(rhs);
  s.on_cells(z, [&](std::size_t n) { return rhs_mean - rhs[n]; });
  const double rhs_norm = std::sqrt(s.dot(z, z));
  const double target = std::max(relative * rhs_norm, absolute * std::sqrt(double(s.grid.cell_count())));
  s.apply(p, ad);
  s.on_cells(r, [&](std::size_t n) { return z[n] - ad[n]; });
  double norm = std::sqrt(s.dot(r, r));

  PressureSolve report;
  double rz = 0;
  if (norm > target) s.multigrid.set_couplings(s.couplings);
  while (norm > target && report.iterations < most_iterations) {
    s.multigrid.apply(r.data(), 1 / norm, z.data());
    const double rz_before = rz;
    rz = s.dot(r, z);
    const double beta = report.iterations == 0 ? 0 : rz / rz_before;
    s.on_cells(d, [&](std::size_t n) { return z[n] + beta * d[n]; });
    s.apply(d, ad);
    const double alpha = rz / s.dot(d, ad);
    s.on_cells(p, [&](std::size_t n) { return p[n] + alpha * d[n]; });
    s.on_cells(r, [&](std::size_t n) { return r[n] - alpha * ad[n]; });
    norm = std::sqrt(s.dot(r, r));
    ++report.iterations;
  }
  const double p_mean = s.mean(p);
  s.on_cells(p, [&](std::size_t n) { return p[n] - p_mean; });
  fill_centre_ghosts(s.grid, p);
  report.residual = rhs_norm > 0 ? norm / rhs_norm : norm;
  report.converged = norm <= target;
  return report;
}

}  // namespace bedload

// Conjugate gradients for -div(c grad p) = -rhs in double precision, preconditioned by one multigrid cycle in single.
#include "solver/fluid/pressure_projection.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "solver/fluid/boundaries.hpp"
#include "solver/fluid/multigrid.hpp"
#include "solver/fluid/rows.hpp"
#include "solver/fluid/wavefront.hpp"

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

/// A p = -div(c grad p) on one row of cells; p has its ghosts filled wherever w is not zero.
void minus_divergence(const StaggeredGrid& g, const FaceFields& w, const double* field, std::size_t row,
                      double* __restrict out) noexcept {
  const std::ptrdiff_t sx = g.stride(0), sy = g.stride(1);
  const double *wx = w.x.data() + row, *wy = w.y.data() + row, *wz = w.z.data() + row, *p = field + row;
  for (int k = 0; k < g.cells[2]; ++k)
    out[k] = (wx[k] * (p[k] - p[k - sx]) + wx[k + sx] * (p[k] - p[k + sx])) +
             (wy[k] * (p[k] - p[k - sy]) + wy[k + sy] * (p[k] - p[k + sy])) +
             (wz[k] * (p[k] - p[k - 1]) + wz[k + 1] * (p[k] - p[k + 1]));
}

double in_plane_order(const std::vector<double>& partial) noexcept {
  double total = 0;
  for (double plane : partial) total += plane;
  return total;
}

}   // namespace

/// Scratch of the solver. Each pass below goes once through memory and does all that its data allow.
struct PressureSolver::Levels {
  explicit Levels(const StaggeredGrid& g)
      : grid(g),
        multigrid(g),
        couplings(g),
        residual(g),
        direction(g),
        image(g),
        partial(g.cells[0]),
        row_of_z(g.cells[2]) {}

  /// r = -(rhs - mean) - A p; returns |rhs - mean| and |r|.
  std::pair<double, double> begin(const Field<Centre>& rhs, Field<Centre>& p) {
    const double mean = sum_over_cells(grid, [&](std::size_t n) { return rhs[n]; }) / grid.cell_count();
    fill_centre_ghosts(grid, p);
    std::fill(direction.values.begin(), direction.values.end(), 0.0);
    for_each_cell_row(grid, [&](std::size_t row, int length) {
      minus_divergence(grid, couplings, p.data(), row, &image[row]);
      for (std::size_t n = row; n < row + length; ++n) residual[n] = (mean - rhs[n]) - image[n];
    });
    const double rhs2 = sum_over_cells(grid, [&](std::size_t n) { return (rhs[n] - mean) * (rhs[n] - mean); });
    const double r2 = sum_over_cells(grid, [&](std::size_t n) { return residual[n] * residual[n]; });
    return {std::sqrt(rhs2), std::sqrt(r2)};
  }

  /// r.z with z the preconditioned residual.
  double precondition(double scale) noexcept {
    for (int i = 0; i < grid.cells[0]; ++i)
      for (int j = 0; j < grid.cells[1]; ++j)
        multigrid.set_right_hand_side(i, j, &residual[grid.index(i, j, 0)], scale);
    multigrid.cycle();
    for (int i = 0; i < grid.cells[0]; ++i) {
      LaneSum sum;
      for (int j = 0; j < grid.cells[1]; ++j) {
        const double* r = &residual[grid.index(i, j, 0)];
        multigrid.get_solution(i, j, row_of_z.data());
        sum.add_row(grid.cells[2], [&](int k) { return r[k] * row_of_z[k]; });
      }
      partial[i] = sum.value();
    }
    return in_plane_order(partial);
  }

  /// d = z + beta d, then A d; returns d.Ad.
  double advance_direction(double beta) noexcept {
    wavefront(
        grid.cells[0], [&] { wrap_planes(direction); },
        [&](int i) {
          for (int j = 0; j < grid.cells[1]; ++j) {
            double* __restrict d = &direction[grid.index(i, j, 0)];
            multigrid.get_solution(i, j, row_of_z.data());
            for (int k = 0; k < grid.cells[2]; ++k) d[k] = row_of_z[k] + beta * d[k];
          }
          wrap_rows(direction, i);
        },
        [&](int i) {
          LaneSum sum;
          for (int j = 0; j < grid.cells[1]; ++j) {
            const std::size_t row = grid.index(i, j, 0);
            const double *d = &direction[row], *ad = &image[row];
            minus_divergence(grid, couplings, direction.data(), row, &image[row]);
            sum.add_row(grid.cells[2], [&](int k) { return d[k] * ad[k]; });
          }
          partial[i] = sum.value();
        });
    return in_plane_order(partial);
  }

  /// p += alpha d, r -= alpha A d; returns |r|.
  double advance_solution(double alpha, Field<Centre>& p) noexcept {
    for (int i = 0; i < grid.cells[0]; ++i) {
      LaneSum sum;
      for (int j = 0; j < grid.cells[1]; ++j) {
        const std::size_t row = grid.index(i, j, 0);
        const double *d = &direction[row], *ad = &image[row];
        double *x = &p[row], *r = &residual[row];
        for (int k = 0; k < grid.cells[2]; ++k) {
          x[k] += alpha * d[k];
          r[k] -= alpha * ad[k];
        }
        sum.add_row(grid.cells[2], [&](int k) { return r[k] * r[k]; });
      }
      partial[i] = sum.value();
    }
    return std::sqrt(in_plane_order(partial));
  }

  /// Periodic neighbours of one plane's rows and cells; beyond walls nothing couples.
  void wrap_rows(Field<Centre>& f, int i) noexcept {
    const int ny = grid.cells[1], nz = grid.cells[2];
    for (int j = 0; grid.periodic(2) && j < ny; ++j) {
      f[grid.index(i, j, -1)] = f[grid.index(i, j, nz - 1)];
      f[grid.index(i, j, nz)] = f[grid.index(i, j, 0)];
    }
    if (!grid.periodic(1)) return;
    std::copy_n(&f[grid.index(i, ny - 1, 0)], nz, &f[grid.index(i, -1, 0)]);
    std::copy_n(&f[grid.index(i, 0, 0)], nz, &f[grid.index(i, ny, 0)]);
  }
  void wrap_planes(Field<Centre>& f) noexcept {
    if (!grid.periodic(0)) return;
    const int nx = grid.cells[0];
    const std::size_t plane = grid.index(1, 0, 0) - grid.index(0, 0, 0);
    std::copy_n(&f[grid.index(nx - 1, -1, -1)], plane, &f[grid.index(-1, -1, -1)]);
    std::copy_n(&f[grid.index(0, -1, -1)], plane, &f[grid.index(nx, -1, -1)]);
  }
  void finish(Field<Centre>& p) {
    const double mean = sum_over_cells(grid, [&](std::size_t n) { return p[n]; }) / grid.cell_count();
    for_each_cell_row(grid, [&](std::size_t row, int length) {
      for (std::size_t n = row; n < row + length; ++n) p[n] -= mean;
    });
    fill_centre_ghosts(grid, p);
  }

  StaggeredGrid grid;
  Multigrid multigrid;
  FaceFields couplings;
  Field<Centre> residual, direction, image;
  std::vector<double> partial, row_of_z;   // sums per x-plane; one row of the preconditioned residual
};

PressureSolver::PressureSolver(const StaggeredGrid& g) : levels_(std::make_unique<Levels>(g)) {}
PressureSolver::~PressureSolver() = default;

PressureSolve PressureSolver::solve(const FaceFields& coefficient, const Field<Centre>& rhs, Field<Centre>& p,
                                    double relative, double absolute) {
  Levels& s = *levels_;
  set_couplings(s.grid, coefficient, s.couplings);
  auto [rhs_norm, norm] = s.begin(rhs, p);
  const double target = std::max(relative * rhs_norm, absolute * std::sqrt(double(s.grid.cell_count())));
  const double scale = 1 / norm;

  PressureSolve report;
  if (norm > target) s.multigrid.set_couplings(s.couplings);
  for (double rz = 0; norm > target && report.iterations < most_iterations; ++report.iterations) {
    const double rz_before = rz;
    rz = s.precondition(scale);
    const double dad = s.advance_direction(report.iterations == 0 ? 0 : rz / rz_before);
    norm = s.advance_solution(rz / dad, p);
  }
  s.finish(p);
  report.residual = rhs_norm > 0 ? norm / rhs_norm : norm;
  report.converged = norm <= target;
  return report;
}

}   // namespace bedload

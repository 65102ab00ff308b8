// Conjugate gradients for -div(c grad p) = -rhs in single precision, preconditioned by one multigrid cycle; the residual
// that decides is found anew in double precision.
#include "solver/fluid/pressure_projection.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "solver/fluid/boundaries.hpp"
#include "solver/fluid/float_vectors.hpp"
#include "solver/fluid/multigrid.hpp"
#include "solver/fluid/rows.hpp"
#include "solver/fluid/split_rows.hpp"
#include "solver/fluid/wavefront.hpp"

namespace bedload {
namespace {

constexpr int most_iterations = 200;
constexpr double trusted_reduction = 1e-4;   // over which the recurrence of single precision follows the true residual

/// w = c/h^2 on faces 0..n, zero on walls; returns whether that changed w.
bool set_couplings(const StaggeredGrid& g, const FaceFields& coefficient, FaceFields& w) {
  bool changed = false;
  for (int c = 0; c < 3; ++c) {
    const double per_h2 = 1 / (g.h[c] * g.h[c]);
    for_each_face_row(g, c, [&](std::size_t row, int length) {
      const double* __restrict from = coefficient.component(c) + row;
      double* __restrict to = w.component(c) + row;
      std::int64_t differ = 0;   // as wide as what is compared: vectorises
      for (int k = 0; k < length; ++k) differ |= from[k] * per_h2 != to[k] ? 1 : 0;
      if (!differ) return;
      for (int k = 0; k < length; ++k) to[k] = from[k] * per_h2;
      changed = true;
    });
  }
  if (changed) close_faces(g, w);
  return changed;
}

double largest_coupling(const StaggeredGrid& g, const FaceFields& w) {
  LaneMax largest;
  for (int c = 0; c < 3; ++c)
    for_each_face_row(g, c, [&, value = w.component(c)](std::size_t row, int length) {
      largest.add_row(length, [v = value + row](int k) { return v[k]; });
    });
  return largest.value();
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

}   // namespace

/// Scratch of the solver. Each pass below goes once through memory and does all that its data allow. Inside the
/// conjugate gradients the matrix is in units of its largest coupling and the residual r in units of the right-hand side's norm.
struct PressureSolver::Levels {
  explicit Levels(const StaggeredGrid& g)
      : grid(g),
        multigrid(g),
        at(multigrid.layout()),
        couplings(g),
        direction(at.size()),
        image(at.size()),
        sums(g.cells[0]),
        row(g.cells[2]),
        float_row(g.cells[2]) {}

  double mean(const Field<Centre>& f) const {
    return sum_over_cells(grid, [&](std::size_t n) { return f[n]; }) / grid.cell_count();
  }

  /// The matrix of the conjugate gradients and its hierarchy.
  void set_matrix() {
    if (hierarchy_stands) return;
    const double largest = largest_coupling(grid, couplings);
    matrix_scale = largest > 0 ? 1 / largest : 1;
    multigrid.set_couplings(couplings, matrix_scale);
    std::fill(direction.begin(), direction.end(), 0.0f);   // an earlier solve may have left what is not finite
    hierarchy_stands = true;
  }

  /// r = -(rhs - mean), the residual of p = 0, in units of 1/scale. The next step along d finds p.
  void begin(const Field<Centre>& rhs, double mean_rhs, double scale) noexcept {
    float* r = multigrid.right_hand_side();
    for (int i = 0; i < grid.cells[0]; ++i)
      for (int j = 0; j < grid.cells[1]; ++j) {
        const double* __restrict from = rhs.data() + grid.index(i, j, 0);
        for (int k = 0; k < grid.cells[2]; ++k) row[k] = mean_rhs - from[k];
        split_row(row.data(), scale, grid.cells[2], r + at.at(i, j, 0), r + at.at(i, j, 1));
      }
    from_zero = true;
  }

  /// r = -(rhs - mean) - A p in double precision, in units of 1/scale; returns |r|, and the mean of p in mean_p.
  double find_residual(const Field<Centre>& rhs, double mean_rhs, Field<Centre>& p, double scale) {
    fill_centre_ghosts(grid, p);
    float* r = multigrid.right_hand_side();
    double sum_p = 0;
    for (int i = 0; i < grid.cells[0]; ++i) {
      LaneSum sum, plane_of_p;
      for (int j = 0; j < grid.cells[1]; ++j) {
        const std::size_t first = grid.index(i, j, 0);
        minus_divergence(grid, couplings, p.data(), first, row.data());
        for (int k = 0; k < grid.cells[2]; ++k) row[k] = (mean_rhs - rhs[first + k]) - row[k];
        sum.add_row(grid.cells[2], [&](int k) { return row[k] * row[k]; });
        plane_of_p.add_row(grid.cells[2], [&](int k) { return p[first + k]; });
        split_row(row.data(), scale, grid.cells[2], r + at.at(i, j, 0), r + at.at(i, j, 1));
      }
      sums[i] = sum.value();
      sum_p += plane_of_p.value();
    }
    mean_p = sum_p / grid.cell_count();
    return std::sqrt(sums.value());
  }

  /// p += step d on one row of cells.
  void add_direction(int i, int j, double step, Field<Centre>& p) noexcept {
    join_row(&direction[at.at(i, j, 0)], &direction[at.at(i, j, 1)], grid.cells[2], float_row.data());
    double* __restrict x = &p[grid.index(i, j, 0)];
    const float* __restrict d = float_row.data();
    if (from_zero)
      for (int k = 0; k < grid.cells[2]; ++k) x[k] = 0 + step * d[k];
    else
      for (int k = 0; k < grid.cells[2]; ++k) x[k] += step * d[k];
  }

  /// p += step d for the old d, then d = z + beta d and A d; returns d.Ad.
  double advance_direction(double beta, double step, Field<Centre>& p) noexcept {
    const float keep = static_cast<float>(beta);
    wavefront(
        grid.cells[0], [&] { at.wrap_planes(direction.data()); },
        [&](int i) {
          for (int j = 0; step != 0 && j < grid.cells[1]; ++j) add_direction(i, j, step, p);
          float* __restrict d = &direction[at.row(i, 0)];
          const float* __restrict z = multigrid.solution() + at.row(i, 0);
          for (int m = 0; m < at.plane_of_rows(); ++m) d[m] = z[m] + keep * d[m];
          at.wrap_cells(direction.data(), i);
          at.wrap_rows(direction.data(), i);
        },
        [&](int i) { sums[i] = multigrid.apply(i, direction.data(), image.data()); });
    from_zero &= step == 0;
    return sums.value();
  }

  /// r -= alpha A d; returns |r|.
  double reduce_residual(double alpha) noexcept {
    const float step = static_cast<float>(alpha);
    for (int i = 0; i < grid.cells[0]; ++i) {
      float* __restrict r = multigrid.right_hand_side() + at.row(i, 0);
      const float* __restrict ad = &image[at.row(i, 0)];
      for (int m = 0; m < at.plane_of_rows(); ++m) r[m] -= step * ad[m];
      DotProduct sum;
      sum.add(at.plane_of_rows(), r, r);
      sums[i] = sum.value();
    }
    return std::sqrt(sums.value());
  }

  /// Takes the mean away, of the ghosts too, which find_residual() has filled.
  void finish(Field<Centre>& p) noexcept {
    for (double& value : p.values) value -= mean_p;
  }

  StaggeredGrid grid;
  Multigrid multigrid;
  const SplitGrid at;
  FaceFields couplings;
  double matrix_scale = 1;
  bool hierarchy_stands = false;   // for the couplings, with nothing left behind that is not finite
  bool from_zero = true;           // p is zero as yet, whatever stands there
  double mean_p = 0;
  std::vector<float> direction, image;   // d and A d, in the layout of the multigrid
  PlaneSums sums;
  std::vector<double> row;
  std::vector<float> float_row;
};

PressureSolver::PressureSolver(const StaggeredGrid& g) : levels_(std::make_unique<Levels>(g)) {}
PressureSolver::~PressureSolver() = default;

PressureSolve PressureSolver::solve(const FaceFields& coefficient, const Field<Centre>& rhs, Field<Centre>& p,
                                    double relative, double absolute) {
  if (set_couplings(levels_->grid, coefficient, levels_->couplings)) levels_->hierarchy_stands = false;
  return solve_again(rhs, p, relative, absolute);
}

PressureSolve PressureSolver::solve_again(const Field<Centre>& rhs, Field<Centre>& p, double relative,
                                          double absolute) {
  Levels& s = *levels_;
  const StaggeredGrid& g = s.grid;
  s.set_matrix();
  const double mean_rhs = s.mean(rhs);
  const double rhs_norm =
      std::sqrt(sum_over_cells(g, [&](std::size_t n) { return (rhs[n] - mean_rhs) * (rhs[n] - mean_rhs); }));
  const double target = std::max(relative * rhs_norm, absolute * std::sqrt(double(g.cell_count())));

  PressureSolve report;
  const double scale = rhs_norm > 0 ? 1 / rhs_norm : 1;
  double norm = rhs_norm;
  if (norm > target) {
    s.begin(rhs, mean_rhs, scale);
    double rz_before = std::numeric_limits<double>::infinity();
    while (norm > target && report.iterations < most_iterations) {
      const double goal = std::max(target, trusted_reduction * norm);
      double step = 0;
      do {
        const double rz = s.multigrid.cycle();
        const double dad = s.advance_direction(rz / rz_before, step, p);
        norm = s.reduce_residual(rz / dad) / scale;
        step = rz / dad * s.matrix_scale / scale;
        rz_before = rz;
        ++report.iterations;
      } while (norm > goal && report.iterations < most_iterations);
      for (int i = 0; i < g.cells[0]; ++i)
        for (int j = 0; j < g.cells[1]; ++j) s.add_direction(i, j, step, p);
      s.from_zero = false;
      norm = s.find_residual(rhs, mean_rhs, p, scale);
    }
    s.finish(p);
  } else {
    std::fill(p.values.begin(), p.values.end(), 0.0);
  }
  s.hierarchy_stands &= std::isfinite(norm);   // what is not finite stays behind on the levels until they are set anew
  report.residual = rhs_norm > 0 ? norm / rhs_norm : norm;
  report.converged = norm <= target;
  return report;
}

}   // namespace bedload

// Sweeps and transfers of one multigrid level; all inner loops run over contiguous cells of one colour.
#include <algorithm>

#include "solver/fluid/multigrid_level.hpp"
#include "solver/fluid/split_rows.hpp"
#include "solver/fluid/wavefront.hpp"

namespace bedload {
namespace {

/// A row of cells of one colour with all that its stencil reads: couplings w and neighbours x, lower and upper along
/// each direction.
struct Stencil {
  const float *wx, *wx_up, *wy, *wy_up, *wz, *wz_up;
  const float *x, *x_up, *y, *y_up, *z, *z_up;
};

void relax_row(Stencil s, const float* __restrict b, const float* __restrict inverse_diagonal, int count,
               float* __restrict out) noexcept {
#pragma GCC ivdep
  for (int m = 0; m < count; ++m)
    out[m] = inverse_diagonal[m] *
             (((s.wx[m] * s.x[m] + s.wx_up[m] * s.x_up[m]) + (s.wy[m] * s.y[m] + s.wy_up[m] * s.y_up[m])) +
              ((s.wz[m] * s.z[m] + s.wz_up[m] * s.z_up[m]) + b[m]));
}

inline float residual(const Stencil& s, float b, float x, int m) noexcept {
  return ((s.wx[m] * (s.x[m] - x) + s.wx_up[m] * (s.x_up[m] - x)) +
          (s.wy[m] * (s.y[m] - x) + s.wy_up[m] * (s.y_up[m] - x))) +
         ((s.wz[m] * (s.z[m] - x) + s.wz_up[m] * (s.z_up[m] - x)) + b);
}

}   // namespace

MultigridLevel::ColouredRow MultigridLevel::coloured_row(int i, int j, Colour colour) const noexcept {
  const int parity = (i + j + colour) & 1;
  const std::size_t start = row(i, j) + 1;
  const std::size_t own = start + parity * half_, other = start + (1 - parity) * half_;
  return {own, other + parity - 1, other + parity, parity, padded((cells_[2] - parity + 1) / 2)};
}

void MultigridLevel::fill_ghost_cells(int i, int j) noexcept {
  if (!wraps_[2]) return;
  x_[at(i, j, -1)] = x_[at(i, j, cells_[2] - 1)];
  x_[at(i, j, cells_[2])] = x_[at(i, j, 0)];
}

void MultigridLevel::fill_ghost_rows(int plane) noexcept {
  if (!wraps_[1]) return;
  std::copy_n(&x_[row(plane, cells_[1] - 1)], 2 * half_, &x_[row(plane, -1)]);
  std::copy_n(&x_[row(plane, 0)], 2 * half_, &x_[row(plane, cells_[1])]);
}

void MultigridLevel::fill_ghost_planes() noexcept {
  if (!wraps_[0]) return;
  const std::size_t plane = row(1, -1) - row(0, -1);
  std::copy_n(&x_[row(cells_[0] - 1, -1)], plane, &x_[row(-1, -1)]);
  std::copy_n(&x_[row(0, -1)], plane, &x_[row(cells_[0], -1)]);
}

/// Ghosts are renewed behind the rows that read them, so a whole colour sees the values of before its sweep.
void MultigridLevel::relax(int plane, Colour colour) noexcept {
  const std::size_t dy = row(0, 1) - row(0, 0), dx = row(1, 0) - row(0, 0);
  const float *wx = coupling_[0].data(), *wy = coupling_[1].data(), *wz = coupling_[2].data();
  float* x = x_.data();
  for (int j = 0; j < cells_[1]; ++j) {
    const ColouredRow r = coloured_row(plane, j, colour);
    const std::size_t n = r.own;
    const Stencil s{wx + n,     wx + n + dx, wy + n,     wy + n + dy, wz + n,      wz + r.above,
                    x + n - dx, x + n + dx,  x + n - dy, x + n + dy,  x + r.below, x + r.above};
    relax_row(s, &right_[n], &inverse_diagonal_[n], r.count, x + n);
    fill_ghost_cells(plane, j);
  }
  fill_ghost_rows(plane);
}

/// The first red half-sweep from zero needs no neighbours.
void MultigridLevel::begin_with_red(int plane) noexcept {
  for (int j = 0; j < cells_[1]; ++j) {
    const ColouredRow r = coloured_row(plane, j, red);
    const float *b = &right_[r.own], *inverse = &inverse_diagonal_[r.own];
    float* __restrict x = &x_[r.own];
    for (int m = 0; m < r.count; ++m) x[m] = inverse[m] * b[m];
    fill_ghost_cells(plane, j);
  }
  fill_ghost_rows(plane);
}

void MultigridLevel::smooth_from_zero() noexcept {
  if (seam_) std::fill(x_.begin(), x_.end(), 0.0f);   // across a seam black cells read black ones
  const auto refresh = [&] { fill_ghost_planes(); };
  wavefront(
      cells_[0], refresh, [&](int i) { begin_with_red(i); }, [&](int i) { relax(i, black); });
  wavefront(
      cells_[0], refresh, [&](int i) { relax(i, red); }, [&](int i) { relax(i, black); });
}

void MultigridLevel::correct_and_smooth(const MultigridLevel& coarse, std::array<int, 3> ratio) noexcept {
  const auto refresh = [&] { fill_ghost_planes(); };
  wavefront(
      cells_[0], refresh, [&](int i) { add_correction(i, coarse, ratio); }, [&](int i) { relax(i, black); },
      [&](int i) { relax(i, red); });
  wavefront(
      cells_[0], refresh, [&](int i) { relax(i, black); }, [&](int i) { relax(i, red); });
}

void MultigridLevel::add_residual(int i, int j, Colour colour, int ratio, float* __restrict sums) const noexcept {
  const std::size_t dy = row(0, 1) - row(0, 0), dx = row(1, 0) - row(0, 0);
  const float *wx = coupling_[0].data(), *wy = coupling_[1].data(), *wz = coupling_[2].data(), *x = x_.data();
  const ColouredRow r = coloured_row(i, j, colour);
  const std::size_t n = r.own;
  const Stencil s{wx + n,     wx + n + dx, wy + n,     wy + n + dy, wz + n,      wz + r.above,
                  x + n - dx, x + n + dx,  x + n - dy, x + n + dy,  x + r.below, x + r.above};
  const float *b = &right_[n], *here = x + n;
  const int count = (cells_[2] - r.parity + 1) / 2;
  if (ratio == 2) {
#pragma GCC ivdep
    for (int m = 0; m < count; ++m) sums[m] += residual(s, b[m], here[m], m);
  } else {
    for (int m = 0; m < count; ++m) sums[2 * m + r.parity] += residual(s, b[m], here[m], m);
  }
}

/// After a black half-sweep only red cells have a residual, unless cells of one colour meet at a seam.
void MultigridLevel::restrict_residual(MultigridLevel& coarse, std::array<int, 3> ratio) noexcept {
  for (int I = 0; I < coarse.cells_[0]; ++I)
    for (int J = 0; J < coarse.cells_[1]; ++J) {
      std::fill(coarse_row_.begin(), coarse_row_.end(), 0.0f);
      for (int i = I * ratio[0]; i < std::min((I + 1) * ratio[0], cells_[0]); ++i)
        for (int j = J * ratio[1]; j < std::min((J + 1) * ratio[1], cells_[1]); ++j) {
          add_residual(i, j, red, ratio[2], coarse_row_.data());
          if (seam_) add_residual(i, j, black, ratio[2], coarse_row_.data());
        }
      split_row(coarse_row_.data(), 1.0f, coarse.cells_[2], &coarse.right_[coarse.at(I, J, 0)],
                &coarse.right_[coarse.at(I, J, 1)]);
    }
}

/// Without a seam the black half-sweep that follows overwrites black cells before anyone reads them.
void MultigridLevel::add_correction(int plane, const MultigridLevel& coarse, std::array<int, 3> ratio) noexcept {
  const int I = plane / ratio[0];
  for (int j = 0; j < cells_[1]; ++j) {
    const int J = j / ratio[1];
    if (j % ratio[1] == 0)
      join_row(&coarse.x_[coarse.at(I, J, 0)], &coarse.x_[coarse.at(I, J, 1)], coarse.cells_[2], coarse_row_.data());
    const float* __restrict correction = coarse_row_.data();
    for (Colour colour : {red, black}) {
      if (colour == black && !seam_) continue;
      const ColouredRow r = coloured_row(plane, j, colour);
      float* __restrict x = &x_[r.own];
      const int count = (cells_[2] - r.parity + 1) / 2;
      if (ratio[2] == 2)
        for (int m = 0; m < count; ++m) x[m] += correction[m];
      else
        for (int m = 0; m < count; ++m) x[m] += correction[2 * m + r.parity];
    }
    fill_ghost_cells(plane, j);
  }
  fill_ghost_rows(plane);
}

}   // namespace bedload

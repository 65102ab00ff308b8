// Kernels of one multigrid level; all inner loops run over contiguous cells of one colour.
#include "solver/fluid/multigrid_level.hpp"

#include <algorithm>

namespace bedload {

MultigridLevel::MultigridLevel(std::array<int, 3> cells, std::array<bool, 3> periodic) : cells_(cells), seam_(false) {
  for (int c = 0; c < 3; ++c) {
    wraps_[c] = periodic[c] && cells[c] > 1;
    seam_ = seam_ || (wraps_[c] && cells[c] % 2 == 1);
  }
  half_ = cells[2] / 2 + 2;
  const std::size_t size = row(cells[0], cells[1]) + 2 * half_;
  for (auto& w : coupling_) w.assign(size, 0);
  inverse_diagonal_.assign(size, 0);
  x_.assign(size, 0);
  right_.assign(size, 0);
  row_buffer_.assign(cells[2] + 2, 0);
}

// ---- couplings -------------------------------------------------------------------------------------------------------------

void MultigridLevel::finish_couplings() {
  const auto [nx, ny, nz] = cells_;
  for (auto& w : coupling_) {
    if (wraps_[2])
      for (int i = 0; i < nx; ++i)
        for (int j = 0; j < ny; ++j) w[at(i, j, nz)] = w[at(i, j, 0)];
    for (int i = 0; wraps_[1] && i < nx; ++i) std::copy_n(&w[row(i, 0)], 2 * half_, &w[row(i, ny)]);
    if (wraps_[0]) std::copy_n(&w[row(0, -1)], row(1, -1) - row(0, -1), &w[row(nx, -1)]);
  }
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j)
      for (int k = 0; k < nz; ++k) {
        const float diagonal = coupling_[0][at(i, j, k)] + coupling_[0][at(i + 1, j, k)] + coupling_[1][at(i, j, k)] +
                               coupling_[1][at(i, j + 1, k)] + coupling_[2][at(i, j, k)] + coupling_[2][at(i, j, k + 1)];
        inverse_diagonal_[at(i, j, k)] = diagonal > 0 ? 1 / diagonal : 0;
      }
}

void MultigridLevel::aggregate_couplings(const MultigridLevel& fine, std::array<int, 3> ratio) {
  for (int c = 0; c < 3; ++c) {
    std::fill(coupling_[c].begin(), coupling_[c].end(), 0.0f);
    if (cells_[c] == 1) continue;
    const float weight = ratio[c] == 2 ? 0.5f : 1.0f;
    std::array<int, 3> stride{1, 1, 1};
    stride[c] = ratio[c];   // along c only the faces between aggregates count
    for (int i = 0; i < fine.cells_[0]; i += stride[0])
      for (int j = 0; j < fine.cells_[1]; j += stride[1])
        for (int k = 0; k < fine.cells_[2]; k += stride[2])
          coupling_[c][at(i / ratio[0], j / ratio[1], k / ratio[2])] += weight * fine.coupling_[c][fine.at(i, j, k)];
  }
  finish_couplings();
}

std::vector<double> MultigridLevel::matrix() const {
  const int n = cell_count();
  std::vector<double> a(std::size_t(n) * n, 0.0);
  const auto number = [&](std::array<int, 3> m) { return (m[0] * cells_[1] + m[1]) * cells_[2] + m[2]; };
  std::array<int, 3> m;
  for (m[0] = 0; m[0] < cells_[0]; ++m[0])
    for (m[1] = 0; m[1] < cells_[1]; ++m[1])
      for (m[2] = 0; m[2] < cells_[2]; ++m[2])
        for (int c = 0; c < 3; ++c) {
          std::array<int, 3> lower = m;
          lower[c] = (m[c] + cells_[c] - 1) % cells_[c];
          const double w = coupling_[c][at(m[0], m[1], m[2])];
          const int p = number(m), q = number(lower);
          a[p * n + p] += w, a[q * n + q] += w;
          a[p * n + q] -= w, a[q * n + p] -= w;
        }
  return a;
}

// ---- to and from the finest level's fields ------------------------------------------------------------------------------------

void MultigridLevel::set_right_hand_side(const double* __restrict values, double scale, int i, int j) noexcept {
  float* __restrict even = &right_[at(i, j, 0)];
  float* __restrict odd = &right_[at(i, j, 1)];
  const int pairs = cells_[2] / 2;
  for (int m = 0; m < pairs; ++m) {
    even[m] = static_cast<float>(values[2 * m] * scale);
    odd[m] = static_cast<float>(values[2 * m + 1] * scale);
  }
  if (cells_[2] % 2) even[pairs] = static_cast<float>(values[2 * pairs] * scale);
}

void MultigridLevel::get_solution(double* __restrict values, double scale, int i, int j) const noexcept {
  const float* __restrict even = &x_[at(i, j, 0)];
  const float* __restrict odd = &x_[at(i, j, 1)];
  const int pairs = cells_[2] / 2;
  for (int m = 0; m < pairs; ++m) {
    values[2 * m] = even[m] * scale;
    values[2 * m + 1] = odd[m] * scale;
  }
  if (cells_[2] % 2) values[2 * pairs] = even[pairs] * scale;
}

// ---- sweeps ----------------------------------------------------------------------------------------------------------------

MultigridLevel::ColouredRow MultigridLevel::coloured_row(int i, int j, Colour colour) const noexcept {
  ColouredRow r;
  r.parity = (i + j + colour) & 1;
  r.count = (cells_[2] - r.parity + 1) / 2;
  r.own = at(i, j, r.parity);
  r.below = at(i, j, r.parity - 1);
  r.above = at(i, j, r.parity + 1);
  return r;
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

void MultigridLevel::fill_ghosts() noexcept {
  for (int i = 0; i < cells_[0]; ++i) {
    for (int j = 0; j < cells_[1]; ++j) fill_ghost_cells(i, j);
    fill_ghost_rows(i);
  }
  fill_ghost_planes();
}

/// Ghosts are renewed behind the rows that read them, so a whole colour sees the values of before its sweep.
void MultigridLevel::relax(Colour colour) noexcept {
  const std::size_t dy = row(0, 1) - row(0, 0), dx = row(1, 0) - row(0, 0);
  for (int i = 0; i < cells_[0]; ++i) {
    for (int j = 0; j < cells_[1]; ++j) {
      const ColouredRow r = coloured_row(i, j, colour);
      float* __restrict x = &x_[r.own];
      const float* __restrict neighbour = x_.data();
      const float* __restrict wx = &coupling_[0][r.own];
      const float* __restrict wy = &coupling_[1][r.own];
      const float* __restrict wz = coupling_[2].data();
      const float* __restrict b = &right_[r.own];
      const float* __restrict inverse = &inverse_diagonal_[r.own];
      for (int m = 0; m < r.count; ++m)
        x[m] = inverse[m] * (b[m] + (wx[m] * neighbour[r.own - dx + m] + wx[m + dx] * neighbour[r.own + dx + m]) +
                             (wy[m] * neighbour[r.own - dy + m] + wy[m + dy] * neighbour[r.own + dy + m]) +
                             (wz[r.own + m] * neighbour[r.below + m] + wz[r.above + m] * neighbour[r.above + m]));
      fill_ghost_cells(i, j);
    }
    fill_ghost_rows(i);
  }
  fill_ghost_planes();
}

/// The first red half-sweep from zero needs no neighbours.
void MultigridLevel::begin_with_red() noexcept {
  for (int i = 0; i < cells_[0]; ++i) {
    for (int j = 0; j < cells_[1]; ++j) {
      const ColouredRow r = coloured_row(i, j, red);
      for (int m = 0; m < r.count; ++m) x_[r.own + m] = inverse_diagonal_[r.own + m] * right_[r.own + m];
      fill_ghost_cells(i, j);
    }
    fill_ghost_rows(i);
  }
  fill_ghost_planes();
}

void MultigridLevel::smooth_from_zero() noexcept {
  if (seam_) std::fill(x_.begin(), x_.end(), 0.0f);   // across a seam black cells read black ones
  begin_with_red();
  relax(black);
  relax(red);
  relax(black);
}

void MultigridLevel::smooth_in_reverse() noexcept {
  relax(black);
  relax(red);
  relax(black);
  relax(red);
}

// ---- transfers -------------------------------------------------------------------------------------------------------------

/// After a black half-sweep only red cells have a residual, unless cells of one colour meet at a seam.
void MultigridLevel::restrict_residual(MultigridLevel& coarse, std::array<int, 3> ratio) noexcept {
  const std::size_t dy = row(0, 1) - row(0, 0), dx = row(1, 0) - row(0, 0);
  std::fill(coarse.right_.begin(), coarse.right_.end(), 0.0f);
  for (int i = 0; i < cells_[0]; ++i)
    for (int j = 0; j < cells_[1]; ++j) {
      for (Colour colour : {red, black}) {
        if (colour == black && !seam_) continue;
        const ColouredRow r = coloured_row(i, j, colour);
        const float *wx = &coupling_[0][r.own], *wy = &coupling_[1][r.own], *wz = coupling_[2].data();
        const float *x = x_.data(), *here = &x_[r.own], *b = &right_[r.own];
        float* __restrict residual = row_buffer_.data();
        for (int m = 0; m < r.count; ++m)
          residual[m] = b[m] + (wx[m] * (x[r.own - dx + m] - here[m]) + wx[m + dx] * (x[r.own + dx + m] - here[m])) +
                        (wy[m] * (x[r.own - dy + m] - here[m]) + wy[m + dy] * (x[r.own + dy + m] - here[m])) +
                        (wz[r.own + m] * (x[r.below + m] - here[m]) + wz[r.above + m] * (x[r.above + m] - here[m]));
        const int I = i / ratio[0], J = j / ratio[1];
        for (int m = 0; m < r.count; ++m) coarse.right_[coarse.at(I, J, (2 * m + r.parity) / ratio[2])] += residual[m];
      }
    }
}

/// Without a seam the black half-sweep that follows overwrites black cells before anyone reads them.
void MultigridLevel::add_correction(const MultigridLevel& coarse, std::array<int, 3> ratio) noexcept {
  for (int i = 0; i < cells_[0]; ++i)
    for (int j = 0; j < cells_[1]; ++j)
      for (Colour colour : {red, black}) {
        if (colour == black && !seam_) continue;
        const ColouredRow r = coloured_row(i, j, colour);
        const int I = i / ratio[0], J = j / ratio[1];
        for (int m = 0; m < r.count; ++m) x_[r.own + m] += coarse.x_[coarse.at(I, J, (2 * m + r.parity) / ratio[2])];
      }
  fill_ghosts();
}

}  // namespace bedload

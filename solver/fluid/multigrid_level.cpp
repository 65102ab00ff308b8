// Storage and set-up of one multigrid level.
#include "solver/fluid/multigrid_level.hpp"

#include <algorithm>

#include "solver/fluid/split_rows.hpp"

namespace bedload {

MultigridLevel::MultigridLevel(std::array<int, 3> cells, std::array<bool, 3> periodic) : cells_(cells), seam_(false) {
  for (int c = 0; c < 3; ++c) {
    wraps_[c] = periodic[c] && cells[c] > 1;
    seam_ = seam_ || (wraps_[c] && cells[c] % 2 == 1);
  }
  half_ = padded((cells[2] + 1) / 2) + 2;
  const std::size_t size = row(cells[0], cells[1]) + 2 * half_;
  for (auto& w : coupling_) w.assign(size, 0);
  inverse_diagonal_.assign(size, 0);
  x_.assign(size, 0);
  right_.assign(size, 0);
  coarse_row_.assign(2 * half_, 0);
}

void MultigridLevel::set_couplings(int c, int i, int j, const double* values, double scale) noexcept {
  split_row(values, cells_[c] > 1 ? scale : 0.0, cells_[2], &coupling_[c][at(i, j, 0)], &coupling_[c][at(i, j, 1)]);
}

void MultigridLevel::finish_couplings() noexcept {
  const auto [nx, ny, nz] = cells_;
  auto& [wx, wy, wz] = coupling_;
  std::fill(x_.begin(), x_.end(), 0.0f);   // nothing of an earlier solve, not even a NaN on padding, reaches this one
  if (wraps_[0]) std::copy_n(&wx[row(0, -1)], row(1, -1) - row(0, -1), &wx[row(nx, -1)]);
  const std::size_t dx = row(1, 0) - row(0, 0), dy = row(0, 1) - row(0, 0);
  for (int i = 0; i < nx; ++i) {
    if (wraps_[1]) std::copy_n(&wy[row(i, 0)], 2 * half_, &wy[row(i, ny)]);
    for (int j = 0; j < ny; ++j) {
      if (wraps_[2]) wz[at(i, j, nz)] = wz[at(i, j, 0)];
      for (int parity : {0, 1}) {
        const std::size_t own = at(i, j, parity), above = at(i, j, parity + 1);
        for (int m = 0; m < (nz - parity + 1) / 2; ++m) {
          const std::size_t n = own + m;
          const float diagonal = (wx[n] + wx[n + dx]) + (wy[n] + wy[n + dy]) + (wz[n] + wz[above + m]);
          inverse_diagonal_[n] = diagonal > 0 ? 1 / diagonal : 0;
        }
      }
    }
  }
}

void MultigridLevel::aggregate_couplings(const MultigridLevel& fine, std::array<int, 3> ratio) noexcept {
  for (int c = 0; c < 3; ++c) {
    std::fill(coupling_[c].begin(), coupling_[c].end(), 0.0f);
    if (cells_[c] == 1) continue;
    const float weight = ratio[c] == 2 ? 0.5f : 1.0f;
    std::array<int, 2> stride{1, 1};
    if (c < 2) stride[c] = ratio[c];   // along c only the faces between aggregates count
    for (int i = 0; i < fine.cells_[0]; i += stride[0])
      for (int j = 0; j < fine.cells_[1]; j += stride[1]) {
        const float *even = &fine.coupling_[c][fine.at(i, j, 0)], *odd = &fine.coupling_[c][fine.at(i, j, 1)];
        float* __restrict sum = coarse_row_.data();
        if (ratio[2] == 1) join_row(even, odd, cells_[2], sum);
        else
          for (int k = 0; k < cells_[2]; ++k) sum[k] = c == 2 ? even[k] : even[k] + odd[k];
        add_split_row(sum, weight, cells_[2], &coupling_[c][at(i / ratio[0], j / ratio[1], 0)],
                      &coupling_[c][at(i / ratio[0], j / ratio[1], 1)]);
      }
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

void MultigridLevel::set_right_hand_side(int i, int j, const double* values, double scale) noexcept {
  split_row(values, scale, cells_[2], &right_[at(i, j, 0)], &right_[at(i, j, 1)]);
}

void MultigridLevel::get_solution(int i, int j, double* values) const noexcept {
  join_row(&x_[at(i, j, 0)], &x_[at(i, j, 1)], cells_[2], values);
}

}   // namespace bedload

// Storage and set-up of one multigrid level.
#include "solver/fluid/multigrid_level.hpp"

#include <algorithm>

#include "solver/fluid/split_rows.hpp"

namespace bedload {

MultigridLevel::MultigridLevel(std::array<int, 3> cells, std::array<bool, 3> periodic)
    : at_(cells, periodic), sums_(cells[0]) {
  for (auto& w : coupling_) w.assign(at_.size(), 0);
  inverse_diagonal_.assign(at_.size(), 0);
  x_.assign(at_.size(), 0);
  right_.assign(at_.size(), 0);
  aggregates_.assign(at_.plane_of_rows(), 0);
  for (auto& offsets : kept_) offsets.assign(cells[0] + 1, 0);
}

void MultigridLevel::set_couplings(int c, int i, int j, const double* values, double scale) noexcept {
  split_row(values, at_.cells[c] > 1 ? scale : 0.0, at_.cells[2], &coupling_[c][at_.at(i, j, 0)],
            &coupling_[c][at_.at(i, j, 1)]);
}

void MultigridLevel::finish_couplings() noexcept {
  const auto [nx, ny, nz] = at_.cells;
  auto& [wx, wy, wz] = coupling_;
  for (auto* field : {&x_, &right_})   // nothing of an earlier solve, not even a NaN on padding, reaches this one
    std::fill(field->begin(), field->end(), 0.0f);
  if (at_.wraps[0]) std::copy_n(&wx[at_.row(0, -1)], at_.plane_stride(), &wx[at_.row(nx, -1)]);
  const std::size_t dx = at_.plane_stride(), dy = at_.row_stride();
  for (int i = 0; i < nx; ++i) {
    if (at_.wraps[1]) std::copy_n(&wy[at_.row(i, 0)], at_.row_stride(), &wy[at_.row(i, ny)]);
    for (int j = 0; j < ny; ++j) {
      if (at_.wraps[2]) wz[at_.at(i, j, nz)] = wz[at_.at(i, j, 0)];
      for (int parity : {0, 1}) {
        const std::size_t own = at_.at(i, j, parity), above = at_.at(i, j, parity + 1);
        for (int m = 0; m < (nz - parity + 1) / 2; ++m) {
          const std::size_t n = own + m;
          const float diagonal = (wx[n] + wx[n + dx]) + (wy[n] + wy[n + dy]) + (wz[n] + wz[above + m]);
          inverse_diagonal_[n] = diagonal > 0 ? 1 / diagonal : 0;
        }
      }
    }
  }
  find_kept_planes();
}

void MultigridLevel::find_kept_planes() noexcept {
  for (int a = 0; a < 4; ++a) {
    const float* const values = a < 3 ? coupling_[a].data() : inverse_diagonal_.data();
    for (int i = 0; i <= at_.cells[0]; ++i) {
      const float* const plane = values + at_.row(i, -1);
      kept_[a][i] = at_.row(i, -1);
      if (i > 0 && std::equal(plane, plane + at_.plane_stride(), values + kept_[a][i - 1]))
        kept_[a][i] = kept_[a][i - 1];
    }
  }
}

void MultigridLevel::coarsen_couplings(MultigridLevel& fine, Ratio ratio) noexcept {
  for (auto& w : coupling_) std::fill(w.begin(), w.end(), 0.0f);
  if (ratio == along_z) fine.find_shares(), thin_couplings(fine);
  else aggregate_couplings(fine, ratio);
  finish_couplings();
}

/// Sums of the couplings of `fine` across the interfaces between aggregates of ratio[c] cells.
void MultigridLevel::aggregate_couplings(const MultigridLevel& fine, Ratio ratio) noexcept {
  for (int c = 0; c < 3; ++c) {
    if (at_.cells[c] == 1) continue;
    const float weight = ratio[c] == 2 ? 0.5f : 1.0f;
    std::array<int, 2> stride{1, 1};
    if (c < 2) stride[c] = ratio[c];   // along c only the faces between aggregates count
    for (int i = 0; i < fine.at_.cells[0]; i += stride[0])
      for (int j = 0; j < fine.at_.cells[1]; j += stride[1]) {
        const float *even = &fine.coupling_[c][fine.at_.at(i, j, 0)], *odd = &fine.coupling_[c][fine.at_.at(i, j, 1)];
        float* __restrict sum = aggregates_.data();
        if (ratio[2] == 1) join_row(even, odd, at_.cells[2], sum);
        else
          for (int k = 0; k < at_.cells[2]; ++k) sum[k] = c == 2 ? even[k] : even[k] + odd[k];
        add_split_row(sum, weight, at_.cells[2], &coupling_[c][at_.at(i / ratio[0], j / ratio[1], 0)],
                      &coupling_[c][at_.at(i / ratio[0], j / ratio[1], 1)]);
      }
  }
}

std::vector<double> MultigridLevel::matrix() const {
  const int n = at_.cell_count();
  std::vector<double> a(std::size_t(n) * n, 0.0);
  const auto number = [&](std::array<int, 3> m) { return (m[0] * at_.cells[1] + m[1]) * at_.cells[2] + m[2]; };
  std::array<int, 3> m;
  for (m[0] = 0; m[0] < at_.cells[0]; ++m[0])
    for (m[1] = 0; m[1] < at_.cells[1]; ++m[1])
      for (m[2] = 0; m[2] < at_.cells[2]; ++m[2])
        for (int c = 0; c < 3; ++c) {
          std::array<int, 3> lower = m;
          lower[c] = (m[c] + at_.cells[c] - 1) % at_.cells[c];
          const double w = coupling_[c][at_.at(m[0], m[1], m[2])];
          const int p = number(m), q = number(lower);
          a[p * n + p] += w, a[q * n + q] += w;
          a[p * n + q] -= w, a[q * n + p] -= w;
        }
  return a;
}

}   // namespace bedload

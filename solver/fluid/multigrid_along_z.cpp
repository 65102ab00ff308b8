// Pairing along z alone, for cells flatter than wide. Columns couple so much more strongly than rows there that a pair of
// cells across a poor coupling must not become one: even cells are kept, odd ones follow the neighbour that holds them.
#include <algorithm>

#include "solver/fluid/multigrid_level.hpp"
#include "solver/fluid/split_rows.hpp"

namespace bedload {
namespace {

/// Adds to a row of the coarse level what stands in natural order; what lies beyond its end lies at its beginning.
void add_row(const SplitGrid& at, int i, int j, float* __restrict row, std::vector<float>& to) noexcept {
  row[0] += row[at.cells[2]];
  add_split_row(row, 1.0f, at.cells[2], &to[at.at(i, j, 0)], &to[at.at(i, j, 1)]);
}

/// Interpolated cells of a column: their lower shares, and their couplings with the cells above.
struct Column {
  const float *share, *high;
};

/// What lateral couplings w of two columns' interpolated cells become: couplings of the kept cells below and above, and
/// what comes on top along z in the one column and the other. In the order of the interpolated cells.
void share_out(const float* w, Column one, Column other, int cells, float* __restrict below, float* __restrict above,
               float* __restrict on_one, float* __restrict on_other) noexcept {
  for (int m = 0; m < cells; ++m) {
    const float a = one.share[m], b = other.share[m];
    const float k = a * one.high[m], l = b * other.high[m];
    const float s = k + l > 0 ? (a * l + b * k) / (k + l) : a;
    below[m] = w[m] * s;
    above[m] = w[m] * (1 - s);
    on_one[m] += w[m] * (s - a) * (s - a);
    on_other[m] = w[m] * (s - b) * (s - b);
  }
}

}   // namespace

/// An odd cell lies between its neighbours as a potential along the column does: nearer to the one it couples with more.
void MultigridLevel::find_shares() noexcept {
  lower_share_.resize(at_.size());
  for (int i = 0; i < at_.cells[0]; ++i)
    for (int j = 0; j < at_.cells[1]; ++j) {
      const float *low = &coupling_[2][at_.at(i, j, 1)], *high = &coupling_[2][at_.at(i, j, 2)];
      float* __restrict share = &lower_share_[at_.at(i, j, 1)];
      for (int m = 0; m < at_.cells[2] / 2; ++m) share[m] = low[m] + high[m] > 0 ? low[m] / (low[m] + high[m]) : 1;
    }
}

/// Along z two couplings in series. A lateral coupling w of two odd cells whose lower shares are a and b goes to the even
/// cells below and above with parts s and 1 - s, s between a and b and nearer to that of the column that is harder to shear:
/// a column that is cut there does not hold together by its neighbour. What the columns' ends have to move for it costs
/// w (s - a)^2 and w (s - b)^2 along z; without these the coarse level would be softer than the fine one.
void MultigridLevel::thin_couplings(const MultigridLevel& fine) noexcept {
  const SplitGrid& f = fine.at_;
  const auto [nx, ny, nz] = at_.cells;
  const int odd = f.cells[2] / 2;
  std::vector<float> lateral(nz + 1), column(nz + 1), below(nz + 1), above(nz + 1), neighbour(nz + 1);
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j) {
      const Column own{&fine.lower_share_[f.at(i, j, 1)], &fine.coupling_[2][f.at(i, j, 2)]};
      column[0] = f.cells[2] % 2 == 1 ? fine.coupling_[2][f.at(i, j, 0)] : 0;   // at an odd seam even cells meet
      for (int m = 0; m < odd; ++m) column[m + 1] = own.share[m] * own.high[m];
      for (int c : {0, 1}) {
        if (at_.cells[c] == 1) continue;
        const int I = c == 0 ? (i + nx - 1) % nx : i, J = c == 1 ? (j + ny - 1) % ny : j;
        const float *even = &fine.coupling_[c][f.at(i, j, 0)], *w = &fine.coupling_[c][f.at(i, j, 1)];
        share_out(w, own, {&fine.lower_share_[f.at(I, J, 1)], &fine.coupling_[2][f.at(I, J, 2)]}, odd, below.data(),
                  above.data() + 1, column.data() + 1, neighbour.data() + 1);
        for (int m = 0; m < nz; ++m) lateral[m] = (even[m] + above[m]) + below[m];
        lateral[nz] = above[nz];
        neighbour[0] = 0;
        add_row(at_, i, j, lateral.data(), coupling_[c]);
        if (nz > 1) add_row(at_, I, J, neighbour.data(), coupling_[2]);
      }
      if (nz > 1) add_row(at_, i, j, column.data(), coupling_[2]);
    }
}

/// The transpose of interpolate_along_z(). After a black half-sweep only red cells have a residual, unless there is a seam.
void MultigridLevel::restrict_along_z(int plane, MultigridLevel& coarse) noexcept {
  const int kept = coarse.at_.cells[2], odd_cells = at_.cells[2] / 2;
  find_residual(plane, red);
  if (at_.seam) find_residual(plane, black);
  std::vector<float>& sum = coarse.aggregates_;
  for (int j = 0; j < at_.cells[1]; ++j) {
    const float *even = &aggregates_[j * at_.row_stride()], *odd = even + at_.half,
                *share = &lower_share_[at_.at(plane, j, 1)];
    const bool red_is_even = (plane + j) % 2 == 0;
    if (red_is_even || at_.seam) std::copy_n(even, kept, sum.begin());
    else std::fill_n(sum.begin(), kept, 0.0f);
    sum[kept] = 0;
    if (!red_is_even || at_.seam) {
      for (int m = 0; m < odd_cells; ++m) sum[m] += share[m] * odd[m];
      for (int m = 0; m < odd_cells; ++m) sum[m + 1] += (1 - share[m]) * odd[m];
      sum[0] += sum[kept];
    }
    split_row(sum.data(), 1.0f, kept, &coarse.right_[coarse.at_.at(plane, j, 0)],
              &coarse.right_[coarse.at_.at(plane, j, 1)]);
  }
}

/// Without a seam the black half-sweep that follows overwrites black cells before anyone reads them.
void MultigridLevel::interpolate_along_z(int plane, const MultigridLevel& coarse) noexcept {
  const int kept = coarse.at_.cells[2];
  std::vector<float>& correction = aggregates_;
  for (int j = 0; j < at_.cells[1]; ++j) {
    join_row(&coarse.x_[coarse.at_.at(plane, j, 0)], &coarse.x_[coarse.at_.at(plane, j, 1)], kept, correction.data());
    correction[kept] = correction[0];
    const float *below = correction.data(), *above = below + 1, *share = &lower_share_[at_.at(plane, j, 1)];
    float *even = &x_[at_.at(plane, j, 0)], *__restrict odd = &x_[at_.at(plane, j, 1)];
    const bool red_is_even = (plane + j) % 2 == 0;
    if (red_is_even || at_.seam)
      for (int m = 0; m < kept; ++m) even[m] += below[m];
    if (!red_is_even || at_.seam)
      for (int m = 0; m < at_.cells[2] / 2; ++m) odd[m] += share[m] * below[m] + (1 - share[m]) * above[m];
  }
  wrap(plane);
}

}   // namespace bedload

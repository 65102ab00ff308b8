// Thomas's algorithm on lines, neighbouring lines side by side; round a period Sherman and Morrison's formula.
#include "solver/coupling/smoothing.hpp"

#include <type_traits>

namespace bedload {

KernelSmoothing::KernelSmoothing(const StaggeredGrid& grid, const Smoothing& widths) : grid_(grid) {
  const Vec3 sigma{widths.xy, widths.xy, widths.z};
  for (int c = 0; c < 3; ++c) {
    if (!(sigma[c] > 0)) continue;
    any_ = true;
    const int n = grid.cells[c];
    const double k = sigma[c] * sigma[c] / (2 * passes * grid.h[c] * grid.h[c]);
    std::vector<double> diagonal(n, 1 + 2 * k);
    if (grid.periodic(c)) {
      cells_[c] = nodes_[c] = inner_[c] = factored(diagonal, k, true);
    } else {
      inner_[c] = factored(std::vector<double>(n - 1, 1 + 2 * k), k, false);
      diagonal.front() = diagonal.back() = 1 + k;
      cells_[c] = factored(diagonal, k, false);
      std::vector<double> nodal(n + 1, 1 + 2 * k);
      nodal.front() = nodal.back() = 0.5 + k;
      nodes_[c] = factored(nodal, k, false);
      nodes_[c].half_ends = true;
    }
    read_back_[c].resize(5 * n);
    for (int i = 0; i < n; ++i) {
      std::vector<double> unit(n);
      unit[i] = 1;
      double seam = 0;
      for (const Use use : {Use::spread, Use::gather}) solve(cells_[c], use, unit.data(), 1, 1, 1, &seam);
      for (int m = 0; m < 5; ++m) {
        const int j = grid.periodic(c) ? (i + m - 2 + n) % n : std::clamp(i + m - 2, 0, n - 1);
        read_back_[c][5 * i + m] = unit[j];
      }
    }
  }
}

/// Round a period the matrix is that of an open line with other ends, less an outer product: (d, 0 ... 0, k) (1, 0 ... 0, k/d).
KernelSmoothing::Line KernelSmoothing::factored(std::vector<double> diagonal, double k, bool periodic) {
  const int n = static_cast<int>(diagonal.size());
  const double d = diagonal.front();
  if (periodic) diagonal.front() += d, diagonal.back() += k * k / d;
  Line line{.g = std::vector<double>(n), .r = std::vector<double>(n)};
  for (int i = 0; i < n; ++i) {
    line.g[i] = 1 / (diagonal[i] - (i > 0 ? k * line.r[i - 1] : 0));
    line.r[i] = k * line.g[i];
  }
  if (!periodic) return line;
  std::vector<double> wrap(n);
  wrap.front() = d, wrap.back() = k;
  for (int i = 0; i < n; ++i) wrap[i] = line.g[i] * wrap[i] + (i > 0 ? line.r[i] * wrap[i - 1] : 0);
  for (int i = n - 2; i >= 0; --i) wrap[i] += line.r[i] * wrap[i + 1];
  line.seam = k / d;
  const double left = 1 - wrap.front() - line.seam * wrap.back();
  for (double& w : wrap) w /= left;
  line.wrap = std::move(wrap);
  return line;
}

/// All passes, in place; lane l of position i stands at first + i step + l lane_step.
template <class LaneStep>
void KernelSmoothing::solve(const Line& line, Use use, double* first, std::ptrdiff_t step, LaneStep lane_step,
                            int lanes, double* __restrict seam) {
  const int n = static_cast<int>(line.g.size());
  const auto halve_ends = [&] {
    for (double* end : {first, first + (n - 1) * step})
      for (int l = 0; l < lanes; ++l) end[l * lane_step] *= 0.5;
  };
  for (int pass = 0; pass < passes; ++pass) {
    if (line.half_ends && use == Use::gather) halve_ends();
    for (int l = 0; l < lanes; ++l) first[l * lane_step] *= line.g[0];
    for (int i = 1; i < n; ++i) {
      double* f = first + i * step;
      for (int l = 0; l < lanes; ++l)
        f[l * lane_step] = line.g[i] * f[l * lane_step] + line.r[i] * f[l * lane_step - step];
    }
    for (int i = n - 2; i >= 0; --i) {
      double* f = first + i * step;
      for (int l = 0; l < lanes; ++l) f[l * lane_step] += line.r[i] * f[l * lane_step + step];
    }
    if (!line.wrap.empty()) {
      const double* last = first + (n - 1) * step;
      for (int l = 0; l < lanes; ++l) seam[l] = first[l * lane_step] + line.seam * last[l * lane_step];
      for (int i = 0; i < n; ++i) {
        double* f = first + i * step;
        for (int l = 0; l < lanes; ++l) f[l * lane_step] += line.wrap[i] * seam[l];
      }
    }
    if (line.half_ends && use == Use::spread) halve_ends();
  }
}

void KernelSmoothing::smooth(int place, bool flux, Use use, double* field) const {
  std::array<int, 3> first{}, count = grid_.cells;   // positions of the field
  for (int c = 0; c < 3; ++c) {
    if (grid_.periodic(c) || !has_hat(place, c)) continue;
    first[c] = flux ? 1 : 0, count[c] += flux ? -1 : 1;
  }
  const std::size_t lanes = std::max(count[1], count[2]);
  std::vector<double> seam(lanes);
  double* const origin = field + grid_.index(first[0], first[1], first[2]);
  using Contiguous = std::integral_constant<std::ptrdiff_t, 1>;
  for (int c = 0; c < 3; ++c) {
    const Line& line = !has_hat(place, c) ? cells_[c] : flux ? inner_[c] : nodes_[c];
    if (line.g.empty()) continue;
    const int other = c == 0 ? 1 : 0;
    for (int m = 0; m < count[other]; ++m) {
      double* const start = origin + m * grid_.stride(other);
      if (c == 2) solve(line, use, start, 1, grid_.stride(1), count[1], seam.data());
      else solve(line, use, start, grid_.stride(c), Contiguous{}, count[2], seam.data());
    }
  }
}

void KernelSmoothing::spread(FaceFields& f) const {
  for (int c = 0; any_ && c < 3; ++c) smooth(c, false, Use::spread, f.component(c));
}
void KernelSmoothing::spread(Field<Centre>& f) const {
  if (any_) smooth(on_cells, false, Use::spread, f.data());
}
void KernelSmoothing::spread_on_edges(FaceFields& f) const {
  for (int t = 0; any_ && t < 3; ++t) smooth(on_x_edges + t, false, Use::spread, f.component(t));
}
void KernelSmoothing::spread_flux(FaceFields& f) const {
  for (int c = 0; any_ && c < 3; ++c) smooth(c, true, Use::spread, f.component(c));
}
void KernelSmoothing::gather(FaceFields& f) const {
  for (int c = 0; any_ && c < 3; ++c) smooth(c, false, Use::gather, f.component(c));
}
void KernelSmoothing::gather(Field<Centre>& f) const {
  if (any_) smooth(on_cells, false, Use::gather, f.data());
}

const FaceFields& KernelSmoothing::edges_seen(const FaceFields& on_edges, FaceFields& scratch) const {
  if (!any_) return on_edges;
  scratch = on_edges;
  for (int t = 0; t < 3; ++t) smooth(on_x_edges + t, false, Use::gather, scratch.component(t));
  return scratch;
}

double KernelSmoothing::read_back(int direction, int i, int j) const noexcept {
  const auto& diagonals = read_back_[direction];
  if (diagonals.empty()) return i == j ? 1 : 0;
  const int n = grid_.cells[direction], apart = j - i + 2;
  return diagonals[5 * i + (grid_.periodic(direction) ? (apart + n) % n : apart)];
}

}   // namespace bedload

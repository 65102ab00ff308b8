// Sources, then their running sums along lines, a plane of lines at a time; neighbouring lines are summed together.
#include "solver/fluid/flux_closure.hpp"

#include <algorithm>
#include <type_traits>

namespace bedload {
namespace {

/// S = d(eps)/dt + mean of div F over the volume, on a row of faces whose lower cells are s before their upper ones; the void
/// fractions are nullptr where they do not change.
void find_sources(std::ptrdiff_t s, const double* __restrict divergence, const double* __restrict before,
                  const double* __restrict after, double per_dt, int length, double* __restrict source) noexcept {
  if (!before)
    for (int k = 0; k < length; ++k) source[k] = 0 + 0.5 * (divergence[k - s] + divergence[k]);
  else
    for (int k = 0; k < length; ++k)
      source[k] = (after[k] - before[k]) * per_dt + 0.5 * (divergence[k - s] + divergence[k]);
}

/// `lanes` lines side by side: position i of lane l is at first + i step + l lane_step.
template <class LaneStep>
struct Lines {
  double* first;
  std::ptrdiff_t step;
  LaneStep lane_step;
  int lanes;

  double& at(int i, int l) const noexcept { return first[i * step + l * lane_step]; }
};

template <class LaneStep>
void means(Lines<LaneStep> lines, int length, double* __restrict mean) noexcept {
  std::fill_n(mean, lines.lanes, 0.0);
  for (int i = 0; i < length; ++i)
    for (int l = 0; l < lines.lanes; ++l) mean[l] += lines.at(i, l);
  for (int l = 0; l < lines.lanes; ++l) mean[l] /= length;
}

/// Turns S into D in place.
template <class LaneStep>
void integrate(Lines<LaneStep> lines, int cells, bool periodic, double h, double* __restrict mean,
               double* __restrict running) noexcept {
  means(lines, periodic ? cells : cells + 1, mean);
  std::fill_n(running, lines.lanes, 0.0);
  for (int i = 0; i < cells; ++i)
    for (int l = 0; l < lines.lanes; ++l) lines.at(i, l) = running[l] -= h * (lines.at(i, l) - mean[l]);
  if (!periodic) return;
  means(lines, cells, mean);
  for (int i = 0; i < cells; ++i)
    for (int l = 0; l < lines.lanes; ++l) lines.at(i, l) -= mean[l];
  for (int l = 0; l < lines.lanes; ++l) lines.at(-1, l) = lines.at(cells - 1, l);
}

using Contiguous = std::integral_constant<std::ptrdiff_t, 1>;

}   // namespace

void close_flux(const StaggeredGrid& g, int c, int plane, const Field<Centre>& divergence, const double* void_before,
                const double* void_after, double dt, double* correction, std::vector<double>& sums) {
  // Faces 0..n-1 of a periodic direction, 0..n between walls.
  const int faces = g.cells[c] + (g.periodic(c) ? 0 : 1);
  const int rows = c == 2 ? g.cells[1] : faces, length = c == 2 ? faces : g.cells[2];
  const std::ptrdiff_t next_row = c == 2 ? g.stride(1) : g.stride(c);
  const std::size_t first = g.index(0, 0, 0) + plane * g.stride(c == 0 ? 1 : 0);
  for (int r = 0; r < rows; ++r) {
    const std::size_t row = first + r * next_row;
    find_sources(g.stride(c), divergence.data() + row, void_before ? void_before + row : nullptr,
                 void_after ? void_after + row : nullptr, 1 / dt, length, correction + row);
  }
  const std::size_t lanes = std::max(g.cells[1], g.cells[2]);
  sums.resize(2 * lanes);
  double *mean = sums.data(), *running = mean + lanes, *lines = correction + first;
  if (c == 2)
    integrate(Lines<std::ptrdiff_t>{lines, 1, next_row, rows}, g.cells[2], g.periodic(2), g.h.z, mean, running);
  else integrate(Lines<Contiguous>{lines, next_row, {}, length}, g.cells[c], g.periodic(c), g.h[c], mean, running);
}

}   // namespace bedload

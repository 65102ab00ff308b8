// Sources row by row, then running sums along lines; neighbouring lines are summed together.
#include "solver/fluid/flux_closure.hpp"

#include <algorithm>
#include <type_traits>

namespace bedload {
namespace {

/// S on the faces 0..n-1 of a periodic direction, 0..n between walls.
void find_sources(const StaggeredGrid& g, int c, const double* divergence, const double* before, const double* after,
                  double dt, double* source) noexcept {
  std::array<int, 3> faces = g.cells;
  if (!g.periodic(c)) ++faces[c];
  const std::ptrdiff_t s = g.stride(c);
  const double per_dt = 1 / dt;
  for (int i = 0; i < faces[0]; ++i)
    for (int j = 0; j < faces[1]; ++j) {
      const std::size_t row = g.index(i, j, 0);
      const double *div = divergence + row, *eps = before + row, *next = after + row;
      double* __restrict out = source + row;
      for (int k = 0; k < faces[2]; ++k) out[k] = (next[k] - eps[k]) * per_dt + 0.5 * (div[k - s] + div[k]);
    }
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

}   // namespace

void close_flux(const StaggeredGrid& g, int c, const Field<Centre>& divergence, const double* void_before,
                const double* void_after, double dt, double* correction, std::vector<double>& sums) {
  find_sources(g, c, divergence.data(), void_before, void_after, dt, correction);
  const std::size_t lanes = std::max(g.cells[1], g.cells[2]);
  sums.resize(2 * lanes);
  double *mean = sums.data(), *running = mean + lanes, *origin = correction + g.index(0, 0, 0);
  if (c == 2) {
    for (int i = 0; i < g.cells[0]; ++i)
      integrate(Lines<std::ptrdiff_t>{origin + i * g.stride(0), 1, g.stride(1), g.cells[1]}, g.cells[2], g.periodic(2),
                g.h.z, mean, running);
    return;
  }
  using Contiguous = std::integral_constant<std::ptrdiff_t, 1>;
  const int other = 1 - c;
  for (int m = 0; m < g.cells[other]; ++m)
    integrate(Lines<Contiguous>{origin + m * g.stride(other), g.stride(c), {}, g.cells[2]}, g.cells[c], g.periodic(c),
              g.h[c], mean, running);
}

}   // namespace bedload

#include "solver/coupling/kernel.hpp"

namespace bedload {
namespace {

/// A ghost plane of one direction and the plane inside that it stands for.
struct Image {
  int ghost, home;
};

/// Ghosts -2, -1, n, n+1 (n is face 0 again): round the period, or reflected at walls.
std::array<Image, 4> images(const StaggeredGrid& g, int direction) {
  const int n = g.cells[direction];
  if (g.periodic(direction)) return {{{-2, (2 * n - 2) % n}, {-1, n - 1}, {n, 0}, {n + 1, 1 % n}}};
  return {{{-2, std::min(1, n - 1)}, {-1, 0}, {n, n - 1}, {n + 1, std::max(n - 2, 0)}}};
}

/// Calls visit(ghost index, home index) for every pair of planes, whole padded planes, in the order of directions given.
template <class Visit>
void for_each_image(const StaggeredGrid& g, int place, std::array<int, 3> order, Visit&& visit) {
  constexpr int ghosts = StaggeredGrid::ghosts;
  for (const int c : order) {
    const int d = c == 0 ? 1 : 0, e = c == 2 ? 1 : 2;    // the inner loop along the rows
    if (!g.periodic(c) && has_hat(place, c)) continue;   // what lies on walls is its own; grains reach none beyond
    for (const Image& image : images(g, c)) {
      const std::ptrdiff_t from = (image.ghost + ghosts) * g.stride(c), to = (image.home + ghosts) * g.stride(c);
      for (int p = 0; p < g.cells[d] + 2 * ghosts; ++p)
        for (int q = 0; q < g.cells[e] + 2 * ghosts; ++q) {
          const std::ptrdiff_t across = p * g.stride(d) + q * g.stride(e);
          visit(from + across, to + across);
        }
    }
  }
}

void extend(const StaggeredGrid& g, int place, double* f) {
  for_each_image(g, place, {0, 1, 2}, [f](std::ptrdiff_t ghost, std::ptrdiff_t home) { f[ghost] = f[home]; });
}
void fold(const StaggeredGrid& g, int place, double* f) {
  for_each_image(g, place, {2, 1, 0},
                 [f](std::ptrdiff_t ghost, std::ptrdiff_t home) { f[home] += f[ghost], f[ghost] = 0; });
}

}   // namespace

void extend_samples(const StaggeredGrid& g, FaceFields& f) {
  for (int c = 0; c < 3; ++c) extend(g, c, f.component(c));
}
void extend_samples(const StaggeredGrid& g, Field<Centre>& f) { extend(g, on_cells, f.data()); }
void extend_edge_samples(const StaggeredGrid& g, FaceFields& f) {
  for (int t = 0; t < 3; ++t) extend(g, on_x_edges + t, f.component(t));
}
void fold_deposits(const StaggeredGrid& g, FaceFields& f) {
  for (int c = 0; c < 3; ++c) fold(g, c, f.component(c));
}
void fold_deposits(const StaggeredGrid& g, Field<Centre>& f) { fold(g, on_cells, f.data()); }
void fold_edge_deposits(const StaggeredGrid& g, FaceFields& f) {
  for (int t = 0; t < 3; ++t) fold(g, on_x_edges + t, f.component(t));
}

}   // namespace bedload

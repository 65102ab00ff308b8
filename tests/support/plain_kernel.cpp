#include "tests/support/plain_kernel.hpp"

namespace bedload::test {
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

/// Calls visit(ghost index, home index, length) for runs along z of pairs of ghost and home, whole padded planes, in the order
/// of directions given.
template <class Visit>
void for_each_image(const StaggeredGrid& g, int place, std::array<int, 3> order, Visit&& visit) {
  constexpr int ghosts = StaggeredGrid::ghosts;
  const std::ptrdiff_t row = g.stride(1), rows = g.stride(0) / row * (g.cells[0] + 2 * ghosts);
  for (const int c : order) {
    if (!g.periodic(c) && has_hat(place, c)) continue;   // what lies on walls is its own; grains reach none beyond
    const std::array<Image, 4> planes = images(g, c);
    if (c == 2) {
      for (std::ptrdiff_t start = ghosts; start < rows * row; start += row)
        for (const Image& image : planes) visit(start + image.ghost, start + image.home, 1);
      continue;
    }
    for (const Image& image : planes)
      for (int p = 0; p < g.cells[1 - c] + 2 * ghosts; ++p) {
        const std::ptrdiff_t across = p * g.stride(1 - c);
        visit((image.ghost + ghosts) * g.stride(c) + across, (image.home + ghosts) * g.stride(c) + across, row);
      }
  }
}

void extend(const StaggeredGrid& g, int place, double* f) {
  for_each_image(g, place, {0, 1, 2}, [f](std::ptrdiff_t ghost, std::ptrdiff_t home, std::ptrdiff_t length) {
    const double* __restrict from = f + home;
    double* __restrict to = f + ghost;
    for (std::ptrdiff_t k = 0; k < length; ++k) to[k] = from[k];
  });
}
void fold(const StaggeredGrid& g, int place, double* f) {
  for_each_image(g, place, {2, 1, 0}, [f](std::ptrdiff_t ghost, std::ptrdiff_t home, std::ptrdiff_t length) {
    double* __restrict from = f + ghost;
    double* __restrict to = f + home;
    for (std::ptrdiff_t k = 0; k < length; ++k) to[k] += from[k], from[k] = 0;
  });
}

}   // namespace

void extend_samples(const StaggeredGrid& g, FaceFields& f, int first) {
  for (int c = 0; c < 3; ++c) extend(g, first + c, f.component(c));
}
void extend_samples(const StaggeredGrid& g, Field<Centre>& f) { extend(g, on_cells, f.data()); }
void fold_deposits(const StaggeredGrid& g, FaceFields& f, int first) {
  for (int c = 0; c < 3; ++c) fold(g, first + c, f.component(c));
}

}   // namespace bedload::test

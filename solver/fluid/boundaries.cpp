// Each ghost layer is an affine image of a layer inside: copied, reflected, or reflected about a moving wall.
#include "solver/fluid/boundaries.hpp"

#include <algorithm>

namespace bedload {
namespace {

struct Image {
  int ghost, source;   // layers along the direction
  double sign, offset;

  double of(double value) const noexcept { return sign == 0 ? 0.0 : offset + sign * value; }
};

/// Fills layers of one direction from others, in the order of the images: inner layers come before outer ones, so that
/// a box one cell wide reflects its own reflections. A layer is a contiguous stretch of each of `blocks`.
template <int count>
void fill_layers(const StaggeredGrid& g, double* field, int direction, const Image (&images)[count]) noexcept {
  constexpr int ghosts = StaggeredGrid::ghosts;
  const std::ptrdiff_t stretch = g.stride(direction), block = stretch * (g.cells[direction] + 2 * ghosts);
  const std::size_t blocks = g.padded_size() / block;
  double* first = field + ghosts * stretch;
  if (direction == 2) {
    for (std::size_t b = 0; b < blocks; ++b, first += block)
      for (int m = 0; m < count; ++m) first[images[m].ghost] = images[m].of(first[images[m].source]);
    return;
  }
  for (std::size_t b = 0; b < blocks; ++b, first += block)
    for (const Image& m : images) {
      double* const ghost = first + m.ghost * stretch;
      const double* const source = first + m.source * stretch;
      for (std::ptrdiff_t k = 0; k < stretch; ++k) ghost[k] = m.of(source[k]);
    }
}

void fill_periodic(const StaggeredGrid& g, double* field, int c, GhostLayers layers) noexcept {
  const int n = g.cells[c];
  const Image inner[] = {{-1, n - 1, 1, 0}, {n, 0, 1, 0}};
  const Image outer[] = {{-2, n > 1 ? n - 2 : 0, 1, 0}, {n + 1, n > 1 ? 1 : 0, 1, 0}};
  fill_layers(g, field, c, inner);
  if (layers == GhostLayers::both) fill_layers(g, field, c, outer);
}

void fill_centred_at_walls(const StaggeredGrid& g, double* field, int c, double low_sign, double high_sign,
                           double high_offset, GhostLayers layers) noexcept {
  const int n = g.cells[c];
  const Image inner[] = {{-1, 0, low_sign, 0}, {n, n - 1, high_sign, high_offset}};
  const Image outer[] = {{-2, 1, low_sign, 0}, {n + 1, n - 2, high_sign, high_offset}};
  fill_layers(g, field, c, inner);
  if (layers == GhostLayers::both) fill_layers(g, field, c, outer);
}

void fill_normal_at_walls(const StaggeredGrid& g, double* field, int c) noexcept {
  const int n = g.cells[c];
  const Image images[] = {{0, 0, 0, 0}, {n, n, 0, 0}, {-1, 1, -1, 0}, {n + 1, n - 1, -1, 0}, {-2, 2, -1, 0}};
  fill_layers(g, field, c, images);
}

}   // namespace

void fill_velocity_ghosts(const StaggeredGrid& g, FaceFields& velocity, double lid_speed, GhostLayers layers) {
  for (int component = 0; component < 3; ++component)
    for (int c = 0; c < 3; ++c) {
      double* u = velocity.component(component);
      const bool slips = c == 2 && g.top == Top::free_slip;
      const double top_speed = c == 2 && component == 0 && !slips ? lid_speed : 0;
      if (g.periodic(c)) fill_periodic(g, u, c, layers);
      else if (component == c) fill_normal_at_walls(g, u, c);
      else fill_centred_at_walls(g, u, c, -1, slips ? 1 : -1, 2 * top_speed, layers);
    }
}

void fill_centre_ghosts(const StaggeredGrid& g, Field<Centre>& field) {
  for (int c = 0; c < 3; ++c) {
    if (g.periodic(c)) fill_periodic(g, field.data(), c, GhostLayers::both);
    else fill_centred_at_walls(g, field.data(), c, 1, 1, 0, GhostLayers::both);
  }
}

void fill_face_ghosts(const StaggeredGrid& g, FaceFields& field, GhostLayers layers) {
  for (int component = 0; component < 3; ++component)
    for (int c = 0; c < 3; ++c)
      if (g.periodic(c)) fill_periodic(g, field.component(component), c, layers);
}

void close_faces(const StaggeredGrid& g, FaceFields& field) noexcept {
  for (int c = 0; c < 3; ++c) {
    if (!g.periodic(c)) continue;
    double* const f = field.component(c);
    const std::ptrdiff_t to_last = g.cells[c] * g.stride(c);
    for (int i = 0; i < (c == 0 ? 1 : g.cells[0]); ++i)
      for (int j = 0; j < (c == 1 ? 1 : g.cells[1]); ++j) {
        double* const row = f + g.index(i, j, 0);
        std::copy_n(row, c == 2 ? 1 : g.cells[2], row + to_last);
      }
  }
}

}   // namespace bedload

// Each ghost layer is an affine image of a layer inside: copied, reflected, or reflected about a moving wall.
#include "solver/fluid/boundaries.hpp"

namespace bedload {
namespace {

struct Image {
  int ghost, source;   // layers along the direction
  double sign, offset;
};

void fill_layer(const StaggeredGrid& g, double* field, int direction, Image image) noexcept {
  const std::ptrdiff_t step = g.stride(direction), reach = (image.source - image.ghost) * step;
  const int a = direction == 0 ? 1 : 0, b = direction == 2 ? 1 : 2;
  double* layer = field + (image.ghost + StaggeredGrid::ghosts) * step;
  for (int m = 0; m < g.cells[a] + 2 * StaggeredGrid::ghosts; ++m)
    for (int n = 0; n < g.cells[b] + 2 * StaggeredGrid::ghosts; ++n) {
      double* ghost = layer + m * g.stride(a) + n * g.stride(b);
      *ghost = image.sign == 0 ? 0.0 : image.offset + image.sign * ghost[reach];
    }
}

void fill_periodic(const StaggeredGrid& g, double* field, int c) noexcept {
  const int n = g.cells[c];
  for (int ghost : {-1, n, -2, n + 1}) fill_layer(g, field, c, {ghost, ((ghost % n) + n) % n, 1, 0});
}

/// Inner layers before outer ones, so that a box one cell wide reflects its own reflections.
void fill_centred_at_walls(const StaggeredGrid& g, double* field, int c, double sign, double low, double high,
                           double high_sign) noexcept {
  const int n = g.cells[c];
  fill_layer(g, field, c, {-1, 0, sign, low});
  fill_layer(g, field, c, {n, n - 1, high_sign, high});
  fill_layer(g, field, c, {-2, 1, sign, low});
  fill_layer(g, field, c, {n + 1, n - 2, high_sign, high});
}

void fill_normal_at_walls(const StaggeredGrid& g, double* field, int c) noexcept {
  const int n = g.cells[c];
  fill_layer(g, field, c, {0, 0, 0, 0});
  fill_layer(g, field, c, {n, n, 0, 0});
  fill_layer(g, field, c, {-1, 1, -1, 0});
  fill_layer(g, field, c, {n + 1, n - 1, -1, 0});
  fill_layer(g, field, c, {-2, 2, -1, 0});
}

}   // namespace

void fill_velocity_ghosts(const StaggeredGrid& g, FaceFields& velocity, double lid_speed) {
  for (int component = 0; component < 3; ++component)
    for (int c = 0; c < 3; ++c) {
      double* u = velocity.component(component);
      const bool slips = c == 2 && g.top == Top::free_slip;
      const double top_speed = c == 2 && component == 0 && !slips ? lid_speed : 0;
      if (g.periodic(c)) fill_periodic(g, u, c);
      else if (component == c) fill_normal_at_walls(g, u, c);
      else fill_centred_at_walls(g, u, c, -1, 0, 2 * top_speed, slips ? 1 : -1);
    }
}

void fill_centre_ghosts(const StaggeredGrid& g, Field<Centre>& field) {
  for (int c = 0; c < 3; ++c) {
    if (g.periodic(c)) fill_periodic(g, field.data(), c);
    else fill_centred_at_walls(g, field.data(), c, 1, 0, 0, 1);
  }
}

void fill_face_ghosts(const StaggeredGrid& g, FaceFields& field) {
  for (int component = 0; component < 3; ++component)
    for (int c = 0; c < 3; ++c)
      if (g.periodic(c)) fill_periodic(g, field.component(component), c);
}

}   // namespace bedload

// The kernel that joins grains and grid: quadratic B-splines on cells, hat along the normal x B-spline across on faces.
//
// The derivative of the quadratic B-spline of a cell is the difference of the hats of its two faces. So the void fraction
// on cells, and the flux of solid on faces, satisfy d(phi)/dt + div J = 0 identically (docs/physics_coupling.md).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "solver/fluid/staggered_grid.hpp"

namespace bedload {

/// Weights of the three cells around `offset`, the distance from the middle one's centre in cell edges (|offset| <= 1/2).
constexpr std::array<double, 3> quadratic_spline(double offset) noexcept {
  const double l = 0.5 - offset, r = 0.5 + offset;
  return {0.5 * l * l, 0.75 - offset * offset, 0.5 * r * r};
}

/// Where one grain touches the grid: weights and padded offsets per direction. Beyond a wall the spline is folded back
/// into the box (the same sign), so weights always sum to one; hats next to a wall may fall on the wall's own face.
struct Stencil {
  double cell[3][3];
  double face[3][2];
  std::int32_t cell_offset[3][3];
  std::int32_t face_offset[3][2];

  Stencil() = default;
  Stencil(const StaggeredGrid& grid, Vec3 position) noexcept {
    for (int c = 0; c < 3; ++c) {
      const int n = grid.cells[c];
      const double s = position[c] / grid.h[c];
      const int i = std::clamp(static_cast<int>(std::floor(s)), 0, n - 1);
      const double f = s - i;
      const auto b = quadratic_spline(f - 0.5);
      const auto stride = static_cast<std::int32_t>(grid.stride(c));
      for (int m = 0; m < 3; ++m) cell[c][m] = b[m], cell_offset[c][m] = place_cell(grid, c, i + m - 1) * stride;
      face[c][0] = 1 - f, face[c][1] = f;
      for (int m = 0; m < 2; ++m) face_offset[c][m] = place_face(grid, c, i + m) * stride;
    }
  }

  /// Padded cell number in direction c, wrapped or folded.
  static int place_cell(const StaggeredGrid& g, int c, int i) noexcept {
    const int n = g.cells[c];
    if (g.periodic(c)) i = (i + 2 * n) % n;
    return std::clamp(i, 0, n - 1) + StaggeredGrid::ghosts;
  }
  /// Padded face number; the last wall keeps its own face n.
  static int place_face(const StaggeredGrid& g, int c, int i) noexcept {
    const int n = g.cells[c];
    return (g.periodic(c) ? (i + 2 * n) % n : i) + StaggeredGrid::ghosts;
  }
};

/// Calls visit(padded index, weight) for the 27 cells of a grain.
template <class Visit>
inline void for_each_cell(const Stencil& s, Visit&& visit) noexcept {
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) {
      const double w = s.cell[0][a] * s.cell[1][b];
      const std::int32_t at = s.cell_offset[0][a] + s.cell_offset[1][b];
      for (int c = 0; c < 3; ++c) visit(at + s.cell_offset[2][c], w * s.cell[2][c]);
    }
}

/// Calls visit(padded index, weight) for the 18 faces normal to direction C of a grain.
template <int C, class Visit>
inline void for_each_face(const Stencil& s, Visit&& visit) noexcept {
  constexpr int D = (C + 1) % 3 < (C + 2) % 3 ? (C + 1) % 3 : (C + 2) % 3, E = 3 - C - D;   // D < E: E is contiguous or nearest to it
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 3; ++b) {
      const double w = s.face[C][a] * s.cell[D][b];
      const std::int32_t at = s.face_offset[C][a] + s.cell_offset[D][b];
      for (int c = 0; c < 3; ++c) visit(at + s.cell_offset[E][c], w * s.cell[E][c]);
    }
}

/// Value of a face field at a grain: one component per direction of the faces.
inline Vec3 sample(const Stencil& s, const FaceFields& f) noexcept {
  Vec3 value;
  const double *x = f.component(0), *y = f.component(1), *z = f.component(2);
  for_each_face<0>(s, [&](std::int32_t n, double w) { value.x += w * x[n]; });
  for_each_face<1>(s, [&](std::int32_t n, double w) { value.y += w * y[n]; });
  for_each_face<2>(s, [&](std::int32_t n, double w) { value.z += w * z[n]; });
  return value;
}

/// Value of a centre field at a grain.
inline double sample(const Stencil& s, const Field<Centre>& f) noexcept {
  double value = 0;
  for_each_cell(s, [&](std::int32_t n, double w) { value += w * f[n]; });
  return value;
}

/// Adds `amount`, spread with the same weights, to a face field: the transpose of sample.
inline void deposit(const Stencil& s, Vec3 amount, FaceFields& f) noexcept {
  double *x = f.component(0), *y = f.component(1), *z = f.component(2);
  for_each_face<0>(s, [&](std::int32_t n, double w) { x[n] += w * amount.x; });
  for_each_face<1>(s, [&](std::int32_t n, double w) { y[n] += w * amount.y; });
  for_each_face<2>(s, [&](std::int32_t n, double w) { z[n] += w * amount.z; });
}

}  // namespace bedload

// The kernel that joins grains and grid: quadratic B-splines on cells, hat along the normal x B-spline across on faces.
//
// The derivative of the quadratic B-spline of a cell is the difference of the hats of its two faces. So the void fraction
// on cells, and the flux of solid on faces, satisfy d(phi)/dt + div J = 0 identically (docs/physics_coupling.md).
//
// A grain writes to and reads from up to one layer of ghosts, as if the box went on: fold_deposits brings what was written
// there home (round the period, or reflected at a wall), extend_samples fills it for reading: the transpose.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "solver/fluid/staggered_grid.hpp"

namespace bedload {

/// Four neighbours along z.
using Row = double __attribute__((vector_size(32)));

inline Row load_row(const double* p) noexcept {
  Row r;
  std::memcpy(&r, p, sizeof r);
  return r;
}
inline void add_row(double* p, Row r) noexcept {
  const Row sum = load_row(p) + r;
  std::memcpy(p, &sum, sizeof sum);
}
inline double sum_of(Row r) noexcept { return (r[0] + r[1]) + (r[2] + r[3]); }

struct Strides {
  explicit Strides(const StaggeredGrid& g) : x(g.stride(0)), y(g.stride(1)) {}
  std::ptrdiff_t x, y;
};

/// Weights of the three cells around `offset`, the distance from the middle one's centre in cell edges (|offset| <= 1/2).
constexpr std::array<double, 3> quadratic_spline(double offset) noexcept {
  const double l = 0.5 - offset, r = 0.5 + offset;
  return {0.5 * l * l, 0.75 - offset * offset, 0.5 * r * r};
}

/// The cell of a box of n cells in which s [cell edges] lies.
inline int cell_of(double s, int n) noexcept { return std::clamp(static_cast<int>(std::floor(s)), 0, n - 1); }

/// One grain's weights around its cell i, j, k: of cells i-1..i+1, of faces i and i+1, and so on; along z as rows k-1..k+2.
struct Stencil {
  double cell_x[3], cell_y[3], face_x[2], face_y[2];
  Row cell_z, face_z;
  std::ptrdiff_t corner;   // padded index of cell i-1, j-1, k-1

  Stencil() = default;
  Stencil(const StaggeredGrid& grid, Vec3 position) noexcept {
    const Vec3 s{position.x / grid.h.x, position.y / grid.h.y, position.z / grid.h.z};
    const int i = cell_of(s.x, grid.cells[0]), j = cell_of(s.y, grid.cells[1]), k = cell_of(s.z, grid.cells[2]);
    const Vec3 f{s.x - i, s.y - j, s.z - k};
    const auto x = quadratic_spline(f.x - 0.5), y = quadratic_spline(f.y - 0.5), z = quadratic_spline(f.z - 0.5);
    std::copy(x.begin(), x.end(), cell_x);
    std::copy(y.begin(), y.end(), cell_y);
    cell_z = Row{z[0], z[1], z[2], 0};
    face_x[0] = 1 - f.x, face_x[1] = f.x;
    face_y[0] = 1 - f.y, face_y[1] = f.y;
    face_z = Row{0, 1 - f.z, f.z, 0};
    corner = static_cast<std::ptrdiff_t>(grid.index(i - 1, j - 1, k - 1));
  }
};

/// Places a field can live: faces normal to x, y, z, cells, or edges along x, y, z.
enum Place : int {
  on_x_faces = 0,
  on_y_faces = 1,
  on_z_faces = 2,
  on_cells = 3,
  on_x_edges = 4,
  on_y_edges,
  on_z_edges
};

/// Whether a place has the hat along a direction, and lies on the lower faces of cells there; else it has the spline.
constexpr bool has_hat(int place, int direction) noexcept {
  return place < on_cells ? place == direction : place > on_cells && place - on_x_edges != direction;
}

/// Calls visit(padded index of the row's first entry, weight across the row) for each row of z-neighbours of a grain.
template <Place P, class Visit>
inline void for_each_row(const Stencil& s, Strides stride, Visit&& visit) noexcept {
  constexpr int nx = has_hat(P, 0) ? 2 : 3, ny = has_hat(P, 1) ? 2 : 3;
  const double* wx = has_hat(P, 0) ? s.face_x : s.cell_x;
  const double* wy = has_hat(P, 1) ? s.face_y : s.cell_y;
  for (int a = 0; a < nx; ++a)
    for (int b = 0; b < ny; ++b) visit(s.corner + (a + 3 - nx) * stride.x + (b + 3 - ny) * stride.y, wx[a] * wy[b]);
}

template <Place P>
inline Row row_weights(const Stencil& s) noexcept {
  return has_hat(P, 2) ? s.face_z : s.cell_z;
}

/// Value of one field at a grain.
template <Place P>
inline double sample(const Stencil& s, Strides stride, const double* field) noexcept {
  Row sum{};
  for_each_row<P>(s, stride, [&](std::ptrdiff_t n, double w) { sum += w * load_row(field + n); });
  return sum_of(sum * row_weights<P>(s));
}

/// Adds `amount` to one field with the same weights.
template <Place P>
inline void deposit(const Stencil& s, Strides stride, double amount, double* field) noexcept {
  const Row along = amount * row_weights<P>(s);
  for_each_row<P>(s, stride, [&](std::ptrdiff_t n, double w) { add_row(field + n, w * along); });
}

/// Value of a face field at a grain, one component per direction of the faces. Ghosts by extend_samples.
inline Vec3 sample(const Stencil& s, Strides stride, const FaceFields& f) noexcept {
  return {sample<on_x_faces>(s, stride, f.component(0)), sample<on_y_faces>(s, stride, f.component(1)),
          sample<on_z_faces>(s, stride, f.component(2))};
}

/// Adds `amount` to a face field: the transpose of sample. Ghosts go home by fold_deposits.
inline void deposit(const Stencil& s, Strides stride, Vec3 amount, FaceFields& f) noexcept {
  deposit<on_x_faces>(s, stride, amount.x, f.component(0));
  deposit<on_y_faces>(s, stride, amount.y, f.component(1));
  deposit<on_z_faces>(s, stride, amount.z, f.component(2));
}

/// The same on edges: component t of the field is that on edges along t, at the lower corner of the other two directions.
inline Vec3 sample_edges(const Stencil& s, Strides stride, const FaceFields& f) noexcept {
  return {sample<on_x_edges>(s, stride, f.component(0)), sample<on_y_edges>(s, stride, f.component(1)),
          sample<on_z_edges>(s, stride, f.component(2))};
}
inline void deposit_on_edges(const Stencil& s, Strides stride, Vec3 amount, FaceFields& f) noexcept {
  deposit<on_x_edges>(s, stride, amount.x, f.component(0));
  deposit<on_y_edges>(s, stride, amount.y, f.component(1));
  deposit<on_z_edges>(s, stride, amount.z, f.component(2));
}

/// Fills the ghosts that grains read: periodic copies; reflected at walls with the same sign (faces on a wall keep their own value).
void extend_samples(const StaggeredGrid&, FaceFields&);
void extend_samples(const StaggeredGrid&, Field<Centre>&);
void extend_edge_samples(const StaggeredGrid&, FaceFields& on_edges);

/// Adds what grains wrote into ghosts to the cells and faces they stand for, and clears the ghosts.
void fold_deposits(const StaggeredGrid&, FaceFields&);
void fold_deposits(const StaggeredGrid&, Field<Centre>&);
void fold_edge_deposits(const StaggeredGrid&, FaceFields& on_edges);

/// Zero everywhere, ghosts too: before a deposit.
inline void clear(FaceFields& f, double value = 0) {
  for (int c = 0; c < 3; ++c) std::fill_n(f.component(c), f.x.values.size(), value);
}
inline void clear(Field<Centre>& f, double value = 0) { std::fill(f.values.begin(), f.values.end(), value); }

}   // namespace bedload

// The kernel that joins grains and grid: quadratic B-splines on cells, hat along the normal x B-spline across on faces.
//
// The derivative of the quadratic B-spline of a cell is the difference of the hats of its two faces. So the void fraction
// on cells, and the flux of solid on faces, satisfy d(phi)/dt + div J = 0 identically (docs/physics_coupling.md).
//
// Grains read and write woven fields (woven.hpp): what belongs to one cell, its lower faces towards -x, -y, -z and its
// middle, side by side in one vector. The weights are vectors too, one per plane of cells and direction.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "solver/coupling/quad.hpp"
#include "solver/fluid/staggered_grid.hpp"

namespace bedload {

struct Strides {
  explicit Strides(const StaggeredGrid& g) : x(g.stride(0)), y(g.stride(1)) {}
  std::ptrdiff_t x, y;
};

/// Weights of the three cells around `offset`, the distance from the middle one's centre in cell edges (|offset| <= 1/2).
template <class Real>
constexpr std::array<Real, 3> quadratic_spline(Real offset) noexcept {
  const Real l = 0.5 - offset, r = 0.5 + offset;
  return {0.5 * l * l, 0.75 - offset * offset, 0.5 * r * r};
}

/// The cell of a box of n cells in which s [cell edges] lies.
inline int cell_of(double s, int n) noexcept { return std::clamp(static_cast<int>(std::floor(s)), 0, n - 1); }

/// A box of planes of cells, [first, last) in each direction, ghosts included.
struct Reach {
  std::array<int, 3> first{}, last{};
  bool empty() const { return first[0] >= last[0]; }
  bool operator==(const Reach&) const = default;
};

/// Finds cells, all directions at once; the fourth entry follows z.
class CellFinder {
 public:
  explicit CellFinder(const StaggeredGrid& g)
      : edges_(quad(g.h)),
        highest_(quad(Vec3{g.cells[0] - 1.0, g.cells[1] - 1.0, g.cells[2] - 1.0})),
        strides_(g),
        lowest_corner_(static_cast<std::ptrdiff_t>(g.index(-1, -1, -1))) {}

  Quad edges() const noexcept { return edges_; }
  Quad highest() const noexcept { return highest_; }
  /// In cell edges.
  Quad scaled(Vec3 place) const noexcept { return quad(place) / edges_; }
  /// The number of the cell in which a scaled place lies.
  Quad cell_of(Quad scaled_place) const noexcept {
    const Quad down = floor_of(scaled_place), none{};
    const Quad inside = down > none ? down : none;
    return inside < highest_ ? inside : highest_;
  }
  /// The padded index of cell i-1, j-1, k-1.
  std::ptrdiff_t corner_of(Quad cell) const noexcept {
    const auto whole = [cell](int c) { return static_cast<std::ptrdiff_t>(cell[c]); };
    return lowest_corner_ + whole(0) * strides_.x + whole(1) * strides_.y + whole(2);
  }

 private:
  Quad edges_, highest_;
  Strides strides_;
  std::ptrdiff_t lowest_corner_;
};

/// Where a grain stands: how far in its cell i, j, k, of edges, and the padded index of cell i-1, j-1, k-1.
struct Stencil {
  Vec3 fraction;
  std::ptrdiff_t corner;

  Stencil() = default;
  Stencil(const StaggeredGrid& grid, Vec3 position) noexcept {
    std::array<int, 3> cell;
    *this = Stencil(grid, position, cell);
  }
  Stencil(const StaggeredGrid& grid, Vec3 position, std::array<int, 3>& cell) noexcept {
    for (int c = 0; c < 3; ++c) {
      const double s = position[c] / grid.h[c];
      cell[c] = cell_of(s, grid.cells[c]);
      fraction[c] = s - cell[c];
    }
    corner = static_cast<std::ptrdiff_t>(grid.index(cell[0] - 1, cell[1] - 1, cell[2] - 1));
  }
};

/// The stencils of all grains, by id, and the box of cells that they reach; whole where it meets a seam.
struct Stencils {
  std::vector<Stencil> of;
  Reach reach;

  const Stencil& operator[](std::size_t p) const { return of[p]; }
  std::size_t size() const { return of.size(); }
  bool empty() const { return of.empty(); }
  auto begin() const { return of.begin(); }
  auto end() const { return of.end(); }
};
inline const Stencils no_stencils;

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

/// Where the entries of a Quad live: faces normal to x, y, z and the cell, or edges along x, y, z (the last has no meaning).
enum class On : int { faces = on_x_faces, edges = on_x_edges };
constexpr bool has_hat(On where, int entry, int direction) noexcept {
  return has_hat(static_cast<int>(where) + entry, direction);
}

/// One grain's weights, by direction and plane of cells.
template <On where = On::faces>
struct Weights {
  Quad x[3], y[3], z[3];

  explicit Weights(const Stencil& s) noexcept {
    const Quad f = quad(s.fraction), none{};
    const auto spline = quadratic_spline(f - 0.5);
    const Quad hat[3] = {none, 1 - f, f};
    for (int m = 0; m < 3; ++m) {
      x[m] = chosen<0>(spline[m], hat[m]);
      y[m] = chosen<1>(spline[m], hat[m]);
      z[m] = chosen<2>(spline[m], hat[m]);
    }
  }

 private:
  /// Of weights by direction, those of one direction: for each entry the hat's or the spline's.
  template <int direction>
  static Quad chosen(Quad spline, Quad hat) noexcept {
    constexpr auto from = [](int entry) { return direction + (has_hat(where, entry, direction) ? 4 : 0); };
    return __builtin_shuffle(spline, hat, QuadMask{from(0), from(1), from(2), from(3)});
  }
};

/// What a grain reads of a woven field, `at` its corner.
template <On where>
inline Quad sample(const Weights<where>& w, Strides stride, const Quad* at) noexcept {
  Quad sum{};
  for (int a = 0; a < 3; ++a) {
    Quad plane{};
    for (int b = 0; b < 3; ++b) {
      const Quad* cell = at + a * stride.x + b * stride.y;
      const Quad line = fused(w.z[2], cell[2], fused(w.z[1], cell[1], w.z[0] * cell[0]));
      plane = fused(w.y[b], line, plane);
    }
    sum = fused(w.x[a], plane, sum);
  }
  return sum;
}

/// Adds `amount` with the same weights: the transpose of sample.
template <On where>
inline void deposit(const Weights<where>& w, Strides stride, Quad amount, Quad* at) noexcept {
  for (int a = 0; a < 3; ++a) {
    const Quad plane = amount * w.x[a];
    for (int b = 0; b < 3; ++b) {
      const Quad line = plane * w.y[b];
      Quad* cell = at + a * stride.x + b * stride.y;
      for (int c = 0; c < 3; ++c) cell[c] = fused(line, w.z[c], cell[c]);
    }
  }
}

}   // namespace bedload

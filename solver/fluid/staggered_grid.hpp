// The staggered (Arakawa C) grid: where every number of the flow lives, and how it is indexed.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "base/vec3.hpp"
#include "solver/sides.hpp"

namespace bedload {

/// A box of nx x ny x nz cells of edges h. All fields share one padded shape (two ghost layers on every
/// side), z fastest, so that one index and three strides serve every field:
///   Centre (i,j,k) is the middle of cell i,j,k; FaceX (i,j,k) is that cell's face towards -x, FaceY -y, FaceZ -z.
/// Faces normal to a direction run 0..n: between walls 0 and n lie on the walls; in a periodic direction n is 0 again.
struct StaggeredGrid {
  static constexpr int ghosts = 2;

  std::array<int, 3> cells{};    // nx, ny, nz
  Vec3 h;                        // cell edges [m]
  std::array<Side, 3> sides{};   // in x, y, z
  Top top = Top::lid;            // read only when sides[2] is wall

  std::ptrdiff_t stride(int c) const {
    const std::ptrdiff_t sy = cells[2] + 2 * ghosts;
    return c == 2 ? 1 : c == 1 ? sy : sy * (cells[1] + 2 * ghosts);
  }
  std::size_t padded_size() const { return static_cast<std::size_t>(stride(0)) * (cells[0] + 2 * ghosts); }
  std::size_t cell_count() const { return std::size_t(cells[0]) * cells[1] * cells[2]; }
  std::size_t index(int i, int j, int k) const {
    return (std::size_t(i + ghosts) * (cells[1] + 2 * ghosts) + (j + ghosts)) * (cells[2] + 2 * ghosts) + (k + ghosts);
  }
  double cell_volume() const { return h.x * h.y * h.z; }
  Vec3 length() const { return {cells[0] * h.x, cells[1] * h.y, cells[2] * h.z}; }
  bool periodic(int c) const { return sides[c] == Side::periodic; }
  /// First unknown face normal to c (walls are not unknowns); the last is cells[c]-1 in both cases.
  int first_face(int c) const { return periodic(c) ? 0 : 1; }
  bool operator==(const StaggeredGrid&) const = default;
};

struct Centre {};
struct FaceX {};
struct FaceY {};
struct FaceZ {};

/// Values of one quantity at one place of the grid, ghosts included. A field in the wrong place does not compile.
template <class Where>
struct Field {
  Field() = default;
  explicit Field(const StaggeredGrid& g, double value = 0) : cells(g.cells), values(g.padded_size(), value) {}

  double& operator[](std::size_t n) { return values[n]; }
  double operator[](std::size_t n) const { return values[n]; }
  double* data() { return values.data(); }
  const double* data() const { return values.data(); }
  bool operator==(const Field&) const = default;

  std::array<int, 3> cells{};   // interior shape; what a checkpoint holds
  std::vector<double> values;   // padded
};

/// One field per face direction: velocity [m/s], flux, face coefficient.
struct FaceFields {
  FaceFields() = default;
  explicit FaceFields(const StaggeredGrid& g, double value = 0) : x(g, value), y(g, value), z(g, value) {}
  double* component(int c) { return c == 0 ? x.data() : c == 1 ? y.data() : z.data(); }
  const double* component(int c) const { return c == 0 ? x.data() : c == 1 ? y.data() : z.data(); }
  bool operator==(const FaceFields&) const = default;

  Field<FaceX> x;
  Field<FaceY> y;
  Field<FaceZ> z;
};

}   // namespace bedload

// Loops over the unknown faces, in plane order, and sums whose order does not depend on how the box is divided.
#pragma once

#include "solver/fluid/rows.hpp"

namespace bedload {

/// Calls visit(padded index) for every unknown face normal to direction c: x planes outermost, z innermost.
template <class Visit>
inline void for_each_unknown_face(const StaggeredGrid& g, int c, Visit&& visit) noexcept {
  for_each_face_row(g, c, [&](std::size_t row, int length) {
    for (std::size_t n = row; n < row + length; ++n) visit(n);
  });
}

/// Sum of value(padded index) over the unknown faces normal to c: one partial sum per x-plane, added in plane order.
template <class Value>
inline double sum_over_faces(const StaggeredGrid& g, int c, Value&& value) noexcept {
  const int k = c == 2 ? g.first_face(2) : 0;
  double total = 0;
  for (int i = c == 0 ? g.first_face(0) : 0; i < g.cells[0]; ++i) {
    LaneSum plane;
    for (int j = c == 1 ? g.first_face(1) : 0; j < g.cells[1]; ++j) {
      const std::size_t row = g.index(i, j, k);
      plane.add_row(g.cells[2] - k, [&](int m) { return value(row + m); });
    }
    total += plane.value();
  }
  return total;
}

/// Zero on the faces that lie on walls: no flux passes there.
inline void clear_walls(const StaggeredGrid& g, FaceFields& f) noexcept {
  for (int c = 0; c < 3; ++c) {
    if (g.periodic(c)) continue;
    double* const v = f.component(c);
    for (int i = 0; i <= (c == 0 ? 1 : g.cells[0] - 1); ++i)
      for (int j = 0; j <= (c == 1 ? 1 : g.cells[1] - 1); ++j)
        for (int k = 0; k <= (c == 2 ? 1 : g.cells[2] - 1); ++k)
          v[g.index(c == 0 ? i * g.cells[0] : i, c == 1 ? j * g.cells[1] : j, c == 2 ? k * g.cells[2] : k)] = 0;
  }
}

}   // namespace bedload

// Loops over the grid in rows along z, the contiguous direction, and sums whose order never depends on the machine.
#pragma once

#include <algorithm>

#include "solver/fluid/staggered_grid.hpp"

namespace bedload {

/// Visits the rows of cells of x-plane i as body(first index, length).
template <class Body>
void for_each_cell_row_of_plane(const StaggeredGrid& g, int i, Body&& body) {
  for (int j = 0; j < g.cells[1]; ++j) body(g.index(i, j, 0), g.cells[2]);
}

/// Visits every row of cells, plane by plane in x.
template <class Body>
void for_each_cell_row(const StaggeredGrid& g, Body&& body) {
  for (int i = 0; i < g.cells[0]; ++i) for_each_cell_row_of_plane(g, i, body);
}

/// Visits the rows of unknown faces normal to c in x-plane i.
template <class Body>
void for_each_face_row_of_plane(const StaggeredGrid& g, int c, int i, Body&& body) {
  if (c == 0 && i < g.first_face(0)) return;
  const int k = c == 2 ? g.first_face(2) : 0;
  for (int j = c == 1 ? g.first_face(1) : 0; j < g.cells[1]; ++j) body(g.index(i, j, k), g.cells[2] - k);
}

/// Visits every row of unknown faces normal to c.
template <class Body>
void for_each_face_row(const StaggeredGrid& g, int c, Body&& body) {
  for (int i = 0; i < g.cells[0]; ++i) for_each_face_row_of_plane(g, c, i, body);
}

/// Visits every row of edges along t as body(first index, length, i, j), the planes 0 and n of the other directions included:
/// edges on a seam are visited on both of its sides.
template <class Body>
void for_each_edge_row(const StaggeredGrid& g, int t, Body&& body) {
  for (int i = 0; i < g.cells[0] + (t != 0); ++i)
    for (int j = 0; j < g.cells[1] + (t != 1); ++j) body(g.index(i, j, 0), g.cells[2] + (t != 2), i, j);
}

/// A sum kept in eight lanes by position in the row: vectorises, and gives the same bits whatever the vector width.
class LaneSum {
 public:
  template <class Term>
  void add_row(int length, Term&& term) noexcept {
    double lanes[8];   // not the members: what may be elsewhere than in registers does not vectorise
    std::copy_n(lanes_, 8, lanes);
    int k = 0;
    for (; k + 8 <= length; k += 8)
      for (int lane = 0; lane < 8; ++lane) lanes[lane] += term(k + lane);
    for (int lane = 0; k < length; ++k, ++lane) lanes[lane] += term(k);
    std::copy_n(lanes, 8, lanes_);
  }
  double value() const noexcept {
    return ((lanes_[0] + lanes_[4]) + (lanes_[1] + lanes_[5])) + ((lanes_[2] + lanes_[6]) + (lanes_[3] + lanes_[7]));
  }

 private:
  double lanes_[8] = {};
};

/// The largest of what is not a NaN, at least zero, in lanes that vectorise.
class LaneMax {
 public:
  template <class Term>
  void add_row(int length, Term&& term) noexcept {
    FourDoubles low = low_, high = high_;   // asked for by name: compilers take such choices one by one
    double found[8];
    int k = 0;
    for (; k + 8 <= length; k += 8) {
      for (int lane = 0; lane < 8; ++lane) found[lane] = term(k + lane);
      low = larger(FourDoubles{found[0], found[1], found[2], found[3]}, low);
      high = larger(FourDoubles{found[4], found[5], found[6], found[7]}, high);
    }
    for (; k < length; ++k) low = larger(FourDoubles{term(k)}, low);
    low_ = low, high_ = high;
  }
  double value() const noexcept {
    const FourDoubles four = larger(high_, low_);
    return std::max(std::max(four[0], four[1]), std::max(four[2], four[3]));
  }

 private:
  typedef double FourDoubles __attribute__((vector_size(32)));
  static FourDoubles larger(FourDoubles value, FourDoubles than) noexcept { return value > than ? value : than; }

  FourDoubles low_{}, high_{};
};

/// Partial sums of x-planes, found in any order, added in plane order.
class PlaneSums {
 public:
  explicit PlaneSums(int planes) : partial_(planes) {}
  double& operator[](int plane) { return partial_[plane]; }
  double value() const noexcept {
    double total = 0;
    for (double plane : partial_) total += plane;
    return total;
  }

 private:
  std::vector<double> partial_;
};

/// Sum over all cells of term(index): one partial sum per x-plane, added in plane order.
template <class Term>
double sum_over_cells(const StaggeredGrid& g, Term&& term) {
  double total = 0;
  for (int i = 0; i < g.cells[0]; ++i) {
    LaneSum plane;
    for (int j = 0; j < g.cells[1]; ++j) {
      const std::size_t row = g.index(i, j, 0);
      plane.add_row(g.cells[2], [&](int k) { return term(row + k); });
    }
    total += plane.value();
  }
  return total;
}

}   // namespace bedload

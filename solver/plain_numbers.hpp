// A field of State as the outside sees it: plain numbers in a row, and a shape.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "base/vec3.hpp"
#include "solver/fluid/staggered_grid.hpp"

namespace bedload {

/// Extents, slowest first; empty for a single number.
using ShapeView = std::span<const std::uint64_t>;

/// The interior of a field as [nx][ny][nz]. Ghosts stay behind: they follow from the interior and the sides of the box.
template <class Where>
std::vector<double> interior(const Field<Where>& field) {
  const StaggeredGrid grid{.cells = field.cells};
  std::vector<double> row;
  row.reserve(grid.cell_count());
  for (int i = 0; i < grid.cells[0]; ++i)
    for (int j = 0; j < grid.cells[1]; ++j) {
      const double* line = field.data() + grid.index(i, j, 0);
      row.insert(row.end(), line, line + grid.cells[2]);
    }
  return row;
}

/// The inverse of interior(): a padded field whose ghosts are zero.
template <class Where>
void set_interior(Field<Where>& field, std::array<int, 3> cells, std::span<const double> row) {
  const StaggeredGrid grid{.cells = cells};
  field = Field<Where>();
  field.cells = cells;
  if (grid.cell_count() == 0) return;
  field.values.resize(grid.padded_size());
  const double* from = row.data();
  for (int i = 0; i < cells[0]; ++i)
    for (int j = 0; j < cells[1]; ++j, from += cells[2])
      std::copy_n(from, cells[2], field.data() + grid.index(i, j, 0));
}

/// as_numbers(field, use) calls use(span of numbers, shape); the span lives as long as the call.
template <class Number, class Use>
requires std::is_arithmetic_v<Number>
void as_numbers(const Number& number, Use&& use) { use(std::span<const Number>(&number, 1), ShapeView()); }

template <class Number, class Use>
void as_numbers(const std::vector<Number>& numbers, Use&& use) {
  const std::array<std::uint64_t, 1> shape{numbers.size()};
  use(std::span<const Number>(numbers), ShapeView(shape));
}

/// Vectors in space are [n][3].
template <class Use>
void as_numbers(const std::vector<Vec3>& vectors, Use&& use) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double) && std::is_standard_layout_v<Vec3>);
  const std::array<std::uint64_t, 2> shape{vectors.size(), 3};
  use(std::span<const double>(reinterpret_cast<const double*>(vectors.data()), 3 * vectors.size()), ShapeView(shape));
}

template <class Where, class Use>
void as_numbers(const Field<Where>& field, Use&& use) {
  const std::array<std::uint64_t, 3> shape{std::uint64_t(field.cells[0]), std::uint64_t(field.cells[1]),
                                           std::uint64_t(field.cells[2])};
  const std::vector<double> row = interior(field);
  use(std::span<const double>(row), ShapeView(shape));
}

}   // namespace bedload

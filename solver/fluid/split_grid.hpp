// Where cells stand whose rows along z are kept as their even cells followed by their odd cells.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace bedload {

enum Colour { red = 0, black = 1 };

/// x-planes of y-rows of cells with one ghost layer. The cells of one colour of a row are contiguous, and every neighbour
/// of theirs too. Arrays have size() numbers, zero where no cell stands.
class SplitGrid {
 public:
  SplitGrid(std::array<int, 3> n, std::array<bool, 3> periodic) : cells(n) {
    for (int c = 0; c < 3; ++c) {
      wraps[c] = periodic[c] && cells[c] > 1;
      seam = seam || (wraps[c] && cells[c] % 2 == 1);
    }
    half = padded((cells[2] + 1) / 2) + 2;
  }

  int cell_count() const { return cells[0] * cells[1] * cells[2]; }
  std::size_t row(int i, int j) const { return (std::size_t(i + 1) * (cells[1] + 2) + (j + 1)) * 2 * half; }
  std::size_t at(int i, int j, int k) const { return row(i, j) + (k & 1) * half + ((k + 2) >> 1); }
  std::size_t size() const { return row(cells[0], cells[1]) + 2 * half; }
  std::size_t plane_stride() const { return std::size_t(cells[1] + 2) * 2 * half; }
  int row_stride() const { return int(2 * half); }

  /// The rows of a plane, one after the other; fields have no ghosts there but those along z.
  int plane_of_rows() const { return cells[1] * row_stride(); }

  /// Kernels run over whole vectors of four; half a row has room for that.
  static constexpr int padded(int cells_of_a_colour) { return (cells_of_a_colour + 3) / 4 * 4; }

  /// Ghosts of a field across periodic sides: those of a plane's rows at their ends, of its first and last row, of the
  /// first and last plane.
  void wrap_cells(float* x, int i) const noexcept {
    for (int j = 0; wraps[2] && j < cells[1]; ++j) {
      x[at(i, j, -1)] = x[at(i, j, cells[2] - 1)];
      x[at(i, j, cells[2])] = x[at(i, j, 0)];
    }
  }
  void clear_ghost_cells(float* x, int i) const noexcept {
    for (int j = 0; wraps[2] && j < cells[1]; ++j) x[at(i, j, -1)] = x[at(i, j, cells[2])] = 0;
  }
  void wrap_rows(float* x, int i) const noexcept {
    if (!wraps[1]) return;
    std::copy_n(x + row(i, cells[1] - 1), 2 * half, x + row(i, -1));
    std::copy_n(x + row(i, 0), 2 * half, x + row(i, cells[1]));
  }
  void wrap_planes(float* x) const noexcept {
    if (!wraps[0]) return;
    std::copy_n(x + row(cells[0] - 1, -1), plane_stride(), x + row(-1, -1));
    std::copy_n(x + row(0, -1), plane_stride(), x + row(cells[0], -1));
  }

  std::array<int, 3> cells;
  std::array<bool, 3> wraps{};   // periodic with more than one cell
  bool seam = false;             // some periodic direction is odd: cells of one colour meet there
  std::size_t half;              // length of half a row, ghosts and padding included
};

}   // namespace bedload

// One level of the multigrid: couplings, red-black sweeps, and the transfers to the next coarser level.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace bedload {

/// Cells stored as x-planes of y-rows with one ghost layer. Each row is split into its even and its odd k, so that the
/// cells of one colour of a row are contiguous, and every neighbour of theirs too. Walls are faces without coupling.
class MultigridLevel {
 public:
  MultigridLevel(std::array<int, 3> cells, std::array<bool, 3> periodic);

  const std::array<int, 3>& cells() const { return cells_; }
  int cell_count() const { return cells_[0] * cells_[1] * cells_[2]; }

  /// Couplings of the cells of a row with their lower neighbours along c; to be followed by finish_couplings().
  void set_couplings(int c, int i, int j, const double* row, double scale) noexcept;
  /// Copies periodic couplings into the ghost faces and inverts the diagonal.
  void finish_couplings() noexcept;
  /// Sums of the couplings of `fine` across the interfaces between aggregates of ratio[c] cells.
  void aggregate_couplings(const MultigridLevel& fine, std::array<int, 3> ratio) noexcept;
  /// The level's matrix, dense, row by row (for the coarsest level).
  std::vector<double> matrix() const;

  void set_right_hand_side(int i, int j, const double* row, double scale) noexcept;
  void get_solution(int i, int j, double* row) const noexcept;
  float& right_hand_side(int i, int j, int k) { return right_[at(i, j, k)]; }
  float& solution(int i, int j, int k) { return x_[at(i, j, k)]; }

  /// Two sweeps from a zero guess, red first.
  void smooth_from_zero() noexcept;
  /// Right-hand side of `coarse` = sums of this level's residual over aggregates.
  void restrict_residual(MultigridLevel& coarse, std::array<int, 3> ratio) noexcept;
  /// Adds to each cell the solution of its aggregate, then two sweeps in exactly the reverse order of colours.
  void correct_and_smooth(const MultigridLevel& coarse, std::array<int, 3> ratio) noexcept;

 private:
  enum Colour { red = 0, black = 1 };
  /// The cells of one colour in row i,j: where they and their neighbours along z begin, and their number.
  struct ColouredRow {
    std::size_t own, below, above;
    int parity, count;
  };

  /// Kernels run over whole vectors of four; half a row has room for that.
  static constexpr int padded(int cells_of_a_colour) { return (cells_of_a_colour + 3) / 4 * 4; }
  std::size_t row(int i, int j) const { return (std::size_t(i + 1) * (cells_[1] + 2) + (j + 1)) * 2 * half_; }
  std::size_t at(int i, int j, int k) const { return row(i, j) + (k & 1) * half_ + ((k + 2) >> 1); }
  ColouredRow coloured_row(int i, int j, Colour) const noexcept;
  void relax(int plane, Colour) noexcept;
  void begin_with_red(int plane) noexcept;
  void add_correction(int plane, const MultigridLevel& coarse, std::array<int, 3> ratio) noexcept;
  void add_residual(int i, int j, Colour, int ratio, float* sums) const noexcept;
  void fill_ghost_cells(int i, int j) noexcept;
  void fill_ghost_rows(int plane) noexcept;
  void fill_ghost_planes() noexcept;

  std::array<int, 3> cells_;
  std::array<bool, 3> wraps_;   // periodic with more than one cell
  bool seam_;                   // some periodic direction is odd: cells of one colour meet there
  std::size_t half_;            // length of half a row, ghosts and padding included
  std::array<std::vector<float>, 3> coupling_;
  std::vector<float> inverse_diagonal_, x_, right_;   // zero on padding, so that kernels may run over it
  std::vector<float> coarse_row_;                     // one row of the next coarser level in natural order
};

}   // namespace bedload

// The kernel between grains and grid, widened to a fixed width that does not shrink with the cells.
//
// Whatever grains give to the grid is spread, direction by direction, by `passes` steps of implicit diffusion,
// (1 - sigma^2/(2 passes) d2/dx2)^-1 each: positive, conservative, of variance sigma^2 exactly on any cells. What grains read
// is spread by the transposes, so that fluid and grains still exchange opposite amounts. One pass would have the cusp and the
// long tails of exp(-|x|); two make (1 + |x|/l) exp(-|x|/l), smooth at the grain, at the price of a second solve; more gain little.
//
// Between walls the operators of cells (no flux) and of the flux through faces (none on walls) commute with the divergence:
// d(phi)/dt + div J = 0 stays an identity. What else lives on faces, edges included, has half a control volume on each wall.
#pragma once

#include <array>
#include <vector>

#include "solver/coupling/woven.hpp"
#include "solver/scene.hpp"

namespace bedload {

class KernelSmoothing {
 public:
  static constexpr int passes = 2;

  /// Changes nothing.
  KernelSmoothing() = default;
  /// At least three cells in every direction.
  KernelSmoothing(const StaggeredGrid&, const Smoothing& widths);

  explicit operator bool() const { return any_; }

  /// Spreads what was deposited and has gone home, in amounts per cell volume; ghosts are left.
  void spread(FaceFields&) const;
  void spread(Field<Centre>&) const;
  void spread_on_edges(FaceFields&) const;
  /// Spreads a flux through faces, which is zero on walls and stays so.
  void spread_flux(FaceFields&) const;
  /// The same, and how far it reaches then.
  void spread(Deposited& f) const { spread(static_cast<FaceFields&>(f)), f.reach = spread_over(f.reach); }
  void spread_on_edges(Deposited& f) const {
    spread_on_edges(static_cast<FaceFields&>(f)), f.reach = spread_over(f.reach);
  }
  void spread_flux(Deposited& f) const { spread_flux(static_cast<FaceFields&>(f)), f.reach = spread_over(f.reach); }

  /// The field as grains read it: itself, or its transposed spread in `scratch`. On walls the field holds what it has there
  /// (0 for a velocity normal to them).
  template <class Fields>
  const Fields& seen(const Fields& field, Fields& scratch) const {
    if (!any_) return field;
    scratch = field;
    gather(scratch);
    return scratch;
  }
  const FaceFields& edges_seen(const FaceFields& on_edges, FaceFields& scratch) const;

  /// Where a deposit that has gone home lies once it is spread.
  Reach spread_over(const Reach& home) const { return any_ && !home.empty() ? whole(grid_) : home; }

  /// What is read in cell i of a direction of 1 deposited in cell j, at most two cells off; 1 or 0 without smoothing.
  double read_back(int direction, int i, int j) const noexcept;

 private:
  /// A tridiagonal matrix D - k (neighbours) in factors: y_i = g_i f_i + r_i y_{i-1}, x_i = y_i + r_i x_{i+1}.
  struct Line {
    std::vector<double> g, r;
    double seam = 0;            // round a period: the last unknown's part in what passes the seam, and
    std::vector<double> wrap;   // what that adds to each unknown
    bool half_ends = false;     // the ends are half control volumes
  };
  enum class Use { spread, gather };

  void gather(FaceFields&) const;
  void gather(Field<Centre>&) const;
  void smooth(int place, bool flux, Use, double* field) const;
  static Line factored(std::vector<double> diagonal, double k, bool periodic);
  template <class LaneStep>
  static void solve(const Line&, Use, double* first, std::ptrdiff_t step, LaneStep, int lanes, double* seam);

  StaggeredGrid grid_;
  bool any_ = false;
  std::array<Line, 3> cells_, nodes_,
      inner_;   // by direction: centres, faces with those on walls, faces without; empty: sigma 0
  std::array<std::vector<double>, 3> read_back_;   // five diagonals
};

inline const KernelSmoothing no_smoothing;

}   // namespace bedload

// Geometric multigrid for div(c grad p): one symmetric V(2,2) cycle in single precision, a preconditioner.
#pragma once

#include <memory>

#include "solver/fluid/split_grid.hpp"
#include "solver/fluid/staggered_grid.hpp"

namespace bedload {

/// Red-black Gauss-Seidel; only the strongly coupled directions are coarsened until cells are nearly cubic. Piecewise-constant
/// transfer, coarse coupling = sum of the fine couplings across the interface, halved along coarsened directions; along z
/// alone every second cell is interpolated by its couplings (multigrid_along_z.cpp). Symmetric positive (semi-)definite: after the coarse correction the colours run in reverse order, and
/// neighbours of one colour across an odd periodic seam see each other's old values.
class Multigrid {
 public:
  explicit Multigrid(const StaggeredGrid&);
  ~Multigrid();

  /// Couplings w = c/h^2 (any unit; only ratios matter) on faces 0..n of all directions, zero on walls, times `scale`.
  void set_couplings(const FaceFields& couplings, double scale);

  const SplitGrid& layout() const;
  /// r and z in layout(); r without ghosts.
  float* right_hand_side() noexcept;
  const float* solution() const noexcept;
  /// z = approximately (inverse of A = -scale div c grad) r; returns r.z.
  double cycle() noexcept;
  /// image = A field on one plane of cells; the field has its ghosts. Returns field . image of the plane.
  double apply(int plane, const float* field, float* image) const noexcept;

 private:
  struct Hierarchy;
  std::unique_ptr<Hierarchy> hierarchy_;
};

}   // namespace bedload

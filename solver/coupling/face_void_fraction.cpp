#include "solver/coupling/face_void_fraction.hpp"

#include "solver/coupling/void_fraction.hpp"

namespace bedload {

FaceFields face_void_fraction(const StaggeredGrid& grid, const Grains& grains, const Smoothing& widths) {
  Stencils stencils;
  find_stencils(grid, grains, stencils);
  VoidFraction eps(grid);
  deposit_void_fraction(grid, grains, stencils, eps, KernelSmoothing(grid, widths));
  return eps.face;
}

}   // namespace bedload

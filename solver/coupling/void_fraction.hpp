// Grains on the grid: void fraction, flux of solid, and the flux that carries one set of positions into the next; all of them
// by the kernel and its further smoothing.
#pragma once

#include <span>
#include <vector>

#include "solver/coupling/smoothing.hpp"
#include "solver/grains/grains.hpp"

namespace bedload {

/// The stencils of all grains. Positions lie inside the box.
void find_stencils(const StaggeredGrid&, const Grains&, Stencils&);

/// Least eps of a face. A layer of grains whose centres lie in the plane of flat cells' faces, as on a flat bottom, would
/// overfill these (all of a grain is deposited within one cell height): the fluid there would have no mass, or less.
inline constexpr double least_face_void = 0.2;

/// A face with more solid than fits. Fluid and grains divide what acts on it as eps and 1 - eps, of which each grain takes
/// its weight times `grain_share` = (1 - eps)/sum V_p w/V_c.
struct OverfilledFace {
  int direction;
  std::size_t face;   // padded index
  double grain_share;
};

/// eps on centres and on faces: 1 - sum V_p w/V_c, in order of id, 1 where no grain reaches, on unknown faces never below least_face_void. On the
/// faces of walls only the change in time has a meaning (half a control volume).
struct VoidFraction {
  VoidFraction() = default;
  explicit VoidFraction(const StaggeredGrid& g) : centre(g, 1), face(g, 1), solid(g), solid_centre(g), woven(g) {}
  Field<Centre> centre;
  FaceFields face;
  Deposited solid;                          // sum V_p w/V_c on faces, as it is
  std::vector<OverfilledFace> overfilled;   // by direction, then by face; seldom any
  Field<Centre> solid_centre;               // scratch
  Woven woven;
};
void deposit_void_fraction(const StaggeredGrid&, const Grains&, const Stencils&, VoidFraction&,
                           const KernelSmoothing& = {});

/// A flux of solid through faces [m/s].
struct SolidFlux : Deposited {
  SolidFlux() = default;
  explicit SolidFlux(const StaggeredGrid& g) : Deposited(g), woven(g) {}
  Woven woven;   // scratch
};

/// J = sum V_p v_p w/V_c.
void deposit_solid_flux(const StaggeredGrid&, const Grains&, const Stencils&, SolidFlux& flux,
                        const KernelSmoothing& = {});

/// The mean flux over a step that moves solid from `before` (inside the box) by `moved`: the charge-conserving deposit of
/// Esirkepov 2001 (Comput. Phys. Commun. 135, 144) for these splines, div J dt = phi_before - phi_after to round-off.
/// Needs every |moved| below one cell edge. `reach`: of the stencils before and after, united.
void deposit_swept_flux(const StaggeredGrid&, const Grains&, std::span<const Vec3> before, std::span<const Vec3> moved,
                        const Reach& reach, double dt, SolidFlux& flux, const KernelSmoothing& = {});

}   // namespace bedload

// Transport of momentum by the volume flux, exactly conservative while the void fraction changes.
#pragma once

#include "solver/fluid/staggered_grid.hpp"

namespace bedload {

/// Scratch of transport(), kept between calls to save allocation.
struct TransportScratch {
  Field<Centre> divergence, correction;
  std::vector<double> sides, sums;
};

/// u_f = [eps_f u_f - dt sum F carried_side/h]/eps'_f on every unknown face, with F the volume flux [m/s] whose divergence
/// is -d(eps)/dt, averaged to the control volume of each face and corrected along the face's own direction so that a
/// uniform flow stays uniform and momentum is conserved (docs/physics_fluid.md, F10 to F12). `carried` [m/s] is the flow
/// that F belongs to, that of the start of the step, taken at sides by van Leer's TVD limiter; `velocity` [m/s] has all that
/// else changed it in the step, and is another field. `flux` has filled ghosts and is zero on walls; the void fractions are
/// read on faces 0..n, without ghosts. `carried` has both ghost layers filled; `velocity` has none on return. First order in
/// time, TVD for CFL <= 0.5.
void transport(const StaggeredGrid&, const FaceFields& flux, const FaceFields& void_before,
               const FaceFields& void_after, double dt, const FaceFields& carried, FaceFields& velocity,
               TransportScratch&);
/// The same where fluid alone fills the box: eps = 1.
void transport(const StaggeredGrid&, const FaceFields& flux, double dt, const FaceFields& carried, FaceFields& velocity,
               TransportScratch&);

}   // namespace bedload

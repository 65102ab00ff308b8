// The viscous torque between grains that spin and fluid that turns, and its couple on the fluid.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "solver/coupling/smoothing.hpp"

namespace bedload {

/// Torque on a sphere over Stokes's pi mu d^3 (curl u/2 - omega), at Re_r = d^2 |curl u/2 - omega|/nu: 1 in creeping flow,
/// beyond Re_r = 32 that of Dennis, Singh & Ingham 1980 (J. Fluid Mech. 101, 257), good to 4000.
inline double torque_factor(double re) noexcept { return std::max(1.0, 0.6386 + 0.06416 * std::sqrt(re)); }

/// One step's torques, implicit in the fluid (docs/physics_coupling.md, "Viscous torque"). Vorticity stands on the edges of the
/// grid; the couple on the fluid is the transpose of curl/2, so that linear momentum is untouched but for what walls hold, and
/// fluid and grains gain opposite angular momentum. Edge fields: component t on the edges along t, at the lower corner of the
/// other two directions.
class SpinExchange {
 public:
  explicit SpinExchange(const StaggeredGrid&);
  /// Makes two woven fields its scratch.
  void work_in(const Woven& one, const Woven& other) { woven_ = {one, On::edges}, woven_too_ = {other, On::edges}; }

  /// Takes `strength` = T c'_p per axis [m5] and spin targets omega_t [rad/s] by id, and the vorticity of u^n on edges.
  void prepare(const Stencils&, std::span<const Vec3> strength, std::span<const Vec3> target,
               const KernelSmoothing& = {});
  /// impulse -= curl^T (C curl u^n/2 - S)/2, the couples if u* were u^n; `vorticity` on edges as from find_vorticity.
  void add_impulse(const FaceFields& vorticity, FaceFields& impulse);
  /// out += curl^T C curl x/4 on unknown faces; x has a ghost layer as of a velocity.
  void add_image(const FaceFields& x, FaceFields& out);
  /// out += the diagonal of that operator.
  void add_diagonal(FaceFields& out) const;
  /// What the couples for this `vorticity` put on the bottom and on the top wall in the step, per rho_f [m4/s], x and y.
  struct WallImpulse {
    Vec3 bottom, top;
  };
  WallImpulse on_walls(const FaceFields& vorticity) const;

 private:
  void weigh_walls(FaceFields& on_edges) const;
  int planes_reached() const;

  StaggeredGrid grid_;
  Deposited strength_, target_;   // C = sum w c' T/V_c, S = sum w c' T omega_t/V_c, on edges
  FaceFields turn_;               // scratch, on edges
  Woven woven_, woven_too_;
  int reach_ = 0;   // C = 0 on edges from this plane along z on
};

/// curl u on every edge, those on walls and in the first ghost layer round a period included; `velocity` has its ghosts filled.
void find_vorticity(const StaggeredGrid&, const FaceFields& velocity, FaceFields& on_edges);

}   // namespace bedload

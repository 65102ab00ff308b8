// The coupled drag solve: fluid and grains brought to one velocity field by drag, implicitly, once per fluid step.
#pragma once

#include <span>
#include <vector>

#include "solver/coupling/spin_exchange.hpp"
#include "solver/coupling/void_fraction.hpp"
#include "solver/fluid/turbulence.hpp"

namespace bedload {

/// One step's drag problem (docs/physics_coupling.md). Per grain, by id:
///   per axis: exchange K = beta_p T/(rho_f V_c) [-], relaxation a = beta_p T/M [-] (0 for fixed grains); ballistic
///   velocity vt [m/s].
struct DragProblem {
  const Stencils& stencils = no_stencils;
  std::span<const Vec3> exchange, relaxation;
  std::span<const Vec3> ballistic;
  std::span<const Vec3> flow_velocity;      // u^n at the grains [m/s]
  double implicit_viscosity = 0;            // T nu [m2], or 0 where viscosity is explicit
  const Turbulence* turbulence = nullptr;   // whose stress is implicit too, over `step`; nullptr if none is
  double step = 0;                          // T [s]
  SpinExchange* spin = nullptr;             // the couples of viscous torque, prepared; nullptr if there are none
  const KernelSmoothing& smoothing = no_smoothing;   // of the weights
};

/// Solves, for the change of velocity since u^n,
///   (eps_f + B_f) u*_f - sum_p w_pf K [a/(1+a)] (sum_g w_pg u*_g) - T [nu lap(u* - u^n) + div of its eddy stress] + curl^T C curl (u* - u^n)/4 = eps_f u^n_f + T b_f + sum_p w_pf K vt_p/(1+a)
/// by conjugate gradients (symmetric positive definite, preconditioned by eps + B; where no grain reaches and viscosity is explicit, directly) to |r| < 0.01/(1 + b_max) |r_0|, b_max the largest of (B + viscous diagonal)/eps.
class ImplicitDrag {
 public:
  explicit ImplicitDrag(const StaggeredGrid&);
  /// Makes two woven fields its scratch.
  void work_in(const Woven& one, const Woven& other) { woven_ = one, woven_too_ = other; }
  static constexpr int most_iterations = 500;

  /// `impulse` = T b_f on entry (b = eps a or a, in Model A or B). On return `velocity` (u^n on entry) holds u* + r/eps, in
  /// which the momentum given to the grains by drag is missing exactly, and `flow_velocity` u* sampled at the grains.
  /// Returns the number of iterations.
  int solve(const StaggeredGrid&, const DragProblem&, const FaceFields& void_fraction, const FaceFields& impulse,
            FaceFields& velocity, std::span<Vec3> flow_velocity);

  /// u* - u^n of the last solve; the inner layer of its ghosts is filled where viscosity was implicit or there were couples.
  const FaceFields& change() const { return change_; }

 private:
  double apply(const StaggeredGrid&, const DragProblem&, const FaceFields& void_fraction);
  double start(const StaggeredGrid&, const DragProblem&, const FaceFields& void_fraction, const FaceFields& impulse,
               const FaceFields& velocity);
  double move_free_fluid(const StaggeredGrid&, const FaceFields& void_fraction, const FaceFields& impulse,
                         FaceFields& velocity);

  Reach coupled_;   // beyond it the faces know nothing of each other, nor of grains
  Deposited exchange_, residual_, image_, direction_, change_;
  FaceFields diagonal_, laplacian_;
  Woven woven_, woven_too_;
  std::vector<Vec3> read_, share_;   // by grain: of the direction; K a/(1+a)
  FaceFields seen_;                  // only with a smoothing
};

}   // namespace bedload

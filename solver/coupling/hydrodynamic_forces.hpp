// What each grain feels of the flow at the start of a step.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "solver/coupling/drag_laws.hpp"
#include "solver/coupling/packing_of_others.hpp"
#include "solver/coupling/self_disturbance.hpp"
#include "solver/coupling/void_fraction.hpp"

namespace bedload {

/// By id. Forces are per fluid density ("kinematic": N / (kg/m3) = m4/s2).
struct FlowAtGrains {
  std::vector<Vec3> velocity;          // u at the grain [m/s]
  std::vector<Vec3> acceleration;      // -grad q + nu lap u + G at the grain [m/s2]
  std::vector<double> void_fraction;   // eps at the grain [-]
  std::vector<Vec3>
      drag;   // beta/rho_f per axis: drag force per slip and fluid density [m3/s]; divided by eps in Model B
  std::vector<Vec3> force;   // explicit forces on the grain besides drag (lift, ...), per fluid density [m4/s2]
  GrainPacking packing;
  std::optional<SelfDisturbance> self_disturbance;   // tables, made with the first step of a scene that has the term
  std::vector<Vec3> vorticity;                       // curl u at the grain [1/s]; where a term asks for it
  std::vector<Vec3> removed;   // own disturbance that `drag` is corrected for, by 1/(1 - removed) [-]; empty: none
  struct Seen {
    FaceFields velocity, acceleration;
    Field<Centre> void_fraction;
  } seen;                                 // what grains read of the fields; only with a smoothing
  Woven woven, woven_too;                 // scratch
  std::uint64_t void_clamps = 0;          // grains whose void fraction lay below least_void
  std::uint64_t disturbance_clamps = 0;   // grains whose own flow was clamped at 0.7 of the slip
  std::uint64_t lift_clamps = 0;          // grains whose lift was clamped at half of the drag
};

/// Samples the flow with each grain's own weights and evaluates f_d = 3 pi mu d F(eps, Re) eps w, Re = eps |w| d/nu.
/// A lone grain does not see its own volume in eps, nor, where the scene has the term, its own flow in w
/// (docs/physics_coupling.md, "Self-disturbance").
void sample_flow(const StaggeredGrid&, const Grains&, const Stencils&, const FaceFields& velocity,
                 const FaceFields& acceleration, const Field<Centre>& void_fraction, const DragLaw&, double viscosity,
                 const Terms&, FlowAtGrains&, const KernelSmoothing& = {});

/// The last part of it: flow.drag of the velocity, void fraction and packing that `flow` holds, and flow.removed. `drag` holds an
/// entry for each grain, 0 without the term.
void find_drag(const StaggeredGrid&, const Grains&, const DragLaw&, double viscosity, const Terms&, FlowAtGrains&);

}   // namespace bedload

// Oracle: a coupled step in which grains answer to a pressure one step late, as most codes do it.
#pragma once

#include "solver/coupling/hydrodynamic_forces.hpp"
#include "solver/coupling/implicit_drag.hpp"
#include "solver/coupling/mixture_response.hpp"
#include "solver/fluid/momentum.hpp"
#include "solver/fluid/pressure_projection.hpp"
#include "solver/grains/grain_dynamics.hpp"
#include "solver/state.hpp"

namespace bedload::test {

/// Coupler::step in every other respect (Model A, explicit viscosity, no walls that move): same kernel, drag solve,
/// sub-steps, transport and pressure equation, but the projection moves the fluid alone; grains feel its pressure in the next
/// step. Added mass, if the scene wants it, is the force C_A V_p (a_f - dv/dt) of the last step, C_A 0.5. For tests only: it is
/// unstable for every step wherever s < (1 - eps)/eps.
class LaggedStep {
 public:
  explicit LaggedStep(const Scene&);
  void step(State&, double dt, int substeps);

 private:
  const Scene scene_;
  const StaggeredGrid grid_;
  GrainDynamics dynamics_;
  ImplicitDrag drag_;
  PressureSolver pressure_;
  VoidFraction before_, after_;
  FaceFields acceleration_, laplace_, impulse_, flux_, kick_;
  SolidFlux solid_flux_;
  MixtureResponse response_;
  Field<Centre> rhs_, correction_;
  TransportScratch transport_scratch_;
  Stencils stencils_;
  std::vector<Vec3> last_velocity_;   // empty before the first step
};

}   // namespace bedload::test

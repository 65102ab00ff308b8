// What a coupled step of the box works with, and the parts that it is made of; each file of them is named after what it does.
#pragma once

#include <optional>
#include <vector>

#include "solver/coupler_rung.hpp"
#include "solver/coupling/implicit_drag.hpp"
#include "solver/coupling/mixture_response.hpp"
#include "solver/coupling/spin_exchange.hpp"
#include "solver/fluid/momentum.hpp"
#include "solver/fluid/pressure_projection.hpp"
#include "solver/fluid/turbulence.hpp"

namespace bedload {

struct Coupler::Parts final : Rung {
  explicit Parts(const Scene&);
  void step(State&, double longest) override;

  const KernelSmoothing smoothing;
  ImplicitDrag drag;
  PressureSolver pressure;
  std::optional<Turbulence> turbulence;   // a function of u^n; only where the scene has it

  // Scratch; `stencils` and `before` belong to `positions` and are kept when the state still has them.
  std::vector<double> diameters;
  Stencils stencils;
  VoidFraction before, after;
  FaceFields acceleration, impulse, flux;
  bool responds_alone = false;   // the pressure's last matrix was that of fluid alone
  SolidFlux solid_flux;
  Woven woven, woven_too;   // what all parts of the step work in, by turns
  MixtureResponse response;
  Field<Centre> rhs, correction;
  FaceFields kick, shared;
  FaceFields carried;   // u^n with its ghosts
  FaceFields seen;      // what grains read of a field; only with a smoothing
  TransportScratch transport_scratch;
  // Only where the terms need them.
  Deposited added_exchange, reaction;
  std::optional<SpinExchange> spin_exchange;
  FaceFields vorticity, vorticity_change;   // on edges [1/s]
  Woven woven_edges;

  /// No grain is in the box: eps = 1, and the volume flux is the velocity.
  bool fluid_alone() const { return stencils.empty(); }

  void place_on_grid(const Grains&);
  void accelerate_faces(State&);
  void find_acceleration(const State&);
  void book_wall_shear(const FaceFields& velocity);
  const FaceFields& on_grains(const FaceFields& acceleration);
  Vec3 turning_at(std::size_t grain) const;
  void sample_at_grains(State&);
  bool implicit_viscosity(double dt) const;
  void move_fluid_alone(State&, double dt);
  void find_impulse(const State&, double dt);
  void react_on_fluid(const State&, double dt);
  void solve_drag(State&, double dt);
  void find_carried_mass(const Grains&);
  void book_torques(const Grains&, double dt);
  void book_drive_of_fluid(const State&);
  void deposit_at_new_positions(const State&, double dt);
  void transport_momentum(State&, double dt);
  void carry_liquid(State&, double dt);
  void project(State&, double dt);
  void find_divergence_to_undo(State&, double dt);
  double uniform_gradient(State&, double dt);
  void kick_mixture(State&, double dt, double uniform);
};

}   // namespace bedload

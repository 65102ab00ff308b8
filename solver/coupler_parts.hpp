// What one coupled step works with, and the parts that it is made of; each file of them is named after what it does.
#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "solver/coupler.hpp"
#include "solver/coupling/explicit_forces.hpp"
#include "solver/coupling/hydrodynamic_forces.hpp"
#include "solver/coupling/implicit_drag.hpp"
#include "solver/coupling/mixture_response.hpp"
#include "solver/coupling/spin_exchange.hpp"
#include "solver/fluid/momentum.hpp"
#include "solver/fluid/pressure_projection.hpp"
#include "solver/fluid/turbulence.hpp"
#include "solver/grains/grain_dynamics.hpp"

namespace bedload {

/// max(sqrt(d/(|s - 1| g)), d/U_t) [s]; infinite without weight.
double time_of_fall(const Scene&);

bool any_mobile(const Grains&);

/// Adds the time of its life to a sum [s].
class Stopwatch {
 public:
  explicit Stopwatch(double& sum) : sum_(sum), start_(std::chrono::steady_clock::now()) {}
  ~Stopwatch() { sum_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  double& sum_;
  std::chrono::steady_clock::time_point start_;
};

struct Coupler::Parts {
  explicit Parts(const Scene&);

  const Scene scene;
  const StaggeredGrid grid;
  const DragLaw law;
  const double fall_time;
  const KernelSmoothing smoothing;
  GrainDynamics dynamics;
  ImplicitDrag drag;
  PressureSolver pressure;
  std::optional<Turbulence> turbulence;   // a function of u^n; only where the scene has it

  // Scratch; `stencils` and `before` belong to `positions` and are kept when the state still has them.
  std::vector<Vec3> positions;
  std::vector<double> diameters;
  Stencils stencils;
  VoidFraction before, after;
  FaceFields acceleration, impulse, flux;
  double courant_rate = 0;       // of u^n: cells that it crosses per time [1/s]
  bool responds_alone = false;   // the pressure's last matrix was that of fluid alone
  SolidFlux solid_flux;
  Woven woven, woven_too;   // what all parts of the step work in, by turns
  MixtureResponse response;
  Field<Centre> rhs, correction;
  FaceFields kick, shared;
  FaceFields carried;   // u^n with its ghosts
  FaceFields seen;      // what grains read of a field; only with a smoothing
  TransportScratch transport_scratch;
  FlowAtGrains flow;
  Sheltering sheltering;
  std::vector<Vec3> exchange, relaxation, ballistic, flow_velocity, push, moved, drag_force;
  // Only where the terms need them.
  std::vector<double> added_volume, carried_mass;   // C_A V_p [m3]; the liquid that a contact force moves too [kg]
  std::vector<Vec3> contact_before;                 // mean contact force that the drag solve has met [N]
  Deposited added_exchange, reaction;
  std::optional<SpinExchange> spin_exchange;
  FaceFields vorticity, vorticity_change;   // on edges [1/s]
  Woven woven_edges;
  std::vector<Vec3> spin_strength;   // T c' [m5]
  std::vector<Vec3> spin_start, spin_target, spin_push, torque;

  StepBooks books;
  StepTimes times;
  StepHealth health;

  /// No grain is in the box: eps = 1, and the volume flux is the velocity.
  bool fluid_alone() const { return stencils.empty(); }
  bool failed() const { return !health.finite || health.lost_grain; }
  bool model_b() const { return scene.terms.model_b(); }
  bool explicit_forces() const { return any_explicit(scene.terms); }
  bool wants_vorticity() const { return scene.terms.viscous_torque || explicit_forces(); }
  double specific_mass(const Grains& g, std::size_t p) const {
    return sphere_volume(g.diameter[p]) * g.density[p] / scene.bed.fluid.density;
  }
  /// -dp/dx that drives the fluid, and the uniform gradient that holds back the net flux of a z-periodic box [m/s2].
  Vec3 drive(const State& s) const { return {s.search.gradient, 0, s.fluid.column_gradient}; }

  void place_on_grid(const Grains&);
  void accelerate_faces(State&);
  void find_acceleration(const State&);
  void book_wall_shear(const FaceFields& velocity);
  const FaceFields& on_grains(const FaceFields& acceleration);
  Vec3 turning_at(std::size_t grain) const;
  void sample_at_grains(State&);
  double choose_step(const State&, double longest);
  int limit_by_grains(const State&, double& step);
  void shorten(double& step, double limit, StepLimit by);
  void predict_grains(const State&, double dt);
  void predict_spins(const State&, double dt);
  bool implicit_viscosity(double dt) const;
  void move_fluid_alone(State&, double dt);
  void find_impulse(const State&, double dt);
  void react_on_fluid(const State&, double dt);
  void solve_drag(State&, double dt);
  void find_carried_mass(const Grains&);
  void book_exchange(const State&, double dt);
  void book_torques(const Grains&, double dt);
  void book_drive_of_fluid(const State&);
  void book_drive_of_grains(const State&, double dt);
  void move_grains(State&, double dt);
  void deposit_at_new_positions(const State&, double dt);
  void transport_momentum(State&, double dt);
  void carry_liquid(State&, double dt);
  void project(State&, double dt);
  void find_divergence_to_undo(State&, double dt);
  double uniform_gradient(State&, double dt);
  void kick_mixture(State&, double dt, double uniform);
  Vec3 weight(double density) const;
};

}   // namespace bedload

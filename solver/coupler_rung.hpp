// One fidelity of the fluid, and what the grains of a coupled step do in all of them.
#pragma once

#include <chrono>
#include <vector>

#include "solver/coupler.hpp"
#include "solver/coupling/explicit_forces.hpp"
#include "solver/coupling/hydrodynamic_forces.hpp"
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

/// A rung fills `flow` with what its fluid is at the grains, and `flow_velocity` with what it is at the end of the step;
/// limits of the step, forces on grains, their motion and the books of both are the same on all rungs.
class Coupler::Rung {
 public:
  virtual ~Rung() = default;

  /// One fluid step with all that belongs to it, but for the clock; leaves `books` and `health`, which it finds empty.
  virtual void step(State&, double longest) = 0;
  /// Coupler::steady_column(); nothing on the other rungs.
  virtual std::vector<double> steady_column(const Grains&, const ImposedFlow&) { return {}; }

  const Scene scene;
  FlowAtGrains flow;
  std::vector<Vec3> drag_force, torque;   // on each grain, by id [N], [N m]
  StepBooks books;
  StepTimes times;
  StepHealth health;

 protected:
  /// A grain's travel in a step is measured in `reach` [m]: the cells that may not be passed over, along each axis.
  Rung(const Scene&, Vec3 reach);

  const StaggeredGrid grid;
  const Vec3 reach;
  const DragLaw law;
  const double fall_time;
  GrainDynamics dynamics;

  // Scratch, by id.
  std::vector<Vec3> positions;   // where the step found the grains
  Sheltering sheltering;
  std::vector<Vec3> exchange, relaxation, ballistic, flow_velocity, push, moved;
  double courant_rate = 0;   // of u^n: cells that it crosses per time [1/s]
  // Only where the terms need them.
  std::vector<double> added_volume, carried_mass;   // C_A V_p [m3]; the liquid that a contact force moves too [kg]
  std::vector<Vec3> contact_before;                 // mean contact force that the drag solve has met [N]
  std::vector<Vec3> spin_strength;                  // T c' [m5]
  std::vector<Vec3> spin_start, spin_target, spin_push;

  bool failed() const { return !health.finite || health.lost_grain; }
  bool model_b() const { return scene.terms.model_b(); }
  bool explicit_forces() const { return any_explicit(scene.terms); }
  bool wants_vorticity() const { return scene.terms.viscous_torque || explicit_forces(); }
  double specific_mass(const Grains& g, std::size_t p) const {
    return sphere_volume(g.diameter[p]) * g.density[p] / scene.bed.fluid.density;
  }
  /// -dp/dx that drives the fluid, and the uniform gradient that holds back the net flux of a z-periodic box [m/s2].
  Vec3 drive(const State& s) const { return {s.search.gradient, 0, s.fluid.column_gradient}; }
  Vec3 weight(double density) const;

  double choose_step(const State&, double longest);
  void predict_grains(const State&, double dt);
  void predict_spins(const State&, double dt);
  void book_exchange(const State&, double dt);
  void book_torque(const Grains&, std::size_t grain, Vec3 turn, double dt);
  void move_grains(State&, double dt);
  Vec3 force_on_liquid(const Grains&, std::size_t grain) const;

 private:
  int limit_by_grains(const State&, double& step);
  void shorten(double& step, double limit, StepLimit by);
  void book_drive_of_grains(const State&, double dt);
};

}   // namespace bedload

// One coupled step of fluid and grains.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "solver/scene.hpp"
#include "solver/state.hpp"

namespace bedload {

/// What decided the length of a step.
enum class StepLimit { asked, cfl, drag, travel, contact, weight };

/// How well a step went; judged in one place, never thrown.
struct StepHealth {
  double dt = 0;      // fluid step [s]
  int substeps = 0;   // DEM steps in it
  int retries = 0;    // times that it was undone and taken again shorter (Experiment)
  StepLimit limited_by = StepLimit::asked;
  double cfl = 0;               // of the fluid as the step found it [-]
  double cfl_after = 0;         // the same step with the velocities it leaves [-]
  double deepest_overlap = 0;   // of a grain contact, per diameter of the smaller grain [-]
  double grain_travel = 0;      // farthest, per cell edge [-]
  double divergence = 0;        // residual of the projection's linear solve, of its right-hand side [-]
  double divergence_left = 0;   // largest |div(eps u + J)| T that the step found: what the one before left [-]
  int drag_iterations = 0, pressure_iterations = 0;
  std::uint64_t void_clamps = 0;          // grains whose void fraction was clamped in the drag law
  std::uint64_t face_clamps = 0;          // faces whose void fraction was clamped, for grains would overfill them
  std::uint64_t disturbance_clamps = 0;   // grains whose own flow was clamped
  std::uint64_t lift_clamps = 0;          // grains whose lift was clamped
  bool converged = true;                  // of both linear solves
  bool lost_grain = false;                // one crossed more than a cell in the step, or its centre passed a wall
  bool finite = true;
  bool settles = true;   // false: packing has gone on for longer than any bed takes
};

/// Momentum that changed hands in a step, as mean forces over it [N]. Complete along x and y where those are periodic; what
/// passes to side walls, and along z, is not booked.
struct StepBooks {
  Vec3 on_grains;          // hydrodynamic force on all grains, fixed ones too (drag, pressure, viscous stress, kick)
  Vec3 on_bottom;          // viscous stress (and couples of grains) on the bottom wall, x and y
  Vec3 on_lid;             // the same on the lid
  Vec3 driving;            // G on the fluid (and on grains, Model A), x and y
  Vec3 contact_on_walls;   // of grains on walls
  /// Energy [W], means over the step: work of the lid on the fluid; of G (that of the step's start) on the fluid and, in
  /// Model A, on grains; of weight and push on grains, over the way they went.
  double by_lid = 0, by_gradient = 0, by_weight = 0;
  /// What drag and viscous torque take from the motion of both phases [W]: below zero at most near walls.
  double exchange_loss = 0;
};

/// Wall seconds spent in each part of the step since construction, for benchmarks and the run's closing line.
struct StepTimes {
  double sample = 0, drag = 0, contacts = 0, deposit = 0, transport = 0, pressure = 0, total = 0;
};

class Coupler {
 public:
  explicit Coupler(const Scene&);
  ~Coupler();

  /// Advances fluid, grains, contacts and clock by one fluid step, at most `longest` seconds, under the lid speed and
  /// gradient that state.search holds. Deterministic in State: scratch never outlives a step in meaning.
  StepHealth step(State&, double longest);

  /// u of every layer of a column [m/s], once the flow that is imposed is steady over and through the grains where they are, held
  /// still. Only for models.fluid = "column".
  std::vector<double> steady_column(const Grains&, const ImposedFlow&);

  const StepBooks& books() const;
  /// Drag of the last step on each grain, by id [N].
  std::span<const Vec3> drag_on_grains() const;
  /// Viscous torque of the last step on each grain, by id [N m]; empty without the term.
  std::span<const Vec3> torque_on_grains() const;
  const StepTimes& times() const;
  /// Forgets all scratch (the amnesia test: must change no bit).
  void forget();

 private:
  class Rung;     // one fidelity of the fluid with its grains: coupler_rung.hpp
  struct Parts;   // of the box
  class Layers;   // what column and imposed profile have in common: coupler_layers.hpp
  class ColumnRung;
  class ProfileRung;
  static std::unique_ptr<Rung> rung_of(const Scene&);
  std::unique_ptr<Rung> rung_;
};

}   // namespace bedload

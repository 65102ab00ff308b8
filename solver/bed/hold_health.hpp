// How well the steps of a hold went, listed once: for the sums of the hold under way, for the record, for the database.
#pragma once

namespace bedload {

/// Number of fluid steps, and of each measure of StepHealth the worst. `Number` is double for one hold, a vector of double
/// for a column of holds.
template <class Number>
struct HealthMeasures {
  Number steps{};                 // fluid steps [-]
  Number shortest_step{};         // [s]
  Number longest_step{};          // [s]
  Number retries{};               // steps undone and taken again shorter [-]
  Number cfl{};                   // largest Courant number, before or after a step [-]
  Number deepest_overlap{};       // per diameter of the smaller grain [-]
  Number grain_travel{};          // farthest in one step, per cell edge [-]
  Number divergence{};            // largest that a linear solve left, of its right-hand side [-]
  Number divergence_left{};       // largest |div(eps u + J)| T that a step found [-]
  Number void_clamps{};           // of the void fraction in the drag law, summed over grains and steps [-]
  Number face_clamps{};           // of the void fraction on faces, summed over faces and steps [-]
  Number disturbance_clamps{};    // of a lone grain's own flow, summed over grains and steps [-]
  Number lift_clamps{};           // of lift at half of the drag, the same [-]
  Number pressure_iterations{};   // most in one step [-]
  Number drag_iterations{};       // the same
  Number limited_by_cfl{};        // steps that the Courant number shortened [-]
  Number limited_by_drag{};       // the relaxation of a grain
  Number limited_by_travel{};     // the way of the fastest grain
  Number limited_by_contact{};    // the duration of a collision
  Number limited_by_weight{};     // the grain time
  bool operator==(const HealthMeasures&) const = default;

  /// Visits every measure as visit(name, number, unit).
  template <class Self, class Visit>
  static void each(Self& s, Visit&& visit) {
    visit("steps", s.steps, "1");
    visit("shortest_step", s.shortest_step, "s");
    visit("longest_step", s.longest_step, "s");
    visit("retries", s.retries, "1");
    visit("cfl", s.cfl, "1");
    visit("deepest_overlap", s.deepest_overlap, "1");
    visit("grain_travel", s.grain_travel, "1");
    visit("divergence", s.divergence, "1");
    visit("divergence_left", s.divergence_left, "1");
    visit("void_clamps", s.void_clamps, "1");
    visit("face_clamps", s.face_clamps, "1");
    visit("disturbance_clamps", s.disturbance_clamps, "1");
    visit("lift_clamps", s.lift_clamps, "1");
    visit("pressure_iterations", s.pressure_iterations, "1");
    visit("drag_iterations", s.drag_iterations, "1");
    visit("limited_by_cfl", s.limited_by_cfl, "1");
    visit("limited_by_drag", s.limited_by_drag, "1");
    visit("limited_by_travel", s.limited_by_travel, "1");
    visit("limited_by_contact", s.limited_by_contact, "1");
    visit("limited_by_weight", s.limited_by_weight, "1");
  }
};

using HoldHealth = HealthMeasures<double>;

}   // namespace bedload

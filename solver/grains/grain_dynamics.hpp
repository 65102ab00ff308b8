// The motion of the grains between two fluid steps: contacts, then motion, sub-step by sub-step.
#pragma once

#include <memory>
#include <span>

#include "solver/grains/bed_scene.hpp"
#include "solver/grains/contact_history.hpp"
#include "solver/grains/contact_terms.hpp"
#include "solver/grains/grain_kernels.hpp"
#include "solver/grains/grains.hpp"

namespace bedload {

struct GrainHealth {
  double deepest_overlap = 0;   // per diameter of the smaller grain [-]
  Vec3 force_on_walls;          // mean contact force of grains on all walls [N]
  std::uint64_t contacts = 0;   // touching pairs at the end, walls included
};

/// What acts on the grains besides contacts, constant over a call: one entry per grain, or empty for none.
struct GrainDrive {
  std::span<const Vec3> push{};           // acceleration of the grain with its added mass [m/s2]; never empty
  std::span<const double> relaxation{};   // rate of an implicit linear drag to rest [1/s]
  std::span<const Vec3> spin_push{};      // angular acceleration [rad/s2]
  std::span<const double> added_mass{};   // inertia of the liquid that moves with the grain, translation only [kg]
};

/// Advances the grains by sub-steps of {contact forces at x^n, v^n; v += dt (push + F/m); films slow v; x += dt v}
/// (symplectic Euler: no hidden memory). Sums of contact forces are in order of partner id. Positions are not wrapped here: they may leave
/// a periodic box during the call. Fixed grains keep position, velocity and spin.
class GrainDynamics {
 public:
  /// The liquid of the terms is scene.fluid. All kernels give the same bits.
  explicit GrainDynamics(const BedScene&, ContactTerms = {}, const GrainKernels& = grain_kernels());
  ~GrainDynamics();

  /// `lid_speed`: of the top wall along x [m/s]. On return velocity, position, spin, contacts are those of the end,
  /// mean_contact_force and mean_contact_torque the means over the sub-steps. Contacts see a grain's mass with its added
  /// mass, so that they rebound as they were asked to.
  GrainHealth advance(Grains&, ContactHistory&, const GrainDrive&, double dt, int substeps, double lid_speed);

  /// Forgets all scratch (the neighbour list).
  void forget();

 private:
  struct Workspace;
  std::unique_ptr<Workspace> work_;
};

/// Rayleigh time of a grain, pi r sqrt(rho/G)/(0.1631 nu + 0.8766) [s].
double rayleigh_time(double diameter, double density, double young_modulus, double poisson);

/// Duration of a Hertz collision of two equal grains at relative speed v, 2.87 (m*^2/(R* Y*^2 v))^(1/5) [s].
double contact_time(double diameter, double density, double young_modulus, double poisson, double speed);

}   // namespace bedload

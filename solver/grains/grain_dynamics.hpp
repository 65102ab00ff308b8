// The motion of the grains between two fluid steps: contacts, then motion, sub-step by sub-step.
#pragma once

#include <memory>
#include <span>

#include "solver/grains/bed_scene.hpp"
#include "solver/grains/contact_history.hpp"
#include "solver/grains/grains.hpp"

namespace bedload {

struct GrainHealth {
  double deepest_overlap = 0;   // per diameter of the smaller grain [-]
  Vec3 force_on_walls;          // mean contact force of grains on all walls [N]
  std::uint64_t contacts = 0;   // touching pairs at the end, walls included
};

/// Advances the grains by sub-steps of {contact forces at x^n, v^n; v += dt (push + F/m); x += dt v} (symplectic Euler:
/// no hidden memory). Sums of contact forces are in order of partner id. Positions are not wrapped here: they may leave
/// a periodic box during the call. Fixed grains keep position, velocity and spin.
class GrainDynamics {
 public:
  explicit GrainDynamics(const BedScene&);
  ~GrainDynamics();

  /// `push`: constant acceleration of each grain [m/s2] (everything but contacts). `relaxation`: rate of an implicit
  /// linear drag to rest [1/s] per grain, or empty. `lid_speed`: of the top wall along x [m/s].
  /// On return velocity, position, spin, contacts are those of the end, mean_contact_force the mean over the sub-steps.
  GrainHealth advance(Grains&, ContactHistory&, std::span<const Vec3> push, std::span<const double> relaxation,
                      double dt, int substeps, double lid_speed);

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

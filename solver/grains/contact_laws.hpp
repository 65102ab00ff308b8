// What two overlapping spheres do to each other: laws as value types that mutate nothing.
#pragma once

#include <cmath>

#include "base/vec3.hpp"
#include "solver/grains/bed_scene.hpp"

namespace bedload {

/// One contact as a law sees it. A wall is a partner of infinite radius and mass, and so is, in mass, a fixed grain.
struct Overlap {
  double depth = 0;         // delta = r_i + r_j - distance [m]; not positive: apart
  double root_radius = 0;   // square root of R* = r_i r_j/(r_i + r_j) [m^1/2]
  double mass = 0;          // m* = m_i m_j/(m_i + m_j) [kg]
  Vec3 normal;              // unit vector from the lower grain to its partner
  Vec3 velocity;            // of the lower grain relative to its partner at the point of contact, spin included [m/s]
};

struct ContactForce {
  Vec3 force;    // on the lower grain [N]; the partner gets the opposite
  Vec3 spring;   // to be handed in at the next step [m]
};

/// Hertz's normal force with damping, Mindlin's spring with Coulomb's cap: docs/physics_grains.md, (G1)-(G8).
class HertzMindlin {
 public:
  /// Grains and walls are of one material. The damping is calibrated so that a collision rebounds with the restitution
  /// asked for although contacts never pull; below `lowest_restitution` it rebounds with that.
  explicit HertzMindlin(const GrainProperties&);

  /// Stronger damping, being explicit, would shake a bed of many contacts at the DEM steps in use instead of calming it.
  static constexpr double lowest_restitution = 0.1;
  static constexpr double strongest_shear_damping = 0.35;   // alpha of gamma_t = alpha sqrt(S_t m*) [-]

  HertzMindlin without_friction() const;

  /// Force and new spring of a contact in a step dt; zero and zero for grains apart. `spring` is that of the last step.
  ContactForce respond(const Overlap&, Vec3 spring, double dt) const noexcept;

 private:
  double normal_stiffness_;   // 2 Y* [Pa]
  double shear_ratio_;        // S_t/S_n = 4 G*/Y* [-]
  double damping_;            // alpha of gamma_n = alpha sqrt(S_n m*) [-]
  double damping_ratio_;      // gamma_t/gamma_n [-]
  double friction_;           // Coulomb's coefficient [-]
};

/// Restitution of a Hertz collision damped by alpha sqrt(S_n m*) and never pulling, whatever its speed [-].
double restitution_of_damping(double alpha) noexcept;

/// Its inverse, for 0 < restitution <= 1 [-].
double damping_of_restitution(double restitution) noexcept;

inline ContactForce HertzMindlin::respond(const Overlap& o, Vec3 spring, double dt) const noexcept {
  const bool touching = o.depth > 0;
  const double depth = touching ? o.depth : 0;
  const double closing = dot(o.velocity, o.normal);
  const Vec3 sliding = o.velocity - closing * o.normal;

  const double a = o.root_radius * std::sqrt(depth);                 // radius of the contact, (G1)
  const double stiffness = normal_stiffness_ * a;                    // S_n, (G2)
  const double damping = damping_ * std::sqrt(stiffness * o.mass);   // gamma_n, (G4)
  const double push = stiffness * depth * (2.0 / 3) + damping * closing;
  const double normal_force = push > 0 ? push : 0;   // (G3), never pulls

  // A growing contact keeps its tangential force, a shrinking one lets it fall with its radius: no energy is made. The
  // depth a step ago follows from the velocity (symplectic Euler: x^n = x^{n-1} + dt v^n): nothing to remember.
  const double before = depth - closing * dt > 0 ? depth - closing * dt : 0;
  const double kept = before < depth ? 2 * before / (before + depth) : 1;       // at most a_before/a, (G6)
  spring = kept * (spring - dot(spring, o.normal) * o.normal) + dt * sliding;   // (G5)

  const double shear = shear_ratio_ * stiffness;                             // S_t
  Vec3 tangential = shear * spring + (damping_ratio_ * damping) * sliding;   // (G7)
  const double pull = norm(tangential), cap = friction_ * normal_force;
  const double scale = pull > cap ? cap / pull : 1;   // the spring slides with its contact, (G8)
  tangential *= scale;
  spring *= touching ? scale : 0;
  return {-(normal_force * o.normal + tangential), spring};
}

}   // namespace bedload

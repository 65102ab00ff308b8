// What two overlapping spheres do to each other: laws as value types that mutate nothing.
#pragma once

#include <algorithm>
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

/// How strongly a contact is damped, gamma_n = normal sqrt(S_n m*), gamma_t = tangential gamma_n (G4).
struct Damping {
  double normal;       // alpha [-]
  double tangential;   // gamma_t/gamma_n [-]
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

  /// Of a dry collision, and of one with a damping of its own.
  Damping damping() const noexcept { return damping_; }
  Damping damping(double alpha) const noexcept;

  /// Force and new spring of a contact in a step dt; zero and zero for grains apart. `spring` is that of the last step.
  ContactForce respond(const Overlap&, Vec3 spring, double dt, Damping) const noexcept;
  ContactForce respond(const Overlap& o, Vec3 spring, double dt) const noexcept {
    return respond(o, spring, dt, damping_);
  }

  double normal_force(const Overlap&, Damping) const noexcept;   // F_n [N], (G3)
  double shear_stiffness(const Overlap&) const noexcept;         // S_t [N/m], (G2)
  /// What the springs of a contact hold, 2/5 F_n delta + S_t xi^2/2 [J], F_n without damping; 0 for grains apart.
  double energy(const Overlap&, Vec3 spring) const noexcept;
  double friction() const noexcept { return friction_; }

 private:
  double normal_stiffness_;   // 2 Y* [Pa]
  double shear_ratio_;        // S_t/S_n = 4 G*/Y* [-]
  double root_shear_ratio_;   // its square root [-]
  Damping damping_;           // of a dry collision
  double friction_;           // Coulomb's coefficient [-]
};

/// The share of a spring that a contact keeps as its radius changes within a step: a growing one keeps its force, a
/// shrinking one lets it fall with the radius, so that no energy is made (G6). The depth a step ago follows from the
/// closing speed (symplectic Euler: x^n = x^{n-1} + dt v^n): nothing to remember.
inline double kept_of_spring(double depth, double closing, double dt) noexcept {
  const double before = depth - closing * dt > 0 ? depth - closing * dt : 0;
  return before < depth ? 2 * before / (before + depth) : 1;   // at most a_before/a
}

/// Restitution of a Hertz collision damped by alpha sqrt(S_n m*) and never pulling, whatever its speed [-].
double restitution_of_damping(double alpha) noexcept;

/// Its inverse, for 0 < restitution <= 1 [-].
double damping_of_restitution(double restitution) noexcept;

inline Damping HertzMindlin::damping(double alpha) const noexcept {
  return {alpha, root_shear_ratio_ * strongest_shear_damping /
                     (alpha > strongest_shear_damping ? alpha : strongest_shear_damping)};
}

inline ContactForce HertzMindlin::respond(const Overlap& o, Vec3 spring, double dt, Damping damped) const noexcept {
  const bool touching = o.depth > 0;
  const double depth = touching ? o.depth : 0;
  const double closing = dot(o.velocity, o.normal);
  const Vec3 sliding = o.velocity - closing * o.normal;

  const double a = o.root_radius * std::sqrt(depth);                      // radius of the contact, (G1)
  const double stiffness = normal_stiffness_ * a;                         // S_n, (G2)
  const double damping = damped.normal * std::sqrt(stiffness * o.mass);   // gamma_n, (G4)
  const double push = stiffness * depth * (2.0 / 3) + damping * closing;
  const double normal_force = push > 0 ? push : 0;   // (G3), never pulls

  const double kept = kept_of_spring(depth, closing, dt);                       // (G6)
  spring = kept * (spring - dot(spring, o.normal) * o.normal) + dt * sliding;   // (G5)

  const double shear = shear_ratio_ * stiffness;                                // S_t
  Vec3 tangential = shear * spring + (damped.tangential * damping) * sliding;   // (G7)
  const double pull = norm(tangential), cap = friction_ * normal_force;
  const double scale = pull > cap ? cap / pull : 1;   // the spring slides with its contact, (G8)
  tangential *= scale;
  spring *= touching ? scale : 0;
  return {-(normal_force * o.normal + tangential), spring};
}

inline double HertzMindlin::normal_force(const Overlap& o, Damping damped) const noexcept {
  if (!(o.depth > 0)) return 0;
  const double stiffness = normal_stiffness_ * o.root_radius * std::sqrt(o.depth);
  const double damping = damped.normal * std::sqrt(stiffness * o.mass);
  return std::max(0.0, stiffness * o.depth * (2.0 / 3) + damping * dot(o.velocity, o.normal));
}

inline double HertzMindlin::shear_stiffness(const Overlap& o) const noexcept {
  return o.depth > 0 ? shear_ratio_ * (normal_stiffness_ * o.root_radius * std::sqrt(o.depth)) : 0;
}

inline double HertzMindlin::energy(const Overlap& o, Vec3 spring) const noexcept {
  if (!(o.depth > 0)) return 0;
  return 2.0 / 5 * normal_force(o, {}) * o.depth + shear_stiffness(o) * norm2(spring) / 2;
}

}   // namespace bedload

// What two overlapping spheres do to each other: laws as value types that mutate nothing.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/vec3.hpp"
#include "solver/grains/bed_scene.hpp"
#include "solver/grains/hertz_mindlin.hpp"

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

using Damping = DampingOf<double>;

/// Hertz's normal force with damping, Mindlin's spring with Coulomb's cap: docs/physics_grains.md, (G1)-(G8).
class HertzMindlin {
 public:
  /// Grains and walls are of one material. The damping is calibrated so that a collision rebounds with the restitution
  /// asked for although contacts never pull; below `lowest_restitution` it rebounds with that.
  explicit HertzMindlin(const GrainProperties&);

  /// Stronger damping, being explicit, would shake a bed of many contacts at the DEM steps in use instead of calming it.
  static constexpr double lowest_restitution = 0.1;
  static constexpr double strongest_shear_damping = bedload::strongest_shear_damping;

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
  double friction() const noexcept { return material_.friction; }
  /// For laws of other numbers than double.
  const ContactModuli<double>& material() const noexcept { return material_; }
  double root_shear_ratio() const noexcept { return root_shear_ratio_; }

 private:
  ContactModuli<double> material_;
  double root_shear_ratio_;   // of S_t/S_n [-]
  Damping damping_;           // of a dry collision
};

/// Restitution of a Hertz collision damped by alpha sqrt(S_n m*) and never pulling, whatever its speed [-].
double restitution_of_damping(double alpha) noexcept;

/// Its inverse, for 0 < restitution <= 1 [-].
double damping_of_restitution(double restitution) noexcept;

inline Damping HertzMindlin::damping(double alpha) const noexcept {
  return {alpha, root_shear_ratio_ * strongest_shear_damping /
                     (alpha > strongest_shear_damping ? alpha : strongest_shear_damping)};
}

inline ContactForce HertzMindlin::respond(const Overlap& o, Vec3 spring, double dt, Damping damped) const noexcept {
  const OverlapOf<double> contact{
      o.depth, o.root_radius, o.mass, {o.normal.x, o.normal.y, o.normal.z}, {o.velocity.x, o.velocity.y, o.velocity.z}};
  const auto r = hertz_mindlin(material_, contact, {spring.x, spring.y, spring.z}, dt, damped);
  return {{r.force.x, r.force.y, r.force.z}, {r.spring.x, r.spring.y, r.spring.z}};
}

inline double HertzMindlin::normal_force(const Overlap& o, Damping damped) const noexcept {
  if (!(o.depth > 0)) return 0;
  const double stiffness = material_.normal_stiffness * o.root_radius * std::sqrt(o.depth);
  const double damping = damped.normal * std::sqrt(stiffness * o.mass);
  return std::max(0.0, stiffness * o.depth * (2.0 / 3) + damping * dot(o.velocity, o.normal));
}

inline double HertzMindlin::shear_stiffness(const Overlap& o) const noexcept {
  return o.depth > 0 ? material_.shear_ratio * (material_.normal_stiffness * o.root_radius * std::sqrt(o.depth)) : 0;
}

inline double HertzMindlin::energy(const Overlap& o, Vec3 spring) const noexcept {
  if (!(o.depth > 0)) return 0;
  return 2.0 / 5 * normal_force(o, {}) * o.depth + shear_stiffness(o) * norm2(spring) / 2;
}

}   // namespace bedload

// Hertz's normal force with damping, Mindlin's spring with Coulomb's cap, written once for every kind of number.
#pragma once

#include "solver/grains/lanes.hpp"

namespace bedload {

/// What the law needs to know of the material.
template <class Number>
struct ContactModuli {
  Number normal_stiffness;   // 2 Y* [Pa]
  Number shear_ratio;        // S_t/S_n = 4 G*/Y* [-]
  Number friction;           // Coulomb's coefficient [-]
};

/// Stronger damping, being explicit, would shake a bed of many contacts: alpha of gamma_t = alpha sqrt(S_t m*) [-].
inline constexpr double strongest_shear_damping = 0.35;

/// How strongly a contact is damped, gamma_n = normal sqrt(S_n m*), gamma_t = tangential gamma_n (G4).
template <class Real>
struct DampingOf {
  Real normal;       // alpha [-]
  Real tangential;   // gamma_t/gamma_n [-]
};

/// Overlap of one contact, or of many side by side; see Overlap.
template <class Real>
struct OverlapOf {
  Real depth, root_radius, mass;
  Vector<Real> normal, velocity;
};

template <class Real>
struct ContactForceOf {
  Vector<Real> force, spring;
};

/// The share of a spring that a contact keeps as its radius changes within a step: a growing one keeps its force, a
/// shrinking one lets it fall with the radius, so that no energy is made (G6). The depth a step ago follows from the
/// closing speed (symplectic Euler: x^n = x^{n-1} + dt v^n): nothing to remember.
template <class Real>
BEDLOAD_INLINE Real kept_of_spring(Real depth, Real closing, Real dt) {
  const Real none{}, one = none + 1.0f;
  const Real back = depth - closing * dt, before = choose(back > none, back, none);
  return choose(before < depth, (before + before) / (before + depth), one);   // at most a_before/a
}

/// Force on the lower grain and new spring of a contact in a step dt; zero and zero for grains apart: (G1)-(G8).
template <class Real, class Number>
BEDLOAD_INLINE ContactForceOf<Real> hertz_mindlin(const ContactModuli<Number>& material, const OverlapOf<Real>& o,
                                                  Vector<Real> spring, Real dt, DampingOf<Real> damped) {
  const Real none{}, one = none + 1.0f;
  const auto touching = o.depth > none;
  const Real depth = choose(touching, o.depth, none);
  const Real closing = dot(o.velocity, o.normal);
  const Vector<Real> sliding = o.velocity - closing * o.normal;

  const Real a = o.root_radius * root(depth);                      // radius of the contact, (G1)
  const Real stiffness = material.normal_stiffness * a;            // S_n, (G2)
  const Real damping = damped.normal * root(stiffness * o.mass);   // gamma_n, (G4)
  const Real push = stiffness * depth * Number(2.0 / 3) + damping * closing;
  const Real normal_force = choose(push > none, push, none);   // (G3), never pulls

  const Real kept = kept_of_spring(depth, closing, dt);                         // (G6)
  spring = kept * (spring - dot(spring, o.normal) * o.normal) + dt * sliding;   // (G5)

  const Real shear = material.shear_ratio * stiffness;                                  // S_t
  Vector<Real> tangential = shear * spring + (damped.tangential * damping) * sliding;   // (G7)
  const Real pull = root(dot(tangential, tangential)), cap = material.friction * normal_force;
  const Real scale = choose(pull > cap, cap / pull, one);   // the spring slides with its contact, (G8)
  tangential = scale * tangential;
  spring = choose(touching, scale, none) * spring;
  return {-(normal_force * o.normal + tangential), spring};
}

}   // namespace bedload

// The grains as the contact pass reads them: everything about one grain in one place of memory.
#pragma once

#include "base/vec3.hpp"

namespace bedload {

/// A pair visits two grains far apart in memory: one block of 96 bytes each costs fewer cache lines than nine arrays.
/// Three rows of four numbers, as the contact pass loads them.
struct alignas(32) Body {
  Vec3 position;            // [m]
  double radius;            // [m]
  Vec3 velocity;            // [m/s]
  double inverse_mass;      // [1/kg]; 0 = fixed
  Vec3 spin;                // [rad/s]
  double inverse_inertia;   // [1/(kg m2)]; 0 = fixed
};
static_assert(sizeof(Body) == 96);

/// What the contacts of a grain add up to: two rows of four.
struct alignas(32) Load {
  Vec3 force;   // [N]
  double unused = 0;
  Vec3 torque;   // [N m]
  double unused_too = 0;

  Load& operator+=(const Load& b) { return force += b.force, torque += b.torque, *this; }
};
static_assert(sizeof(Load) == 64);

}   // namespace bedload

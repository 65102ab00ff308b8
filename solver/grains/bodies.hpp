// The grains as the contact pass reads them: everything about one grain in one place of memory.
#pragma once

#include "base/vec3.hpp"

namespace bedload {

/// Grains lie in rows of four numbers, which are loaded and stored whole.
using BodyRow = double __attribute__((vector_size(32), may_alias));

inline BodyRow load_body_row(const double* at) {
  return *static_cast<const BodyRow*>(__builtin_assume_aligned(at, 32));
}
inline void store_body_row(double* at, BodyRow row) { *static_cast<BodyRow*>(__builtin_assume_aligned(at, 32)) = row; }

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
};
static_assert(sizeof(Load) == 64);

/// Adds a load to a sum, and clears it for the next step.
inline void book(Load& load, Load& sum) noexcept {
  store_body_row(&sum.force.x, load_body_row(&sum.force.x) + load_body_row(&load.force.x));
  store_body_row(&sum.torque.x, load_body_row(&sum.torque.x) + load_body_row(&load.torque.x));
  store_body_row(&load.force.x, BodyRow{}), store_body_row(&load.torque.x, BodyRow{});
}

}   // namespace bedload

// The grains as contacts and motion read them: everything about one grain in one place of memory.
#pragma once

#include <vector>

#include "base/vec3.hpp"

namespace bedload {

/// A grain as its partners meet it: one line of the cache, read whole for each of its pairs. Place in double; what only
/// the law of contact reads in float.
struct alignas(64) Sphere {
  Vec3 position;       // [m]
  double radius;       // [m]
  float velocity[3];   // [m/s]
  float unused = 0;
  float surface_velocity[3];   // r omega [m/s]
  float unused_too = 0;
};
static_assert(sizeof(Sphere) == 64);

inline Sphere sphere_of(Vec3 position, double radius, Vec3 velocity, Vec3 spin) {
  const auto real = [](double x) { return static_cast<float>(x); };
  const Vec3 surface = radius * spin;
  return {position,
          radius,
          {real(velocity.x), real(velocity.y), real(velocity.z)},
          0,
          {real(surface.x), real(surface.y), real(surface.z)}};
}

/// A grain as its motion goes on: the velocities of record.
struct alignas(64) Motion {
  Vec3 velocity;            // [m/s]
  double inverse_mass;      // [1/kg]; 0 = fixed
  Vec3 spin;                // [rad/s]
  double inverse_inertia;   // [1/(kg m2)]; 0 = fixed
};
static_assert(sizeof(Motion) == 64);

struct Bodies {
  std::vector<Sphere> spheres;
  std::vector<Motion> motions;
  std::size_t size() const { return spheres.size(); }
};

/// What acts on a grain besides contacts.
struct alignas(32) Push {
  Vec3 acceleration;   // [m/s2]
  double damp;         // 1/(1 + dt rate) of the implicit linear drag to rest [-]
};

/// What the contacts of a grain add up to.
struct alignas(64) Load {
  Vec3 force;   // [N]
  double unused = 0;
  Vec3 torque;   // [N m]
  double unused_too = 0;
};
static_assert(sizeof(Load) == 64);

/// Loads of some sub-steps, added up.
struct alignas(16) LoadSum {
  Vec3 force;    // [N]
  Vec3 torque;   // [N m]
};
static_assert(sizeof(LoadSum) == 48);

/// What a contact does to its lower grain; its partner gets the opposite force and the same torque per radius.
struct alignas(32) ContactLoad {
  float force[3];   // [N]
  float unused = 0;
  float torque_per_radius[3];   // [N]
  float unused_too = 0;
};
static_assert(sizeof(ContactLoad) == 32);

}   // namespace bedload

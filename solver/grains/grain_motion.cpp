// v += dt (push + F/m), x += dt v: no memory but position and velocity themselves.
#include "solver/grains/grain_motion.hpp"

namespace bedload {

void move_bodies(std::span<Body> bodies, std::span<Load> loads, std::span<const Vec3> push,
                 std::span<const double> damp, double dt, std::span<Load> sums) noexcept {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    Body& b = bodies[i];
    if (b.inverse_mass != 0) {
      b.velocity = pushed(b, loads[i].force, push[i], damp[i], dt);
      b.spin += (dt * b.inverse_inertia) * loads[i].torque;
      b.position += dt * b.velocity;
    }
    book(loads[i], sums[i]);
  }
}

void spin_bodies(std::span<Body> bodies, std::span<const Vec3> spin_push, double dt) noexcept {
  for (std::size_t i = 0; i < spin_push.size(); ++i)
    if (bodies[i].inverse_mass != 0) bodies[i].spin += dt * spin_push[i];
}

}   // namespace bedload

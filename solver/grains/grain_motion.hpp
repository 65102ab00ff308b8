// Newton's laws for grains over one DEM step.
#pragma once

#include <span>

#include "solver/grains/bodies.hpp"

namespace bedload {

/// Velocity that a body has after a step under this force [m/s]. `push` [m/s2] acts beside it; `damp` = 1/(1 + dt rate)
/// is the implicit linear drag to rest [-].
inline Vec3 pushed(const Body& b, Vec3 force, Vec3 push, double damp, double dt) noexcept {
  return damp * (b.velocity + dt * (push + b.inverse_mass * force));
}

/// Symplectic Euler: velocity and spin from the loads, then place from the new velocity. Fixed bodies stay as they are.
/// The loads are added to `sums` and cleared for the next step.
void move_bodies(std::span<Body>, std::span<Load>, std::span<const Vec3> push, std::span<const double> damp, double dt,
                 std::span<Load> sums) noexcept;

/// Turns bodies that are not fixed faster by `spin_push` [rad/s2]; empty: nothing happens.
void spin_bodies(std::span<Body>, std::span<const Vec3> spin_push, double dt) noexcept;

}   // namespace bedload

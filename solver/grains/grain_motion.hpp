// Newton's laws for grains over one DEM step.
#pragma once

#include <span>

#include "solver/grains/bodies.hpp"

namespace bedload {

/// Symplectic Euler: velocity and spin from the loads, then place from the new velocity. `push` [m/s2] acts beside the
/// contacts; `damp` = 1/(1 + dt rate) is the implicit linear drag to rest [-]. Fixed bodies stay as they are.
void move_bodies(std::span<Body>, std::span<const Load>, std::span<const Vec3> push, std::span<const double> damp,
                 double dt) noexcept;

/// Turns mobile bodies faster by `spin_push` [rad/s2]; empty: nothing happens.
void spin_bodies(std::span<Body>, std::span<const Vec3> spin_push, double dt) noexcept;

}   // namespace bedload

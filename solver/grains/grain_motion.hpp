// Newton's law for a grain over one DEM step, for those who ask what it would do. GrainKernels::move does it.
#pragma once

#include "solver/grains/bodies.hpp"

namespace bedload {

/// Velocity that a grain has after a step under this force [m/s].
inline Vec3 pushed(const Motion& m, Vec3 force, const Push& push, double dt) noexcept {
  return push.damp * (m.velocity + dt * (push.acceleration + m.inverse_mass * force));
}

}   // namespace bedload

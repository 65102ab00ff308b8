// How fast the flow crosses cells.
#pragma once

#include <cmath>

#include "solver/fluid/rows.hpp"

namespace bedload {

/// Largest speeds of the components, gathered row by row by whoever passes the velocity anyway.
class Courant {
 public:
  void add_row(int c, const double* velocity, int length) noexcept {
    fastest_[c].add_row(length, [=](int k) { return std::abs(velocity[k]); });
  }
  /// Cells that the flow crosses per time, summed over the directions [1/s]: CFL = rate x step.
  double rate(const Vec3& h) const noexcept {
    return fastest_[0].value() / h.x + fastest_[1].value() / h.y + fastest_[2].value() / h.z;
  }

 private:
  LaneMax fastest_[3];
};

}   // namespace bedload

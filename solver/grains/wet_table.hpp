// Damping against how viscous an approach is, tabulated.
#pragma once

#include "solver/grains/lanes.hpp"

namespace bedload {

/// A view of WetRestitution's table.
struct WetTable {
  const double* alpha;   // for e = e_dry exp(-n/per_fold); the last for the lowest restitution [-]
  double cells;          // entries but one [-]
  double per_fold;       // entries per factor 1/e of restitution [-]

  /// Damping alpha of a contact that begins at this speed [-]; that of the slowest ones if it is not approaching.
  BEDLOAD_INLINE double damping(double viscous_speed, double approach) const {
    double place = per_fold * viscous_speed / (approach > 1e-200 ? approach : 1e-200);
    place = place < cells ? place : cells;
    const auto cell = static_cast<int>(place < cells - 1 ? place : cells - 1);
    return alpha[cell] + (place - cell) * (alpha[cell + 1] - alpha[cell]);
  }
};

}   // namespace bedload

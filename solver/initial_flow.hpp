// The fluid before anything has moved.
#pragma once

#include "solver/fluid/fluid_state.hpp"
#include "solver/scene.hpp"

namespace bedload {

/// At rest, or Taylor & Green's vortices (1937, Proc. R. Soc. Lond. A 158, 499) in x and y, one period of the box in each:
/// u = U sin kx cos ly, v = -(k/l) U cos kx sin ly, free of divergence also on the grid.
FluidState initial_flow(const Scene&);

}   // namespace bedload

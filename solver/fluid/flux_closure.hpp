// What the averaged volume flux lacks to close on the control volume of each face.
#pragma once

#include <vector>

#include "solver/fluid/staggered_grid.hpp"

namespace bedload {

/// Correction D [m/s] of component c's flux along c, at cell centres (centre i stands at the index of face i; in a
/// periodic direction also at -1): D_right = D_left - h_c S_f with S_f = (eps'_f - eps_f)/dt + half the sum of the two
/// cells' div F, less the mean of S over its line, which is the residual of a projection. Cells outside a wall count
/// zero. Between walls D is zero outside them and the walls' own faces, with their half control volumes, are part of
/// the line; in a periodic line the mean of D is zero. `divergence` has its ghosts filled: periodic copies, zero beyond
/// walls. On the lines of one plane: that of y-index `plane` for c = 0, else of x-index. `sums` is scratch.
void close_flux(const StaggeredGrid&, int c, int plane, const Field<Centre>& divergence, const double* void_before,
                const double* void_after, double dt, double* correction, std::vector<double>& sums);

}   // namespace bedload

// Coefficients of the pressure equation over beds of several shapes.
#pragma once

#include "solver/fluid/staggered_grid.hpp"

namespace bedload::test {

enum class Bed { sharp_plane, rough_surface, dunes, random_cells };

/// 1 in clear fluid, 1/contrast inside the bed; faces take the mean of their cells, as a deposit with a hat does.
FaceFields bed_coefficient(const StaggeredGrid&, Bed, double contrast);

}   // namespace bedload::test

// The void fraction of the faces, for whoever reads a state from outside the coupled step.
#pragma once

#include "solver/fluid/staggered_grid.hpp"
#include "solver/grains/grains.hpp"
#include "solver/scene.hpp"

namespace bedload {

/// eps on the faces for the grains where they are now [-].
FaceFields face_void_fraction(const StaggeredGrid&, const Grains&, const Smoothing&);

}   // namespace bedload

// Grains and fluid as a study file gives them: each property as it stands, or by dimensionless groups.
#pragma once

#include "studies/input_list.hpp"

namespace bedload {

/// Takes over grains.density, grains.diameter and fluid.viscosity in SI. grains.density_ratio (s) stands for the density: s times
/// the fluid's. fluid.galileo (Ga = sqrt(|s-1| g d^3)/nu) stands for the diameter or for the viscosity, whichever is not given.
/// What a group picks is rounded, so that the case written with what was picked is the same case. Needs fluid.density and
/// box.gravity; a file that gives too much or too little is a problem at the place of the group.
void take_properties(InputList&);

}   // namespace bedload

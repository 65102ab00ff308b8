// A lone grain that falls where a bed would be: what mesh, terms and steps make of the one motion whose law is known.
#pragma once

#include <array>
#include <cmath>

#include "solver/scene.hpp"

namespace bedload {

/// Where nothing falls.
inline constexpr std::array<double, 4> no_falls{NAN, NAN, NAN, NAN};

/// Speeds [m/s] at which one grain of the scene falls through the middle of its box, without bed and without flow: between 0.55 and 0.35 of the
/// height, let go at 0.75, over four places within a cell (corner, middles of two edges, centre). Fluid, mesh, laws, terms and steps are the
/// scene's. no_falls where nothing does, or the scene's terms want a bed.
std::array<double, 4> lone_fall_speeds(const Scene&);

}   // namespace bedload

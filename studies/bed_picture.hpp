// A side view of a bed: the front slice of its grains, coloured by speed.
#pragma once

#include <string>

#include "studies/report.hpp"

namespace bedload {

/// Inline SVG, `width` pixels wide: x to the right, z up. Shows the grains of the front five diameters (all of a narrower
/// box), farther ones through haze.
std::string bed_picture(const BedView&, double width);

/// The colours of the picture, as a bar with its scale: speed/sqrt((s-1) g d), four decades.
std::string speed_scale_bar();

}   // namespace bedload

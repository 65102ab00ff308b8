// What a bed will be like before it is packed: its depth, its smallest grain.
#pragma once

#include "solver/grains/bed_scene.hpp"

namespace bedload {

/// Solid fraction of grains that settled with friction (measured: 0.56-0.60). Only estimates rest on it.
inline constexpr double loose_packing = 0.58;

/// Depth at loose packing [m]. A table's grains count at the mean diameter.
double expected_bed_depth(const BedScene&);

/// The smallest diameter that the spread allows (the distribution is cut at two deviations) [m].
double smallest_diameter(const BedScene&);
double largest_diameter(const BedScene&);

/// Rayleigh time of the smallest grain [s]; the DEM step is judged by it.
double smallest_rayleigh_time(const BedScene&);

}   // namespace bedload

// A bed from a table of grains.
#pragma once

#include "solver/grains/bed_scene.hpp"
#include "solver/grains/grains.hpp"

namespace bedload {

/// Grains from the rows of scene.source.csv: x,y,z,diameter,density,fixed in SI under a header of these names. Columns
/// vx,vy,vz (velocity to begin with) and wx,wy,wz (spin) may follow, in this order, both or either; without, grains are at
/// rest. Refuses (study_invalid), naming rows: a table without grains, what is not a number, sizes and densities that are
/// not positive, fixed grains that move, grains outside the box, two at one place, and overlaps deeper than a settled bed
/// has (1 % of the smaller diameter).
Grains read_grain_table(const BedScene&);

}   // namespace bedload

// A bed from a table of grains.
#pragma once

#include "solver/grains/bed_scene.hpp"
#include "solver/grains/grains.hpp"

namespace bedload {

/// Grains from the rows of scene.source.csv: x,y,z,diameter,density,fixed in SI under a header of these names, at rest; or
/// with six more columns, vx,vy,vz,wx,wy,wz: velocity and spin that they begin with. Refuses (study_invalid), naming rows: a table without grains, what is not a number, sizes and densities that are not positive, grains
/// outside the box, two at one place, and overlaps deeper than a settled bed has (1 % of the smaller diameter).
Grains read_grain_table(const BedScene&);

}   // namespace bedload

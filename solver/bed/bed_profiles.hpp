// Profiles over height: porosity, fluid velocity, grain velocity.
#pragma once

#include "solver/bed/bed_record.hpp"
#include "solver/fluid/fluid_state.hpp"
#include "solver/grains/grains.hpp"

namespace bedload {

/// Appends one row per layer of about d/4: its middle z, porosity, mean streamwise fluid velocity (linear between the
/// planes of the grid) mean streamwise grain velocity and granular
/// temperature <|v - mean v|^2>/3, weighted by the grains' exact slices; 0 where there is no grain.
void record_profiles(const Grains&, const FluidState&, const StaggeredGrid&, double diameter, double lid_speed,
                     double hold, BedRecord::Profiles&);

/// Mean streamwise velocity u [m/s] of every plane of cells, from the bottom up.
std::vector<double> plane_means(const Field<FaceX>& u, const StaggeredGrid&);

}   // namespace bedload

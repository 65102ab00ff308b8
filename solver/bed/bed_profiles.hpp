// Profiles over height, averaged over the instants of a hold: porosity, velocities, granular temperature.
#pragma once

#include <span>
#include <vector>

#include "solver/bed/bed_record.hpp"
#include "solver/fluid/fluid_state.hpp"
#include "solver/grains/grains.hpp"

namespace bedload {

/// Sums over instants of what a profile is made of, by layers of about d/4 from the bottom up.
struct ProfileSums {
  double instants = 0;
  std::vector<double> solid;            // volume of the grains' exact slices [m3]
  std::vector<Vec3> motion;             // times the grains' velocities [m4/s]
  std::vector<double> squares;          // times their squares [m5/s2]
  std::vector<double> fluid_velocity;   // linear between the planes of the grid and up to the walls' speed [m/s]
  bool operator==(const ProfileSums&) const = default;
};

/// Adds grains and flow as they are now; sums without an instant need no size.
void add_instant(const Grains&, const FluidState&, const StaggeredGrid&, double diameter, double lid_speed,
                 ProfileSums&);

/// Appends one row per layer: its middle z, and the means over the instants of porosity, streamwise fluid velocity, streamwise
/// grain velocity and granular temperature <|v - mean v|^2>/3, grains weighted by volume; 0 where there never was one.
void record_profiles(const ProfileSums&, Vec3 length, double hold, BedRecord::Profiles&);

/// The level of effective rebounds (Paehtz and Duran) of a profile in equal layers: where P_s dv_x/dz is largest, P_s the submerged weight of the grains
/// above, by a parabola through the three faces between layers about the maximum [m]; nan where no layer is sheared downstream.
double rebound_level(std::span<const double> z, std::span<const double> porosity,
                     std::span<const double> grain_velocity);

/// Mean streamwise velocity u [m/s] of every plane of cells, from the bottom up.
std::vector<double> plane_means(const Field<FaceX>& u, const StaggeredGrid&);

}   // namespace bedload

// Everything a run remembers of its bed: the future rows of the database travel with the state.
#pragma once

#include <cstdint>
#include <vector>

#include "solver/bed/hold_health.hpp"

namespace bedload {

/// Columns of equal length; one row per sample, per finished hold, per profile bin. SI, units as in each_field.
struct BedRecord {
  struct SettledBed {   // as the flow finds it
    double solid_fraction = 0, coordination = 0;
    double shear_flux = 0;   // in the last half of the shear that it had before, if any
    bool operator==(const SettledBed&) const = default;
  } settled;
  struct Samples {   // every record.every seconds
    std::vector<double> time, hold, shields_nominal, shields_measured, bed_height, roughness, coordination, flux,
        moving_fraction, moved_grains, moving_speed, deepest_overlap, momentum_residual;
    bool operator==(const Samples&) const = default;
  } samples;
  struct Holds {   // one row per finished hold; purpose and verdict are numbers of HoldPurpose and HoldVerdict
    std::vector<double> hold, purpose, level, verdict, start, end, shields_nominal, shields_measured, shields_lid,
        stress_residual, lid_speed, gradient, flux, flux_standard_error, moving_fraction, moved_grains, bed_height,
        bed_top, slope, roughness, porosity, coordination, bearing_coordination, momentum_residual;
    bool operator==(const Holds&) const = default;
  } holds;
  struct Health {   // one row per finished hold
    using Measures = HealthMeasures<std::vector<double>>;
    std::vector<double> hold;
    Measures measures;
    bool operator==(const Health&) const = default;
  } health;
  struct Hops {   // one row per finished hold, over its last half; mean and standard deviation of what ended in it
    std::vector<double> hold, duration, entrained, deposited, hops, hop_length, hop_length_deviation, hop_duration,
        hop_duration_deviation, rests, rest_time, rest_time_deviation;
    bool operator==(const Hops&) const = default;
  } hops;
  struct HopHistograms {   // Spread::bins rows per finished hold; lower edge in d or t_d, numbers of hops and rests
    std::vector<double> hold, lower, by_length, by_duration, rests;
    bool operator==(const HopHistograms&) const = default;
  } hop_histograms;
  struct Profiles {   // of the settled bed (hold -1), and over the last half of every hold; mean over x and y
    std::vector<double> hold, z, porosity, fluid_velocity, grain_velocity, granular_temperature;
    bool operator==(const Profiles&) const = default;
  } profiles;
  struct Tracks {   // record.tracks, one row per sample and tracked grain
    std::vector<double> time, grain, x, y, z, vx, vy, vz, wx, wy, wz;
    bool operator==(const Tracks&) const = default;
  } tracks;
  bool operator==(const BedRecord&) const = default;
};

}   // namespace bedload

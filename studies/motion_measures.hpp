// What else the holds of a study say of its thresholds: when grains move, the reference transport, the law of the flux.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scheduler/database.hpp"

namespace bedload {

/// Where a Shields number lies [-]: a point where it was found, 0 or infinity where one end is open.
struct ShieldsBounds {
  double lower = 0, upper = 0;
  bool operator==(const ShieldsBounds&) const = default;
};

/// Of a number that each seed knows, or knows bounds of. The k-th smallest of numbers lies between the k-th smallest of their
/// lower and of their upper bounds, hence so do these.
struct OverSeeds {
  ShieldsBounds median, least, greatest;
  std::uint64_t seeds = 0;   // that say anything
};
/// All is 0 where no seed says anything.
OverSeeds over_seeds(const std::vector<ShieldsBounds>&);

/// q* = k (theta - theta_0)^n of every seed that has one.
struct FluxLaws {
  double exponent = 0;          // n
  OverSeeds threshold;          // theta_0
  double threshold_error = 0;   // median of the seeds' standard errors [-]
};

/// One parameter set, from tables thresholds and flux_laws.
struct MotionMeasures {
  std::string set, label;
  OverSeeds first_grain, one_percent, ten_percent;   // of the surface grains had moved within a hold
  OverSeeds reference_transport;                     // W* = 0.002
  std::optional<FluxLaws> flux_law;
};

/// In the order of the threshold curve; sets of which nothing is known are left out.
std::vector<MotionMeasures> motion_measures(const Database&);

/// "0.1120 (0.1080-0.1200)": the median, and of several seeds the least and the greatest; open ends as "< 0.06", "> 0.30".
std::string in_words(const OverSeeds&);
/// "0.1040 +- 0.0030 (0.0980-0.1100)": of theta_0, with its standard error.
std::string in_words(const FluxLaws&);
/// For people, below the threshold curve; empty where nothing is known.
std::string motion_as_table(const std::vector<MotionMeasures>&);

}   // namespace bedload

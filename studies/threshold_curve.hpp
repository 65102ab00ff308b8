// The threshold curve: per parameter set, the Shields number at onset over all seeds.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scheduler/database.hpp"

namespace bedload {

/// One parameter set. A bound or value that the runs do not give is nan.
struct ThresholdPoint {
  std::string set, label;
  double diameter = 0;           // [m]
  double density_ratio = 0;      // s [-]
  double viscosity = 0;          // nu [m2/s]
  double cell_z = 0;             // height of the cells, per diameter: thresholds depend on it [-]
  std::string criterion;         // flux | moving_fraction, of the surface grains
  double criterion_value = 0;    // from which on the bed counts as moving [-]
  double galileo = 0;            // sqrt((s-1) g d^3)/nu [-]
  double reynolds = 0;           // Re* = sqrt(theta) Ga of theta_c, or of the one bound there is [-]
  double shields = 0;            // theta_c, median over the seeds [-]
  double lower = 0, upper = 0;   // lowest and highest bound of any seed [-]
  std::string status;            // bracketed | censored_below | censored_above | noisy
  std::uint64_t seeds = 0;       // finished
  std::uint64_t bracketed = 0, censored_below = 0, censored_above = 0, noisy = 0;   // of them
  std::string method = "ramp";                                                      // ramp (screening) | bisect
};

/// Recomputes table threshold_curve from the thresholds of the cases that are in the study, in one transaction. Called
/// with every case's results; to be called too when cases leave or rejoin the study.
void update_threshold_curve(Database&);

/// The curve, ordered by diameter, density ratio, viscosity, then parameter set.
std::vector<ThresholdPoint> threshold_curve(const Database&);

/// For people: aligned columns, and the laminar band and turbulent curves at the same Galileo number beside ours; below them
/// what counts as onset, and what a bound that is missing and a noisy ramp mean, where there are such.
std::string curve_as_table(const std::vector<ThresholdPoint>&);
/// "onset: flux >= 0.01 per surface grain and td; cells 0.5 d high".
std::string onset_in_words(const std::vector<ThresholdPoint>&);
/// For programs: shortest numbers that read back to the same bits, fixed order; an empty field where there is no value.
std::string curve_as_csv(const std::vector<ThresholdPoint>&);
std::string curve_as_json(const std::vector<ThresholdPoint>&);

}   // namespace bedload

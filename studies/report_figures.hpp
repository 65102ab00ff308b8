// The figures of the report, each from the tables it names.
#pragma once

#include <string>
#include <vector>

#include "scheduler/database.hpp"
#include "studies/threshold_curve.hpp"

namespace bedload {

/// Whether a ramp gave the threshold: it says where to look, bisection says where it is.
bool is_screening(const ThresholdPoint&);
/// Table threshold_curve, beside the published curves: theta_c over Re*, logarithmic; open markers with arrows are bounds.
std::string threshold_figure(const std::vector<ThresholdPoint>&);
/// Whether one grain in one liquid is looked at in several ways (slopes, meshes, terms): on the curve they lie over each other.
bool of_one_grain(const std::vector<ThresholdPoint>&);
/// Those, row by row: theta_c with its bar, theta_stop.
std::string side_by_side_figure(const std::vector<ThresholdPoint>&);

/// A case whose results are stored.
struct FinishedCase {
  std::string id, label;
  double diameter = 0;   // [m]
};
/// In the order of the curve, cases of the study only.
std::vector<FinishedCase> finished_cases(const Database&);

/// Tables ramp_points and thresholds: flux of every hold over its measured Shields number, the criterion, the bracket.
std::string flux_figure(const Database&, const FinishedCase&);
/// Table bed_statistics: porosity before the ramp and after it; fluid and grain velocity at its end.
std::string porosity_figure(const Database&, const FinishedCase&);
std::string velocity_figure(const Database&, const FinishedCase&);
/// Table samples: moving fraction in time, every other hold shaded.
std::string history_figure(const Database&, const FinishedCase&);
/// Table samples: bed height in time, in diameters, every other hold shaded.
std::string height_figure(const Database&, const FinishedCase&);
/// View transport_curve: q* over the measured Shields number of every hold that transports, coloured by diameter.
std::string transport_figure(const Database&);
/// Tables samples and motion_decay: moving grains since the beginning of a hold and the curve fitted to them, for the first
/// holds that have one. Empty where none has.
std::string decay_figure(const Database&, const FinishedCase&);

}   // namespace bedload

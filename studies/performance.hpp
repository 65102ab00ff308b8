// How fast a case ran, and where the time went.
#pragma once

#include <array>
#include <string>

#include "solver/coupler.hpp"

namespace bedload {

/// Sums over the coupled steps of one attempt.
struct Performance {
  double grain_steps = 0;   // grains x DEM steps
  double cell_steps = 0;    // cells x fluid steps
  double fluid_steps = 0;
  double substeps = 0;                       // DEM steps
  std::array<double, 6> shortened{};         // fluid steps shortened, by StepLimit
  double void_clamps = 0, unconverged = 0;   // fluid steps with either
  double model_time = 0;                     // [s]

  void add(const StepHealth&, std::size_t grains, std::size_t cells);
};

/// Lines for people: grain-steps/s, fluid cell-steps/s, model seconds per hour, share of each part of the step, length of
/// the steps and what shortened them.
std::string describe(const Performance&, const StepTimes&);

}   // namespace bedload

// Which models a scene requires: its dimensionless numbers decide, and each decision says why.
#pragma once

#include <string>
#include <vector>

#include "solver/scene.hpp"

namespace bedload {

/// The numbers that the rules read. Those of the flow are nan where nothing drives it.
struct SceneNumbers {
  double density_ratio = 0;       // s [-]
  double galileo = 0;             // Ga [-]
  double grain_time = 0;          // t_d [s]; nan for grains no heavier than the fluid
  double settling_reynolds = 0;   // of a lone grain at its terminal speed [-]
  double solid_fraction = 0;      // of the bed [-]
  double bed_depth = 0;           // expected, in grain diameters [-]
  double gap = 0;                 // that the bed leaves below the top [m]
  double lowest_shields = 0;      // imposed [-]
  double highest_shields = 0;
  double shields = 0;             // at which the numbers below are quoted [-]
  double friction_reynolds = 0;   // Re* [-]
  double shear_reynolds = 0;      // Re_g [-]
  double flow_speed = 0;          // laminar: of the lid, or mean over the gap [m/s]
  double gap_reynolds = 0;        // flow_speed gap/nu [-]
  double impact_stokes = 0;       // of a grain carried by the shear [-]
};

/// An unresolved laminar bed begins to move near theta = 0.2 (mean-field estimate 0.19-0.21): what depends on the flow is
/// quoted there, whatever the ramp's end, so that the same scene always gets the same answer.
inline constexpr double quoted_shields = 0.2;

SceneNumbers numbers_of(const Scene&);

struct ModelChoice {
  std::string term;      // "drag", "viscous_torque", ...
  bool on = false;       // in this run
  bool wanted = false;   // by the rules
  double ratio = 0;      // the number that decided
  std::string reason;    // with that number, and what leaving the term out costs
};

/// The decision for every term the rules know, also for those this version does not have.
std::vector<ModelChoice> required_models(const Scene&);

/// What a reader of the results must be told: turbulence assumed away, terms wanted but off. Empty if nothing.
std::vector<std::string> warnings_of(const Scene&);

}   // namespace bedload

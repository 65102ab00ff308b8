// Which models a scene requires: its dimensionless numbers decide, and each decision says why.
#pragma once

#include <string>
#include <vector>

#include "solver/scene_numbers.hpp"

namespace bedload {

struct ModelChoice {
  std::string term = {};     // "drag", "viscous_torque", ...: named_terms, and rolling_friction
  bool on = false;           // in this run
  bool wanted = false;       // by the rules
  double ratio = 0;          // the number that decided; nan where there is none
  std::string reason = {};   // with that number and its threshold, and what leaving the term out is worth
};

/// The decision for every term (docs/physics.md). Asks for nothing that the scene cannot carry; of wet_restitution and
/// lubrication, which are alternatives, for one; never for exposure.
std::vector<ModelChoice> required_models(const SceneFacts&);

/// The rung of the fluid that the scene stands on, and what "auto" would take: as one more decision.
ModelChoice fluid_choice(const Scene&);

/// That, and then the decision for every term: what plan, explain, case.toml and the database show.
std::vector<ModelChoice> decisions_of(const Scene&);

/// The terms that the rules want: what terms = "auto" stands for. Does not depend on scene.terms, nor on how far a ramp goes.
Terms wanted_terms(const Scene&);

/// What a reader of the results must be told: the scene is outside a model's range (range_problems_of), terms are wanted but
/// off, nothing joins grains and fluid. Empty if nothing.
std::vector<std::string> warnings_of(const SceneFacts&);

}   // namespace bedload

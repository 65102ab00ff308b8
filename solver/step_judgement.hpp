// When a step went too badly to go on from: the one place where StepHealth is judged.
#pragma once

#include <string>

#include "solver/coupler.hpp"

namespace bedload {

/// Why a run cannot go on from such a step; empty if it can. Numbers in the message are the step's and the limit's
/// (docs/physics_coupling.md, "Steps that are taken again").
std::string ailment(const StepHealth&);

/// How often a step is undone and taken again at half its length before the run fails.
inline constexpr int most_retries = 6;
/// Good steps after which a ceiling that a retry has put on the fluid step is doubled.
inline constexpr std::uint64_t steps_to_recover = 20;

}   // namespace bedload

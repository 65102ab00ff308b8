// Water that rises through a bed: what its pressure drops, and when that carries the bed. Measures of two rungs of group bed.
#pragma once

#include <vector>

#include "studies/validation.hpp"

namespace bedload {

/// A bed that is lifted: the drop is its submerged weight.
Findings fluidised_bed(const std::vector<FinishedCase>&);

/// A bed that settled in still fluid, at fluxes below and above minimum fluidisation.
Findings minimum_fluidisation(const std::vector<FinishedCase>&);

}   // namespace bedload

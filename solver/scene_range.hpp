// Where a scene leaves the range of what describes it: laws, closures, cells, what is not modelled at all.
#pragma once

#include <vector>

#include "solver/scene_numbers.hpp"

namespace bedload {

/// Nothing here stops a run: the numbers come out, for a model that does not hold. Each names the parameter to blame, the
/// fact with its limit, and what would be inside. With models.strict they are errors. docs/physics.md, section 3.
std::vector<SceneProblem> range_problems_of(const SceneFacts&);

}   // namespace bedload

// When a run cannot go on.
#pragma once

#include <string>

#include "solver/coupler.hpp"

namespace bedload {

/// Why a run cannot go on after such a step; empty if it can.
std::string ailment(const StepHealth&);

}   // namespace bedload

// What is in a state, a line per field, for people.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "solver/state.hpp"

namespace bedload {

struct FieldSummary {
  std::string name;                   // as in the file, "grains/position"
  std::string unit;                   // "1" for pure numbers
  std::vector<std::uint64_t> shape;   // empty for a single number
  double min = 0, max = 0;            // of the numbers that are not nan; both nan if there is none
};

/// Every field of State in the order of the file.
std::vector<FieldSummary> summarise(const State&);

}   // namespace bedload

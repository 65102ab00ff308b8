// Extremes of every field, found through the same list that a checkpoint is written by.
#include "checkpoint/inspect.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "solver/plain_numbers.hpp"

namespace bedload {

std::vector<FieldSummary> summarise(const State& state) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<FieldSummary> fields;
  State::each_field(state, [&](const std::string& name, const auto& field, const std::string& unit) {
    as_numbers(field, [&](auto numbers, ShapeView shape) {
      FieldSummary summary{name, unit, {shape.begin(), shape.end()}, nan, nan};
      for (const auto number : numbers) {   // fmin and fmax prefer the number to the nan
        summary.min = std::fmin(summary.min, double(number));
        summary.max = std::fmax(summary.max, double(number));
      }
      fields.push_back(std::move(summary));
    });
  });
  return fields;
}

}   // namespace bedload

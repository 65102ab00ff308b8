// The limits of health.
#include "studies/ailment.hpp"

#include <fmt/format.h>

namespace bedload {

namespace {

constexpr double hopeless_overlap = 0.5;   // of a contact, per diameter: grains have passed through each other

}   // namespace

std::string ailment(const StepHealth& health) {
  if (!health.finite) return "a velocity, force or pressure is not finite";
  if (health.lost_grain)
    return fmt::format("a grain moved {:.2g} cells in one step, or its centre passed a wall", health.grain_travel);
  if (health.deepest_overlap > hopeless_overlap)
    return fmt::format("grains overlap by {:.2g} of a diameter (at most {} can be healed)", health.deepest_overlap,
                       hopeless_overlap);
  return {};
}

}   // namespace bedload

// The memory of the contacts: which pairs touch, and their tangential springs.
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec3.hpp"

namespace bedload {

/// A wall takes part in contacts under an id above every grain's, so that walls come last in every ordered sum.
enum class Wall : std::uint32_t { x_low = 0xFFFFFFF0u, x_high, y_low, y_high, z_low, z_high };

/// Touching pairs (lower id, higher id or Wall), sorted by lower then higher. Nothing else is remembered.
struct ContactHistory {
  std::vector<std::uint32_t> lower, higher;
  std::vector<Vec3> spring;   // tangential spring, of the force on the lower grain [m]

  std::size_t size() const { return lower.size(); }
  bool operator==(const ContactHistory&) const = default;
};

}   // namespace bedload

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
  std::vector<Vec3> spring;      // tangential spring, of the force on the lower grain [m]
  std::vector<double> damping;   // alpha of the normal damping, chosen when the contact began [-]; empty: all alike
  std::vector<Vec3> rolling;     // rolling spring, of the torque on the lower grain [rad]; empty: no rolling friction

  std::size_t size() const { return lower.size(); }
  bool operator==(const ContactHistory&) const = default;
};

inline bool is_wall(std::uint32_t partner) { return partner >= static_cast<std::uint32_t>(Wall::x_low); }

/// Contact `k` of another history, under these ids; they must come after those that are there.
inline void append(ContactHistory& to, const ContactHistory& from, std::size_t k, std::uint32_t lower,
                   std::uint32_t higher) {
  to.lower.push_back(lower), to.higher.push_back(higher), to.spring.push_back(from.spring[k]);
  if (!from.damping.empty()) to.damping.push_back(from.damping[k]);
  if (!from.rolling.empty()) to.rolling.push_back(from.rolling[k]);
}

}   // namespace bedload

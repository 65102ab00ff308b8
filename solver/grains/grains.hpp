// The grains: a structure of arrays in which a grain's place is its id.
#pragma once

#include <cstdint>
#include <numbers>
#include <vector>

#include "base/vec3.hpp"

namespace bedload {

/// In Grains::fixed: for now (bed/frozen_grains); 1 is for ever.
constexpr std::uint8_t frozen = 2;

/// All arrays have one entry per grain; the index is the grain's id. Ids are given in spatial order when a bed has
/// settled, so that neighbours in space are neighbours in memory, and loops in order of id are loops in order of memory.
struct Grains {
  std::vector<Vec3> position;              // [m], inside the box (wrapped) between fluid steps
  std::vector<Vec3> velocity;              // [m/s]
  std::vector<Vec3> spin;                  // [rad/s]
  std::vector<double> diameter;            // [m]
  std::vector<double> density;             // [kg/m3]
  std::vector<std::uint8_t> fixed;         // 1 = never moves; 2 = not for now (bed/frozen_grains)
  std::vector<Vec3> mean_contact_force;    // [N], mean over the last fluid step (read by the next drag solve)
  std::vector<Vec3> mean_contact_torque;   // [N m], the same
  std::vector<std::uint8_t> moved;         // 1 = an event since the hold began (bed/incipient_motion)
  std::vector<double> travel;              // [m], downstream displacement since the last event (bed/incipient_motion)

  std::size_t size() const { return position.size(); }
  void resize(std::size_t n) {
    position.resize(n), velocity.resize(n), spin.resize(n), diameter.resize(n), density.resize(n);
    fixed.resize(n), mean_contact_force.resize(n), mean_contact_torque.resize(n), travel.resize(n), moved.resize(n);
  }
  bool operator==(const Grains&) const = default;
};

constexpr double sphere_volume(double diameter) { return std::numbers::pi / 6 * diameter * diameter * diameter; }
/// Moment of inertia of a solid sphere [kg m2].
constexpr double sphere_inertia(double mass, double diameter) { return 0.1 * mass * diameter * diameter; }

}   // namespace bedload

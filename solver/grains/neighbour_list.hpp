// The candidates for contact, kept while no grain has moved further than its skin, and the springs of those that touch.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/grains/bodies.hpp"
#include "solver/grains/box_walls.hpp"
#include "solver/grains/contact_history.hpp"
#include "solver/grains/neighbour_search.hpp"

namespace bedload {

/// Candidate pairs as aligned arrays, sorted by lower then higher id, so that one pass in order sums the forces on every
/// grain in order of its partners' ids: first those below it (as their higher one), then those above.
struct PairContacts {
  PairList ids;
  std::vector<double> root_radius;              // sqrt(R*) [m^1/2]
  std::vector<double> mass;                     // m* [kg]
  std::vector<double> depth;                    // at the last pass [m]; not positive: apart
  std::vector<double> spring_x, spring_y, spring_z;   // [m]

  std::size_t size() const { return ids.size(); }
  void resize_to_ids();
};

/// Candidates for contact with walls, sorted by grain then wall.
struct WallContact {
  std::uint32_t grain;
  std::uint32_t wall;    // place in the list of walls
  double root_radius;    // sqrt of the grain's radius [m^1/2]
  double mass;           // of the grain [kg]
  double depth;          // at the last pass [m]
  Vec3 spring;           // [m]
};

class NeighbourList {
 public:
  explicit NeighbourList(const BedScene&);

  /// True while every pair that may touch is listed. `bodies` may have been wrapped since the list was made.
  bool covers(std::span<const Body> bodies) const noexcept;
  /// Makes the list anew for these bodies, and carries `history` into it. A skin lasts about 50 steps dt.
  void rebuild(std::span<const Body> bodies, double dt, const ContactHistory& history);
  /// Hands the springs of `history` to the list. Every pair in it must be listed (it touched when it was saved).
  void load(const ContactHistory& history);
  /// What touched at the last pass.
  void save(ContactHistory& history) const;
  void forget() { reference_.clear(); }

  PairContacts pairs;
  std::vector<WallContact> wall_contacts;
  const std::vector<FlatWall>& walls() const { return walls_; }
  const PeriodicBox& box() const { return box_; }

 private:
  void list_pairs(std::span<const Body> bodies);
  void list_walls(std::span<const Body> bodies);

  PeriodicBox box_;
  std::vector<FlatWall> walls_;
  std::vector<Body> reference_;       // when the list was made
  std::vector<double> skin_, reach_;  // [m]
  std::vector<Vec3> position_;
  std::vector<std::uint8_t> fixed_;
};

}  // namespace bedload

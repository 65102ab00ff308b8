// The candidates for contact, kept while no grain has moved further than its skin, and the springs of those that touch.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/grains/bodies.hpp"
#include "solver/grains/box_walls.hpp"
#include "solver/grains/contact_history.hpp"
#include "solver/grains/neighbour_search.hpp"
#include "solver/grains/wet_restitution.hpp"

namespace bedload {

/// Candidate pairs as aligned arrays, sorted by lower then higher id, so that one pass in order sums the forces on
/// every grain in order of its partners' ids: first those below it (as their higher one), then those above.
struct PairContacts {
  PairList ids;
  std::vector<double> root_radius;                    // sqrt(R*) [m^1/2]
  std::vector<double> mass;                           // m* [kg]
  std::vector<double> depth;                          // at the last pass [m]; not positive: apart
  std::vector<double> spring_x, spring_y, spring_z;   // [m]
  std::vector<double> viscous_speed;                  // of WetRestitution [m/s]; empty without
  std::vector<double> damping;                        // alpha, negative where apart [-]; empty without
  std::vector<Vec3> rolling;                          // rolling spring [rad]; empty without rolling friction

  std::size_t size() const { return ids.size(); }
};

/// Candidates for contact with walls, sorted by grain then wall.
struct WallContact {
  std::uint32_t grain;
  std::uint32_t wall;                       // place in the list of walls
  double root_radius;                       // sqrt of the grain's radius [m^1/2]
  double mass;                              // of the grain [kg]
  double depth;                             // at the last pass [m]
  Vec3 spring;                              // [m]
  double viscous_speed = 0, damping = -1;   // as for pairs
  Vec3 rolling;
};

class NeighbourList {
 public:
  /// `wet` (or null) must outlive the list.
  NeighbourList(const BedScene&, const WetRestitution* wet, bool films);

  /// True if the list is of these very grains, and every pair that may touch now is in it. `bodies` may have been
  /// wrapped since the list was made, and may be heavier or lighter now (added mass).
  bool covers(std::span<const Body> bodies) noexcept;
  /// The same, for grains that have only moved since `covers` or `rebuild`.
  bool still_covers(std::span<const Body> bodies) const noexcept;
  /// Makes the list anew for these bodies, and carries `history` into it. A skin lasts about 25 steps dt.
  void rebuild(std::span<const Body> bodies, double dt, const ContactHistory& history);
  /// Hands the springs of `history` to the list. Every pair in it must be listed (it touched when it was saved).
  void load(const ContactHistory& history);
  /// What touched at the last pass.
  void save(ContactHistory& history) const;
  void forget() { origin_.clear(); }

  PairContacts pairs;
  std::vector<WallContact> wall_contacts;
  const std::vector<FlatWall>& walls() const { return walls_; }
  const PeriodicBox& box() const { return box_; }

 private:
  void list_pairs(std::span<const Body> bodies);
  void list_walls(std::span<const Body> bodies);

  PeriodicBox box_;
  std::vector<FlatWall> walls_;
  const WetRestitution* wet_;
  bool films_, rolls_;
  /// Where a grain was when the list was made, and how far it may have moved.
  struct Origin {
    Vec3 position;   // [m]
    double skin2;    // square of the skin [m2]
  };
  bool same_grains(std::span<const Body> bodies) const noexcept;
  void weigh(std::span<const Body> bodies) noexcept;

  std::vector<Origin> origin_;
  std::vector<double> radius_, inverse_mass_;   // then
  std::vector<Vec3> position_;                  // for the search
  std::vector<double> reach_;                   // radius and skin, and a pair's part of a film [m]
  std::vector<std::uint8_t> fixed_;
};

}   // namespace bedload

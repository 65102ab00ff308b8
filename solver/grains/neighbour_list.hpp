// The candidates for contact, kept while no grain has moved further than its skin, and the springs of those that touch.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/grains/box_walls.hpp"
#include "solver/grains/contact_history.hpp"
#include "solver/grains/grain_kernels.hpp"
#include "solver/grains/neighbour_search.hpp"
#include "solver/grains/wet_restitution.hpp"

namespace bedload {

/// Candidate pairs in blocks, sorted by lower then higher id.
struct PairContacts {
  PairList ids;
  std::vector<PairBlock> blocks;
  std::vector<WetBlock> wet_blocks;   // empty without liquid between the grains
  std::vector<Vec3> rolling;          // rolling spring [rad]; empty without rolling friction

  std::size_t size() const { return ids.size(); }
  float depth(std::size_t k) const { return blocks[k / PairBlock::pairs].depth[k % PairBlock::pairs]; }
  float root_radius(std::size_t k) const { return blocks[k / PairBlock::pairs].root_radius[k % PairBlock::pairs]; }
  float mass(std::size_t k) const { return blocks[k / PairBlock::pairs].mass[k % PairBlock::pairs]; }
  float damping(std::size_t k) const { return wet_blocks[k / PairBlock::pairs].damping[k % PairBlock::pairs]; }
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

/// The load of a pair that is asked for later than its place in the ring is needed again.
struct FarLoad {
  std::uint32_t pair;
  std::uint32_t place;   // its own
};

/// Where the loads of all contacts are, and which of them each grain adds up: a ring of pairs in their order, which they
/// enter turn by turn, so short that it stays in the second-level cache; then those of far pairs, walls, and one that is
/// always zero.
struct ContactLoads {
  std::vector<ContactLoad> load;
  std::vector<ContactPlaces> places;                               // one per grain
  std::vector<FurtherPlace> further_as_higher, further_as_lower;   // by grain, then in order of the pairs
  std::size_t ring_blocks = 0;                                     // of the ring; a power of two, or of all pairs
  std::vector<FarLoad> far;                                        // by pair
  std::size_t first_wall = 0;                                      // the place of the first wall contact

  std::size_t in_ring(std::size_t pair) const {
    const std::size_t turn = ring_blocks * PairBlock::pairs;
    return pair < turn ? pair : pair & (turn - 1);
  }
};

class NeighbourList {
 public:
  /// `wet` (or null) must outlive the list. `summed_at_once`: the loads of so many grains, a power of two, are added up as
  /// soon as their pairs are met; 0: those of all, when all are met.
  NeighbourList(const BedScene&, const WetRestitution* wet, bool films, std::size_t summed_at_once = 0);

  /// True if the list is of these very grains, and every pair that may touch now is in it. `bodies` may have been
  /// wrapped since the list was made, and may be heavier or lighter now (added mass).
  bool covers(const Bodies&) noexcept;
  /// The same, for grains that have only moved since `covers` or `rebuild`, never faster than `note_speed` was told.
  bool still_covers(const Bodies&) noexcept;
  /// `fastest`: of all grains in this step dt [skins/s].
  void note_speed(double fastest, double dt) noexcept { travelled_ += dt * fastest; }
  /// Makes the list anew for these bodies, and carries `history` into it. A skin lasts about 25 steps dt.
  void rebuild(const Bodies&, double dt, const ContactHistory& history);
  /// Takes the springs from `history`, unless the list holds them already. Every pair in it must be listed (it touched
  /// when it was saved).
  void recall(const ContactHistory& history);
  /// What touched at the last pass.
  void save(ContactHistory& history);
  void forget() { origin_.clear(); }

  PairContacts pairs;
  std::vector<WallContact> wall_contacts;
  ContactLoads loads;
  /// How many blocks hold all pairs whose lower id is below this grain.
  std::size_t blocks_of_grains_below(std::size_t grain) const {
    return (first_pair_[grain] + PairBlock::pairs - 1) / PairBlock::pairs;
  }
  /// Brings the far loads among those of blocks up to `met` to their own places, from the `next` on, which it moves on.
  void keep_far_loads(std::size_t met, std::size_t& next) noexcept;
  /// At least (r_i + r_j)/(2 min(r_i, r_j)) of any pair, with room for rounding to float [-].
  double most_unlike_radii() const { return most_unlike_radii_; }
  std::span<const double> inverse_skins() const { return inverse_skin_; }   // [1/m]; 0 for fixed grains
  const std::vector<FlatWall>& walls() const { return walls_; }
  const PeriodicBox& box() const { return box_; }
  bool wet() const { return wet_ != nullptr; }

 private:
  void load(const ContactHistory&);
  void list_pairs(const Bodies&);
  void list_walls(const Bodies&);
  void place_loads(std::size_t grains);
  void place_pairs(std::size_t grains);
  std::size_t keep_pairs(std::size_t first, std::size_t last, std::size_t n) noexcept;
  void weigh(const Bodies&) noexcept;
  double furthest(const Bodies&) const noexcept;

  PeriodicBox box_;
  std::vector<FlatWall> walls_;
  const WetRestitution* wet_;
  bool films_, rolls_;
  std::size_t summed_at_once_;

  std::vector<std::uint32_t> first_pair_;   // of each grain as the lower one, and one beyond the last
  double most_unlike_radii_ = 1;
  double travelled_ = 0;                        // no grain has gone further since the list was made [skins]
  std::vector<Vec3> origin_;                    // where a grain was when the list was made [m]
  std::vector<double> inverse_skin_;            // [1/m]
  std::vector<double> radius_, inverse_mass_;   // then
  std::vector<double> reach_;                   // radius and skin, and a pair's part of a film [m]
  std::vector<std::uint8_t> fixed_;
  ContactHistory kept_;   // its first kept_count_: what `save` gave last, and the list holds
  std::size_t kept_count_ = 0;
};

}   // namespace bedload

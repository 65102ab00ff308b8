// What grains do to each other and to walls in one DEM step, contact by contact.
#pragma once

#include <span>

#include "solver/grains/contact_laws.hpp"
#include "solver/grains/neighbour_list.hpp"
#include "solver/grains/wet_restitution.hpp"

namespace bedload {

/// The pairs of a list, and their law, as the kernel takes them. With `wet` the damping is chosen anew where a contact
/// begins.
PairPass pair_pass(const HertzMindlin&, const WetRestitution* wet, const Bodies&, double dt, NeighbourList&) noexcept;

/// The places of the contacts' loads, for the kernel that adds them up.
SumPass sum_pass(const Bodies&, const NeighbourList&) noexcept;

/// How many grains are summed, and move, at a time: so few that the loads of their contacts are still in the first-level
/// cache.
inline constexpr std::size_t grains_at_once = 64;

/// Meets pairs in their order, as the turn comes to their lower grains, and keeps their loads where they are asked for.
class PairWave {
 public:
  PairWave(const GrainKernels& kernels, const PairPass& pass, NeighbourList& list) noexcept
      : kernels_(kernels), pass_(pass), list_(list) {}
  /// All that are left of pairs whose lower id is below this one.
  void meet_below(std::size_t grain) noexcept;

 private:
  const GrainKernels& kernels_;
  const PairPass pass_;
  NeighbourList& list_;
  std::size_t met_ = 0, far_ = 0;   // blocks, far loads
};

/// Loads of the contacts with walls; renews their springs and depths. Returns the force of all grains on the walls [N].
Vec3 meet_walls(const HertzMindlin& rough, const HertzMindlin& smooth, const WetRestitution* wet, const Bodies&,
                double dt, double lid_speed, NeighbourList&) noexcept;

}   // namespace bedload

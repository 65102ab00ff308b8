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

/// Loads of the contacts with walls; renews their springs and depths. Returns the force of all grains on the walls [N].
Vec3 meet_walls(const HertzMindlin& rough, const HertzMindlin& smooth, const WetRestitution* wet, const Bodies&,
                double dt, double lid_speed, NeighbourList&) noexcept;

}   // namespace bedload

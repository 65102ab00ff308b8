// One pass over the candidates: the law for each, then the sums per grain in order of partner id.
#pragma once

#include <span>

#include "solver/grains/contact_laws.hpp"
#include "solver/grains/neighbour_list.hpp"
#include "solver/grains/wet_restitution.hpp"

namespace bedload {

/// Adds the contact forces and torques of all pairs to `loads`, and renews springs and depths; with `wet` also the
/// damping, chosen anew where a contact begins. Candidates apart add exact zeros. `loads` starts from zero.
void add_pair_forces(const HertzMindlin&, const WetRestitution* wet, const PeriodicBox&, std::span<const Body>,
                     double dt, PairContacts&, std::span<Load> loads) noexcept;

/// The same for walls, after the pairs. Returns the force of all grains on the walls [N].
Vec3 add_wall_forces(const HertzMindlin& rough, const HertzMindlin& smooth, const WetRestitution* wet,
                     std::span<const FlatWall>, std::span<const Body>, double dt, double lid_speed,
                     std::span<WallContact>, std::span<Load> loads) noexcept;

}   // namespace bedload

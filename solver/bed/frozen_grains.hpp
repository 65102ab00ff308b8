// Deep grains that are left out of the motion while the bed above them is thick enough, and wake as it is scoured away.
#pragma once

#include <cstdint>

#include "solver/grains/bed_scene.hpp"
#include "solver/grains/contact_history.hpp"
#include "solver/grains/grains.hpp"

namespace bedload {

/// In Grains::fixed: for now; 1 is for ever.
constexpr std::uint8_t frozen = 2;

/// Freezes every grain whose centre lies deeper than `depth` [m] below the bed's local surface, and wakes all others. The local surface is
/// the lowest of the tops of the column around the grain and the eight beside it, about two diameters wide, a top being that of
/// the highest grain slower than `slow` [m/s]: so that a hole is seen from below before it is there, and a grain that flies past
/// buries none. What two grains at rest remember of each other moves to `asleep`, unchanged, and comes back with the first of
/// them; a frozen grain has no velocity and no spin.
void freeze_deep_grains(const BedScene&, double depth, double slow, Grains&, ContactHistory& contacts,
                        ContactHistory& asleep);

/// Both, in order.
ContactHistory all_contacts(const ContactHistory& contacts, const ContactHistory& asleep);

/// Wakes all.
void thaw(Grains&, ContactHistory& contacts, ContactHistory& asleep);

}   // namespace bedload

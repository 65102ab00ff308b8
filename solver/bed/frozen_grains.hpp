// Deep grains that are left out of the motion while the bed above them is thick enough, and wake as it is scoured away.
#pragma once

#include <cstdint>

#include "solver/grains/bed_scene.hpp"
#include "solver/grains/contact_history.hpp"
#include "solver/grains/grains.hpp"

namespace bedload {

/// Freezes every grain slower than `slow` [m/s] whose centre lies deeper than `depth` [m] below the bed's local surface, and wakes all others.
/// The local surface is made of the elevations (bed_surface) of slow grains, without pores narrower than 1.5 diameters, and is the lowest of
/// them within 2.5 diameters along x and y: so that a hole is seen from beside and below before it is there, and a grain that flies past buries none. What two grains at rest remember of each other moves to
/// `asleep`, unchanged, and comes back with the first of them; a frozen grain has no velocity and no spin, and keeps the mean contact
/// force that it had, which is what bears it when it wakes.
void freeze_deep_grains(const BedScene&, double depth, double slow, Grains&, ContactHistory& contacts,
                        ContactHistory& asleep);

/// Both, in order.
ContactHistory all_contacts(const ContactHistory& contacts, const ContactHistory& asleep);

/// Wakes all.
void thaw(Grains&, ContactHistory& contacts, ContactHistory& asleep);

}   // namespace bedload

// The liquid that a grain must accelerate with itself.
#pragma once

#include <span>
#include <vector>

#include "solver/coupling/packing_of_others.hpp"

namespace bedload {

/// Added mass over the mass of the displaced liquid: 1/2 for a lone sphere, 0.5 (1 + 2 phi)/(1 - phi) among others that
/// fill the share phi of space (Zuber 1964, Chem. Eng. Sci. 19, 897).
constexpr double added_mass_coefficient(double packing) noexcept { return 0.5 * (1 + 2 * packing) / (1 - packing); }

/// C_A V_p of every grain, by id [m3] (added mass per fluid density), with phi that of the *other* grains at it: a lone
/// grain has 1/2 whatever the cells. `own` is the packing density that each reads of its own volume. phi is at most 1 - 0.26,
/// as in the drag laws. Divided by eps in Model B, as drag is.
void find_added_mass(const Grains&, std::span<const double> void_fraction, std::span<const double> own, bool model_b,
                     std::vector<double>& added);

}   // namespace bedload

// The liquid that a grain must accelerate with itself.
#pragma once

#include <span>
#include <vector>

#include "solver/coupling/packing_of_others.hpp"

namespace bedload {

/// Added mass over the mass of the displaced liquid: 1/2 for a lone sphere, 0.5 (1 + 2 phi)/(1 - phi) among others that
/// fill the share phi of space (Zuber 1964, Chem. Eng. Sci. 19, 897).
constexpr double added_mass_coefficient(double packing) noexcept { return 0.5 * (1 + 2 * packing) / (1 - packing); }

/// C_A V_p of every grain, by id [m3] (added mass per fluid density), with phi as in the drag law: what the grain reads, less its own volume
/// as far as it is a lone one, which has 1/2 whatever the cells. phi is at most 1 - least_void. Divided by eps in Model B, as drag is.
void find_added_mass(const Grains&, std::span<const double> void_fraction, const GrainPacking&, bool model_b,
                     std::vector<double>& added);

}   // namespace bedload

// Drag of packed beds and suspensions as it was published: what runs are held against, written apart from the solver's laws.
#pragma once

#include <functional>
#include <string>

namespace bedload {

inline constexpr const char* di_felice_source = "Di Felice 1994";

/// Multiplier of the Stokes drag, Di Felice (1994) on Dallavalle's drag coefficient [-]; `reynolds` is superficial.
double di_felice(double porosity, double reynolds);

/// Gradient per flux of a bed, G d^2/(mu U) [-], by "di_felice" or "ergun" (1952).
double gradient_per_flux(const std::string& law, double porosity, double reynolds);

/// Where a function that rises passes zero, to round-off; `high` if it does not between the two.
double zero_of_rising(const std::function<double(double)>& rising, double low, double high);

}   // namespace bedload

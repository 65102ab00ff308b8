#include "solver/coupling/added_mass.hpp"

#include "solver/coupling/drag_laws.hpp"

namespace bedload {
namespace {

constexpr double densest = 1 - least_void;

}   // namespace

void find_added_mass(const Grains& grains, std::span<const double> void_fraction, const GrainPacking& surroundings,
                     bool model_b, std::vector<double>& added) {
  added.resize(grains.size());
  for (std::size_t p = 0; p < grains.size(); ++p) {
    const double volume = sphere_volume(grains.diameter[p]), packing = std::clamp(1 - void_fraction[p], 0.0, densest);
    const double others = std::max(0.0, packing - surroundings.loneness(p) * surroundings.own[p]);
    added[p] = added_mass_coefficient(others) * volume / (model_b ? 1 - packing : 1);
  }
}

}   // namespace bedload

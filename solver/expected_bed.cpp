#include "solver/expected_bed.hpp"

#include "solver/grains/grain_dynamics.hpp"
#include "solver/grains/grains.hpp"

namespace bedload {

double expected_bed_depth(const BedScene& bed) {
  const double spread = bed.grains.spread;
  const double grain =
      sphere_volume(bed.grains.diameter) * (1 + 3 * spread * spread);   // mean of d^3 of a normal distribution
  return static_cast<double>(bed.source.count) * grain / (loose_packing * bed.length.x * bed.length.y);
}

double smallest_diameter(const BedScene& bed) { return bed.grains.diameter * (1 - 2 * bed.grains.spread); }
double largest_diameter(const BedScene& bed) { return bed.grains.diameter * (1 + 2 * bed.grains.spread); }

double smallest_rayleigh_time(const BedScene& bed) {
  return rayleigh_time(smallest_diameter(bed), bed.grains.density, bed.grains.young_modulus, bed.grains.poisson);
}

}   // namespace bedload

#include "solver/expected_bed.hpp"

#include <algorithm>

#include "solver/grains/grain_dynamics.hpp"
#include "solver/grains/grains.hpp"

namespace bedload {

namespace {

/// A table has a row per line below its heading.
double number_of_grains(const BedSource& source) {
  if (source.kind != BedSource::Kind::file) return static_cast<double>(source.count);
  const auto lines = std::ranges::count(source.csv, '\n') + (source.csv.empty() || source.csv.back() == '\n' ? 0 : 1);
  return static_cast<double>(std::max<std::ptrdiff_t>(0, lines - 1));
}

}  // namespace

double expected_bed_depth(const BedScene& bed) {
  const double spread = bed.grains.spread;
  const double grain = sphere_volume(bed.grains.diameter) * (1 + 3 * spread * spread);   // mean of d^3 of a normal distribution
  return number_of_grains(bed.source) * grain / (loose_packing * bed.length.x * bed.length.y);
}

double smallest_diameter(const BedScene& bed) { return bed.grains.diameter * (1 - 2 * bed.grains.spread); }
double largest_diameter(const BedScene& bed) { return bed.grains.diameter * (1 + 2 * bed.grains.spread); }

double smallest_rayleigh_time(const BedScene& bed) {
  return rayleigh_time(smallest_diameter(bed), bed.grains.density, bed.grains.young_modulus, bed.grains.poisson);
}

}  // namespace bedload

// Which grains are near each other: by cells, sorted by id.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/grains/box_walls.hpp"

namespace bedload {

/// Pairs of ids, lower < higher, sorted by lower then higher.
struct PairList {
  std::vector<std::uint32_t> lower, higher;
  std::size_t size() const { return lower.size(); }
};

/// All pairs closer than the sum of their reaches [m] under the minimum image, pairs of two fixed grains left out
/// (`fixed` empty: none left out). The order does not depend on the cells. Positions may lie outside a periodic box.
void find_near_pairs(const PeriodicBox&, std::span<const Vec3> position, std::span<const double> reach,
                     std::span<const std::uint8_t> fixed, PairList& pairs);

/// Refuses (study_invalid) a periodic side so short that a grain could touch two images of another.
void check_periodic_sides(const PeriodicBox&, double largest_diameter);

}   // namespace bedload

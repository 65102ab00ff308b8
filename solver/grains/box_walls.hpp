// The sides of the box for grains: shortest vectors across periodic sides, flat walls elsewhere.
#pragma once

#include <cmath>
#include <vector>

#include "solver/grains/bed_scene.hpp"
#include "solver/grains/contact_history.hpp"

namespace bedload {

/// Differences of positions under the minimum image.
struct PeriodicBox {
  Vec3 length;    // [m]
  Vec3 inverse;   // 1/length where periodic, else 0 [1/m]

  explicit PeriodicBox(const BedScene& scene) : length(scene.length) {
    for (int c = 0; c < 3; ++c) inverse[c] = scene.sides[c] == Side::periodic ? 1 / length[c] : 0;
  }
  bool periodic(int c) const noexcept { return inverse[c] > 0; }
  Vec3 shortest(Vec3 d) const noexcept {
    return {d.x - length.x * std::rint(d.x * inverse.x), d.y - length.y * std::rint(d.y * inverse.y),
            d.z - length.z * std::rint(d.z * inverse.z)};
  }
  /// The same place inside the box, 0 <= x < length, along periodic directions.
  Vec3 wrapped(Vec3 place) const noexcept {
    for (int c = 0; c < 3; ++c) {
      if (!periodic(c)) continue;
      if (place[c] < 0 || place[c] >= length[c]) place[c] -= length[c] * std::floor(place[c] * inverse[c]);
      if (place[c] >= length[c]) place[c] = 0;   // -tiny + length rounds to length
    }
    return place;
  }
};

/// A flat wall across one axis.
struct FlatWall {
  Wall name;
  int axis;
  double place;     // [m]
  double outward;   // +1 or -1: from the grains to the wall along the axis
  bool rough;       // has the grains' friction; else none
  bool moves;       // with the lid's speed along x

  double depth(Vec3 centre, double radius) const noexcept { return radius - outward * (place - centre[axis]); }
  Vec3 normal() const noexcept {
    Vec3 n;
    n[axis] = outward;
    return n;
  }
};

inline std::vector<FlatWall> walls_of(const BedScene& scene) {
  std::vector<FlatWall> walls;
  for (int c = 0; c < 3; ++c) {
    if (scene.sides[c] == Side::periodic) continue;
    const auto low = static_cast<std::uint32_t>(Wall::x_low) + 2 * static_cast<std::uint32_t>(c);
    const bool top = c == 2;
    walls.push_back({static_cast<Wall>(low), c, 0, -1, true, false});
    walls.push_back({static_cast<Wall>(low + 1), c, scene.length[c], 1, !top || scene.top == Top::lid,
                     top && scene.top == Top::lid});
  }
  return walls;
}

}   // namespace bedload

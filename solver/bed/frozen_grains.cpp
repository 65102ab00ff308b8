#include "solver/bed/frozen_grains.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "solver/bed/bed_surface.hpp"

namespace bedload {

namespace {

constexpr double
    pore = 0.5,
    reach = 2.5;   // d: what is narrower than three times the first is no hole; one is seen from so far beside it

/// For each column of `top` what `pick` takes of all within `far` [m] along x and y.
template <class Pick>
void spread(Elevations& top, Vec3 length, double far, Pick&& pick) {
  for (const bool along_x : {true, false}) {
    const double width = along_x ? length.x / static_cast<double>(top.nx) : length.y / static_cast<double>(top.ny);
    const long columns = std::lround(far / width);
    const Elevations before = top;
    for (long i = 0; i < top.nx; ++i)
      for (long j = 0; j < top.ny; ++j)
        for (long k = -columns; k <= columns; ++k)
          top.at(i, j) = pick(top.at(i, j), along_x ? before.at(i + k, j) : before.at(i, j + k));
  }
}

/// The bed's surface without its pores, and the lowest of that around each column. Beyond a wall it looks at the other end of the box, which
/// may wake what need not be and buries nothing.
Elevations local_surface(const BedScene& scene, const Grains& grains, double slow) {
  const double d = scene.grains.diameter;
  Elevations top = elevations(grains, scene.length, d, slow);
  spread(top, scene.length, pore * d, [](double a, double b) { return std::max(a, b); });
  spread(top, scene.length, reach * d, [](double a, double b) { return std::min(a, b); });
  return top;
}

double height_at(const Elevations& surface, Vec3 length, Vec3 place) {
  const auto column = [](double x, double edge, long n) {
    return std::clamp(static_cast<long>(x / edge * static_cast<double>(n)), 0L, n - 1);
  };
  return surface.at(column(place.x, length.x, surface.nx), column(place.y, length.y, surface.ny));
}

}   // namespace

// Both are sorted, and no pair is in both. Contacts that fell asleep as the bed had been packed have no damping and no rolling spring yet,
// where those that were awake since have got them.
ContactHistory all_contacts(const ContactHistory& contacts, const ContactHistory& asleep) {
  constexpr double not_chosen = -1;
  ContactHistory all;
  const bool damped = !contacts.damping.empty() || !asleep.damping.empty();
  const bool rolls = !contacts.rolling.empty() || !asleep.rolling.empty();
  const auto add = [&](const ContactHistory& from, std::size_t k) {
    append(all, from, k, from.lower[k], from.higher[k]);
    if (damped && from.damping.empty()) all.damping.push_back(not_chosen);
    if (rolls && from.rolling.empty()) all.rolling.push_back({});
  };
  std::size_t n = 0;
  const auto precedes = [&](std::size_t k) {
    return std::pair(asleep.lower[n], asleep.higher[n]) < std::pair(contacts.lower[k], contacts.higher[k]);
  };
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    for (; n < asleep.size() && precedes(k); ++n) add(asleep, n);
    add(contacts, k);
  }
  for (; n < asleep.size(); ++n) add(asleep, n);
  return all;
}

void thaw(Grains& grains, ContactHistory& contacts, ContactHistory& asleep) {
  std::ranges::replace(grains.fixed, frozen, std::uint8_t{0});
  if (asleep.size() > 0) contacts = all_contacts(contacts, asleep);
  asleep = {};
}

void freeze_deep_grains(const BedScene& scene, double depth, double slow, Grains& grains, ContactHistory& contacts,
                        ContactHistory& asleep) {
  thaw(grains, contacts, asleep);
  const Elevations surface = local_surface(scene, grains, slow);
  for (std::size_t i = 0; i < grains.size(); ++i) {
    const bool moves = norm2(grains.velocity[i]) > slow * slow;
    const Vec3 place = grains.position[i];
    if (grains.fixed[i] || moves || place.z > height_at(surface, scene.length, place) - depth) continue;
    grains.fixed[i] = frozen;
    grains.velocity[i] = grains.spin[i] = {};
  }
  const auto rests = [&](std::uint32_t partner) { return is_wall(partner) || grains.fixed[partner]; };
  ContactHistory met;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const std::uint32_t lower = contacts.lower[k], higher = contacts.higher[k];
    append(rests(lower) && rests(higher) ? asleep : met, contacts, k, lower, higher);
  }
  contacts = std::move(met);
}

}   // namespace bedload

#include "solver/bed/frozen_grains.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace bedload {

namespace {

/// The bed's surface over columns about two diameters wide.
class LocalSurface {
 public:
  LocalSurface(const BedScene& scene, const Grains& grains, double slow)
      : scene_(scene), columns_{across(0), across(1)}, top_(std::size_t(columns_[0]) * std::size_t(columns_[1]), 0.0) {
    for (std::size_t i = 0; i < grains.size(); ++i) {
      if (norm2(grains.velocity[i]) > slow * slow) continue;
      double& top = top_[index(along(grains.position[i], 0), along(grains.position[i], 1))];
      top = std::max(top, grains.position[i].z + 0.5 * grains.diameter[i]);
    }
  }

  /// The lowest top around a place [m].
  double lowest_around(Vec3 place) const {
    double lowest = std::numeric_limits<double>::infinity();
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j)
        lowest = std::min(lowest, top_[index(beside(along(place, 0), i, 0), beside(along(place, 1), j, 1))]);
    return lowest;
  }

 private:
  int across(int c) const { return std::max(1, static_cast<int>(scene_.length[c] / (2 * scene_.grains.diameter))); }
  int along(Vec3 place, int c) const {
    return std::clamp(static_cast<int>(place[c] / scene_.length[c] * columns_[c]), 0, columns_[c] - 1);
  }
  int beside(int column, int step, int c) const {
    const int next = column + step;
    return scene_.sides[c] == Side::periodic ? (next + columns_[c]) % columns_[c]
                                             : std::clamp(next, 0, columns_[c] - 1);
  }
  std::size_t index(int i, int j) const { return std::size_t(i) * std::size_t(columns_[1]) + std::size_t(j); }

  const BedScene& scene_;
  int columns_[2];
  std::vector<double> top_;
};

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
  const LocalSurface surface(scene, grains, slow);
  for (std::size_t i = 0; i < grains.size(); ++i) {
    if (grains.fixed[i] || grains.position[i].z > surface.lowest_around(grains.position[i]) - depth) continue;
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

// Ids along the box, column by column: neighbours in space become neighbours in memory.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "solver/grains/bed_packing.hpp"

namespace bedload {
namespace {

template <class T>
void reorder(std::vector<T>& array, const std::vector<std::uint32_t>& old_place) {
  std::vector<T> ordered(array.size());
  for (std::size_t i = 0; i < array.size(); ++i) ordered[i] = array[old_place[i]];
  array.swap(ordered);
}

void renumber(ContactHistory& contacts, const std::vector<std::uint32_t>& new_id) {
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    std::uint32_t &lower = contacts.lower[k], &higher = contacts.higher[k];
    lower = new_id[lower];
    if (higher < new_id.size()) higher = new_id[higher];   // else a wall
    if (lower < higher) continue;
    std::swap(lower, higher);   // springs are those of the lower grain
    contacts.spring[k] = -contacts.spring[k];
    if (!contacts.rolling.empty()) contacts.rolling[k] = -contacts.rolling[k];
  }
  std::vector<std::uint32_t> old_place(contacts.size());
  std::iota(old_place.begin(), old_place.end(), 0u);
  std::ranges::sort(old_place, {}, [&](std::uint32_t k) { return std::tuple(contacts.lower[k], contacts.higher[k]); });
  reorder(contacts.lower, old_place), reorder(contacts.higher, old_place), reorder(contacts.spring, old_place);
  if (!contacts.damping.empty()) reorder(contacts.damping, old_place);
  if (!contacts.rolling.empty()) reorder(contacts.rolling, old_place);
}

}   // namespace

void renumber_in_space(const BedScene& scene, Grains& grains, ContactHistory& contacts) {
  const double d = scene.grains.diameter;
  std::vector<std::uint32_t> old_id(grains.size()), new_id(grains.size());
  std::iota(old_id.begin(), old_id.end(), 0u);
  std::ranges::sort(old_id, {}, [&](std::uint32_t i) {
    const Vec3 p = grains.position[i];
    return std::tuple(std::floor(p.x / d), std::floor(p.y / d), p.z, i);
  });
  for (std::uint32_t i = 0; i < old_id.size(); ++i) new_id[old_id[i]] = i;
  reorder(grains.position, old_id), reorder(grains.velocity, old_id), reorder(grains.spin, old_id);
  reorder(grains.diameter, old_id), reorder(grains.density, old_id), reorder(grains.fixed, old_id);
  reorder(grains.mean_contact_force, old_id), reorder(grains.mean_contact_torque, old_id);
  reorder(grains.travel, old_id);
  reorder(grains.moved, old_id);
  renumber(contacts, new_id);
}

}   // namespace bedload

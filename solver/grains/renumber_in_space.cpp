// Ids along the box, column by column: neighbours in space become neighbours in memory.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "solver/grains/bed_packing.hpp"

namespace bedload {
namespace {

template <class T>
void reorder(std::vector<T>& array, const std::vector<std::uint32_t>& old_id) {
  std::vector<T> ordered(array.size());
  for (std::size_t i = 0; i < array.size(); ++i) ordered[i] = array[old_id[i]];
  array.swap(ordered);
}

void renumber(ContactHistory& contacts, const std::vector<std::uint32_t>& new_id) {
  struct Contact {
    std::uint32_t lower, higher;
    Vec3 spring;
  };
  std::vector<Contact> renamed(contacts.size());
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    std::uint32_t lower = new_id[contacts.lower[k]], higher = contacts.higher[k];
    Vec3 spring = contacts.spring[k];
    if (higher < new_id.size()) higher = new_id[higher];              // else a wall
    if (lower > higher) std::swap(lower, higher), spring = -spring;   // it is the spring of the lower grain
    renamed[k] = {lower, higher, spring};
  }
  std::ranges::sort(renamed, {}, [](const Contact& c) { return std::tuple(c.lower, c.higher); });
  for (std::size_t k = 0; k < renamed.size(); ++k) {
    contacts.lower[k] = renamed[k].lower;
    contacts.higher[k] = renamed[k].higher;
    contacts.spring[k] = renamed[k].spring;
  }
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
  renumber(contacts, new_id);
}

}   // namespace bedload

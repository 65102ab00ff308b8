// Two rings of neighbours around the grains that move, and the contacts of the inner one.
#include "solver/grains/stragglers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "solver/grains/box_walls.hpp"

namespace bedload {
namespace {

/// Grains by cells at least as wide as the largest reach of a pair.
class Cells {
 public:
  Cells(const PeriodicBox& box, const Grains& grains) : box_(box), grains_(grains) {
    const double edge = 2 * reach(std::ranges::max(grains.diameter));
    for (int c = 0; c < 3; ++c) {   // not more than a few cells per grain
      const double most = 4 * std::cbrt(static_cast<double>(grains.size()));
      count_[c] = static_cast<int>(std::clamp(std::floor(box.length[c] / edge), 1.0, most));
    }
    std::vector<std::uint32_t> cell(grains.size());
    start_.assign(static_cast<std::size_t>(count_[0]) * count_[1] * count_[2] + 1, 0);
    for (std::size_t i = 0; i < grains.size(); ++i) ++start_[(cell[i] = cell_at(grains.position[i])) + 1];
    for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
    std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
    ids_.resize(grains.size());
    for (std::uint32_t i = 0; i < grains.size(); ++i) ids_[next[cell[i]]++] = i;
  }

  /// The grains of `core`, and those near one.
  std::vector<std::uint8_t> with_neighbours(std::span<const std::uint8_t> core) const {
    std::vector<std::uint8_t> grown(core.begin(), core.end());
    for (std::uint32_t i = 0; i < core.size(); ++i)
      if (core[i]) flag_neighbours(i, grown);
    return grown;
  }

 private:
  static double reach(double diameter) { return (0.5 + Stragglers::margin) * diameter; }

  int along(Vec3 place, int c) const {
    return std::clamp(static_cast<int>(place[c] / box_.length[c] * count_[c]), 0, count_[c] - 1);
  }
  std::uint32_t index(int x, int y, int z) const {
    return (static_cast<std::uint32_t>(x) * count_[1] + y) * count_[2] + z;
  }
  std::uint32_t cell_at(Vec3 position) const {
    const Vec3 place = box_.wrapped(position);
    return index(along(place, 0), along(place, 1), along(place, 2));
  }

  void flag_neighbours(std::uint32_t i, std::vector<std::uint8_t>& flags) const {
    const Vec3 place = box_.wrapped(grains_.position[i]);
    std::array<std::array<int, 3>, 3> near{};
    std::array<int, 3> many{};
    for (int c = 0; c < 3; ++c)
      for (int step = -1; step <= 1; ++step) {
        int cell = along(place, c) + step;
        if (box_.periodic(c)) cell = (cell + count_[c]) % count_[c];
        if (cell >= 0 && cell < count_[c]) near[c][many[c]++] = cell;   // the same again in a narrow box: no matter
      }
    for (int x = 0; x < many[0]; ++x)
      for (int y = 0; y < many[1]; ++y)
        for (int z = 0; z < many[2]; ++z) {
          const std::uint32_t cell = index(near[0][x], near[1][y], near[2][z]);
          for (std::uint32_t k = start_[cell]; k < start_[cell + 1]; ++k) {
            const std::uint32_t j = ids_[k];
            const double far = reach(grains_.diameter[i]) + reach(grains_.diameter[j]);
            if (!flags[j] && norm2(box_.shortest(grains_.position[j] - place)) < far * far) flags[j] = 1;
          }
        }
  }

  const PeriodicBox& box_;
  const Grains& grains_;
  std::array<int, 3> count_{};
  std::vector<std::uint32_t> start_, ids_;   // ids in order of cells, and where each cell's begin
};

bool moves(const std::vector<std::uint8_t>& free, std::uint32_t lower, std::uint32_t higher) {
  return free[lower] || (!is_wall(higher) && free[higher]);
}

}   // namespace

void Stragglers::cut_out(const BedScene& scene, const Grains& bed, const ContactHistory& history,
                         std::span<const std::uint8_t> awake) {
  const PeriodicBox box(scene);
  const Cells cells(box, bed);
  free_ = cells.with_neighbours(awake);
  for (std::size_t i = 0; i < bed.size(); ++i) free_[i] = free_[i] && !bed.fixed[i];
  const std::vector<std::uint8_t> taken = cells.with_neighbours(free_);
  id_.clear(), part_id_.assign(bed.size(), 0);
  for (std::uint32_t i = 0; i < bed.size(); ++i) {
    if (!taken[i]) continue;
    part_id_[i] = static_cast<std::uint32_t>(id_.size());
    id_.push_back(i);
  }
  grains = {};
  grains.resize(id_.size());
  for (std::size_t k = 0; k < id_.size(); ++k) {
    const std::uint32_t i = id_[k];
    grains.position[k] = bed.position[i], grains.diameter[k] = bed.diameter[i], grains.density[k] = bed.density[i];
    grains.fixed[k] = !free_[i];
    if (free_[i]) grains.velocity[k] = bed.velocity[i], grains.spin[k] = bed.spin[i];
  }
  contacts = {};
  for (std::size_t k = 0; k < history.size(); ++k) {
    const std::uint32_t lower = history.lower[k], higher = history.higher[k];
    if (moves(free_, lower, higher))
      append(contacts, history, k, part_id_[lower], is_wall(higher) ? higher : part_id_[higher]);
  }
}

void Stragglers::put_back(Grains& bed, ContactHistory& history) const {
  for (std::size_t i = 0; i < bed.size(); ++i)
    if (!free_[i] && !bed.fixed[i]) bed.velocity[i] = bed.spin[i] = {};
  for (std::size_t k = 0; k < id_.size(); ++k) {
    const std::uint32_t i = id_[k];
    if (!free_[i]) continue;
    bed.position[i] = grains.position[k], bed.velocity[i] = grains.velocity[k], bed.spin[i] = grains.spin[k];
    bed.mean_contact_force[i] = grains.mean_contact_force[k];
    bed.mean_contact_torque[i] = grains.mean_contact_torque[k];
  }
  ContactHistory merged;   // both are sorted, and no pair is in both
  std::size_t k = 0;
  const auto add_moved_before = [&](std::uint32_t lower, std::uint32_t higher) {
    for (; k < contacts.size(); ++k) {
      const std::uint32_t a = id_[contacts.lower[k]], b = contacts.higher[k];
      const std::uint32_t partner = is_wall(b) ? b : id_[b];
      if (std::tie(a, partner) > std::tie(lower, higher)) return;
      append(merged, contacts, k, a, partner);
    }
  };
  for (std::size_t h = 0; h < history.size(); ++h) {
    if (moves(free_, history.lower[h], history.higher[h])) continue;
    add_moved_before(history.lower[h], history.higher[h]);
    append(merged, history, h, history.lower[h], history.higher[h]);
  }
  add_moved_before(UINT32_MAX, UINT32_MAX);
  history = std::move(merged);
}

}   // namespace bedload

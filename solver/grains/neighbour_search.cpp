// Grains counted into cells not smaller than the largest reach; each grain looks into its cell and those around.
#include "solver/grains/neighbour_search.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "base/error.hpp"

namespace bedload {
namespace {

/// Cells over the box, and the grains of each in order of id.
class CellGrid {
 public:
  CellGrid(const PeriodicBox& box, std::span<const Vec3> position, double edge) : box_(box) {
    choose_counts(edge, position.size());
    cell_of_.resize(position.size());
    start_.assign(static_cast<std::size_t>(count_[0]) * count_[1] * count_[2] + 1, 0);
    for (std::size_t i = 0; i < position.size(); ++i) {
      cell_of_[i] = index(place(position[i]));
      ++start_[cell_of_[i] + 1];
    }
    for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
    std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
    grains_.resize(position.size());
    for (std::size_t i = 0; i < position.size(); ++i) grains_[next[cell_of_[i]]++] = static_cast<std::uint32_t>(i);
  }

  /// Visits every grain in the cells around that of `centre`, each once.
  template <class Visit>
  void around(Vec3 centre, Visit&& visit) const {
    const std::array<int, 3> middle = place(centre);
    std::array<std::array<int, 3>, 3> near{};
    std::array<int, 3> many{};
    for (int c = 0; c < 3; ++c) many[c] = neighbours(middle[c], c, near[c]);
    for (int a = 0; a < many[0]; ++a)
      for (int b = 0; b < many[1]; ++b)
        for (int e = 0; e < many[2]; ++e) {
          const std::size_t cell = index({near[0][a], near[1][b], near[2][e]});
          for (std::uint32_t k = start_[cell]; k < start_[cell + 1]; ++k) visit(grains_[k]);
        }
  }

 private:
  // Not more cells than a few per grain: a large box with few small grains must not fill the memory.
  void choose_counts(double edge, std::size_t grains) {
    const double most = 64 + 8.0 * static_cast<double>(grains);
    for (;; edge *= 1.25) {
      double cells = 1;
      for (int c = 0; c < 3; ++c) cells *= std::max(1.0, std::floor(box_.length[c] / edge));
      if (cells <= most) break;
    }
    for (int c = 0; c < 3; ++c) {
      count_[c] = static_cast<int>(std::max(1.0, std::floor(box_.length[c] / edge)));
      if (box_.periodic(c) && count_[c] < 3) count_[c] = 1;   // left and right neighbour would be the same cell
    }
  }

  std::array<int, 3> place(Vec3 position) const {
    std::array<int, 3> cell{};
    const Vec3 inside = box_.wrapped(position);
    for (int c = 0; c < 3; ++c) {
      const double t = inside[c] / box_.length[c] * count_[c];
      cell[c] = t > 0 ? static_cast<int>(std::min(t, count_[c] - 1.0)) : 0;   // not a number: 0
    }
    return cell;
  }

  int neighbours(int middle, int c, std::array<int, 3>& near) const {
    int many = 0;
    for (int step = -1; step <= 1; ++step) {
      if (count_[c] == 1 && step != 0) continue;
      const int cell = middle + step;
      if (box_.periodic(c)) near[many++] = (cell + count_[c]) % count_[c];
      else if (cell >= 0 && cell < count_[c]) near[many++] = cell;
    }
    return many;
  }

  std::size_t index(std::array<int, 3> cell) const {
    return (static_cast<std::size_t>(cell[0]) * count_[1] + cell[1]) * count_[2] + cell[2];
  }

  const PeriodicBox& box_;
  std::array<int, 3> count_{};
  std::vector<std::size_t> cell_of_;
  std::vector<std::uint32_t> start_, grains_;
};

}   // namespace

void find_near_pairs(const PeriodicBox& box, std::span<const Vec3> position, std::span<const double> reach,
                     std::span<const std::uint8_t> fixed, PairList& pairs) {
  pairs.lower.clear();
  pairs.higher.clear();
  if (position.empty()) return;
  const CellGrid cells(box, position, 2 * *std::max_element(reach.begin(), reach.end()));
  std::vector<std::uint32_t> partners;
  for (std::uint32_t i = 0; i < position.size(); ++i) {
    partners.clear();
    cells.around(position[i], [&](std::uint32_t j) {
      if (j <= i || (!fixed.empty() && fixed[i] && fixed[j])) return;
      const double sum = reach[i] + reach[j];
      if (norm2(box.shortest(position[j] - position[i])) < sum * sum) partners.push_back(j);
    });
    std::sort(partners.begin(), partners.end());
    pairs.lower.insert(pairs.lower.end(), partners.size(), i);
    pairs.higher.insert(pairs.higher.end(), partners.begin(), partners.end());
  }
}

void check_periodic_sides(const PeriodicBox& box, double largest_diameter) {
  for (int c = 0; c < 3; ++c) {
    if (!box.periodic(c) || box.length[c] >= 2 * largest_diameter) continue;
    throw Error(
        ErrorKind::study_invalid,
        fmt::format(
            "box: the periodic side along {} is {:.6g} m, less than two diameters of the largest grain ({:.6g} m)",
            "xyz"[c], box.length[c], largest_diameter),
        "make the side longer, or a wall");
  }
}

}   // namespace bedload

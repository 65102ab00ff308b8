// Grains counted into cells not smaller than the largest reach; each grain looks into its cell and those around.
#include "solver/grains/neighbour_search.hpp"

#include <immintrin.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include "base/error.hpp"

namespace bedload {
namespace {

constexpr std::size_t lanes = 8;
using Floats = float __attribute__((vector_size(32)));

Floats load(const float* at) {
  Floats r;
  std::memcpy(&r, at, sizeof r);
  return r;
}

/// Grains side by side, in float; room to read a whole register beyond the last.
struct Candidates {
  std::vector<float> x, y, z, reach;   // [m]
  std::vector<std::uint32_t> id;
  std::size_t count = 0;

  void resize(std::size_t n) {
    count = n;
    if (n + lanes <= id.size()) return;
    x.resize(n + lanes), y.resize(n + lanes), z.resize(n + lanes), reach.resize(n + lanes), id.resize(n + lanes);
  }
  /// Appends those of another from `first` to `last`, in whole registers.
  void append(const Candidates& other, std::size_t first, std::size_t last) {
    const std::size_t at = count;
    resize(at + last - first);
    for (std::size_t k = 0; k < last - first; k += lanes) {
      for (const auto array : {&Candidates::x, &Candidates::y, &Candidates::z, &Candidates::reach})
        std::memcpy((this->*array).data() + at + k, (other.*array).data() + first + k, lanes * sizeof(float));
      std::memcpy(id.data() + at + k, other.id.data() + first + k, lanes * sizeof(std::uint32_t));
    }
  }
};

/// Cells over the box not smaller than the longest reach of a pair, and the grains of each in order of id; cells along z
/// lie one after the other.
class CellGrid {
 public:
  CellGrid(const PeriodicBox& box, std::span<const Vec3> position, std::span<const double> reach) : box_(box) {
    choose_counts(2 * *std::ranges::max_element(reach), position.size());
    std::vector<std::uint32_t> cell(position.size());
    start_.assign(static_cast<std::size_t>(count_[0]) * count_[1] * count_[2] + 1, 0);
    for (std::size_t i = 0; i < position.size(); ++i) ++start_[(cell[i] = cell_at(position[i])) + 1];
    for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
    std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
    grains_.resize(position.size());
    for (std::uint32_t i = 0; i < position.size(); ++i) {
      const std::uint32_t at = next[cell[i]]++;
      grains_.x[at] = static_cast<float>(position[i].x), grains_.y[at] = static_cast<float>(position[i].y);
      grains_.z[at] = static_cast<float>(position[i].z), grains_.reach[at] = static_cast<float>(reach[i]);
      grains_.id[at] = i;
    }
  }

  /// Visits stretches of a few cells along z: visit(ids of the grains in it, all candidates in it and around it).
  template <class Visit>
  void for_each_stretch(Visit&& visit) const {
    constexpr int longest = 6;   // [cells]
    Candidates around;
    for (int x = 0; x < count_[0]; ++x)
      for (int y = 0; y < count_[1]; ++y)
        for (int z = 0; z < count_[2]; z += longest) {
          const int last = std::min(z + longest, count_[2]);
          const std::size_t column = index(x, y), first = start_[column + z], end = start_[column + last];
          if (first == end) continue;
          gather_around(x, y, z, last, around);
          visit(std::span(grains_.id).subspan(first, end - first), around);
        }
  }

 private:
  void gather_around(int x, int y, int z, int last, Candidates& around) const {
    around.resize(0);
    std::array<int, 3> xs{}, ys{};
    const int many_x = neighbours(x, 0, xs), many_y = neighbours(y, 1, ys);
    const auto append = [&](std::size_t column, int from, int to) {
      around.append(grains_, start_[column + from], start_[column + to]);
    };
    for (int a = 0; a < many_x; ++a)
      for (int b = 0; b < many_y; ++b) {
        const std::size_t column = index(xs[a], ys[b]);
        append(column, std::max(z - 1, 0), std::min(last + 1, count_[2]));
        if (!box_.periodic(2)) continue;   // cells beyond the seam, unless they are there already
        if (z == 0 && last + 1 < count_[2]) append(column, count_[2] - 1, count_[2]);
        if (last == count_[2] && z > 1) append(column, 0, 1);
      }
  }

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
      per_length_[c] = count_[c] / box_.length[c];
    }
  }

  std::size_t index(int x, int y) const { return (static_cast<std::size_t>(x) * count_[1] + y) * count_[2]; }

  std::uint32_t cell_at(Vec3 position) const {
    std::uint32_t cell = 0;
    const Vec3 inside = box_.wrapped(position);
    for (int c = 0; c < 3; ++c) {
      const double t = inside[c] * per_length_[c];
      cell = cell * static_cast<std::uint32_t>(count_[c]) +
             (t > 0 ? static_cast<std::uint32_t>(std::min(t, count_[c] - 1.0)) : 0);   // not a number: 0
    }
    return cell;
  }

  int neighbours(int middle, int c, std::array<int, 3>& near) const {
    if (count_[c] == 1) return near[0] = 0, 1;
    int many = 0;
    for (int cell = middle - 1; cell <= middle + 1; ++cell) {
      if (cell >= 0 && cell < count_[c]) near[many++] = cell;
      else if (box_.periodic(c)) near[many++] = cell < 0 ? cell + count_[c] : cell - count_[c];
    }
    return many;
  }

  const PeriodicBox& box_;
  std::array<int, 3> count_{};
  std::array<double, 3> per_length_{};
  std::vector<std::uint32_t> start_;
  Candidates grains_;
};

/// Finds those that may be near, a register at a time and in float: a bit more than the reach, so that rounding loses none.
class NearTest {
 public:
  explicit NearTest(const PeriodicBox& box) {
    for (int c = 0; c < 3; ++c) {
      length_[c] = static_cast<float>(box.length[c]), inverse_[c] = static_cast<float>(box.inverse[c]);
      rounding_ = std::max(rounding_, 8 * std::numeric_limits<float>::epsilon() * length_[c]);
    }
  }

  /// Visits the ids of candidates that may be within reach of a grain.
  template <class Visit>
  void operator()(const Candidates& all, Vec3 centre, double reach, Visit&& visit) const {
    const float x = static_cast<float>(centre.x), y = static_cast<float>(centre.y), z = static_cast<float>(centre.z);
    const float own = static_cast<float>(reach) + rounding_;
    constexpr std::size_t at_once = 64;   // bits
    for (std::size_t first = 0; first < all.count; first += at_once) {
      const std::size_t last = std::min(all.count, first + at_once);
      std::uint64_t hits = 0;
      for (std::size_t at = first; at < last; at += lanes) {
        const Floats dx = shortest(load(&all.x[at]) - x, 0), dy = shortest(load(&all.y[at]) - y, 1);
        const Floats dz = shortest(load(&all.z[at]) - z, 2), sum = load(&all.reach[at]) + own;
        const auto near = dx * dx + dy * dy + dz * dz < sum * sum;
        hits |= static_cast<std::uint64_t>(_mm256_movemask_ps(reinterpret_cast<__m256>(near))) << (at - first);
      }
      if (last - first < at_once) hits &= (std::uint64_t{1} << (last - first)) - 1;
      for (; hits; hits &= hits - 1) visit(all.id[first + static_cast<std::size_t>(std::countr_zero(hits))]);
    }
  }

 private:
  Floats shortest(Floats d, int c) const {
    if (inverse_[c] == 0) return d;
    constexpr float rounds = 0x1.8p23f;   // adding and taking away rounds
    return d - length_[c] * ((d * inverse_[c] + rounds) - rounds);
  }

  float length_[3], inverse_[3], rounding_ = 0;
};

/// Partners of one grain: a stretch of a list.
struct Partners {
  std::uint32_t first = 0, count = 0;
};

}   // namespace

void find_near_pairs(const PeriodicBox& box, std::span<const Vec3> position, std::span<const double> reach,
                     std::span<const std::uint8_t> fixed, PairList& pairs) {
  pairs.lower.clear();
  pairs.higher.clear();
  if (position.empty()) return;
  const CellGrid cells(box, position, reach);
  const NearTest may_be_near(box);
  std::vector<std::uint32_t> found;   // by stretches of cells
  std::vector<Partners> partners_of(position.size());
  found.reserve(8 * position.size());
  cells.for_each_stretch([&](std::span<const std::uint32_t> own, const Candidates& around) {
    for (const std::uint32_t i : own) {
      const std::size_t first = found.size();
      may_be_near(around, position[i], reach[i], [&](std::uint32_t j) {
        if (j <= i || (!fixed.empty() && fixed[i] && fixed[j])) return;
        const double sum = reach[i] + reach[j];
        if (norm2(box.shortest(position[j] - position[i])) < sum * sum) found.push_back(j);
      });
      std::sort(found.begin() + static_cast<std::ptrdiff_t>(first), found.end());
      partners_of[i] = {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(found.size() - first)};
    }
  });
  pairs.lower.reserve(found.size()), pairs.higher.reserve(found.size());
  for (std::uint32_t i = 0; i < position.size(); ++i) {
    const auto first = found.begin() + partners_of[i].first;
    pairs.lower.insert(pairs.lower.end(), partners_of[i].count, i);
    pairs.higher.insert(pairs.higher.end(), first, first + partners_of[i].count);
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

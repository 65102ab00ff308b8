// Crystal with vacancies, then Monte Carlo moves of hard spheres.
#include "solver/grains/suspension.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/random_stream.hpp"
#include "solver/grains/box_walls.hpp"

namespace bedload {
namespace {

constexpr int sweeps = 200;   // moves tried per grain; each up to a gap of the crystal

/// A face-centred cubic crystal stretched to fill the box; its outermost sites lie a radius from walls.
struct Crystal {
  std::array<int, 3> cells{};   // of four sites each
  Vec3 edge;                    // of a cell [m]
  Vec3 origin;                  // corner of the first cell [m]
  double nearest = 0;           // distance of neighbouring sites [m]

  std::uint64_t sites() const { return std::uint64_t{4} * cells[0] * cells[1] * cells[2]; }
  Vec3 site(std::uint64_t n) const {
    constexpr double offset[4][3] = {{0.25, 0.25, 0.25}, {0.75, 0.75, 0.25}, {0.75, 0.25, 0.75}, {0.25, 0.75, 0.75}};
    const auto& o = offset[n % 4];
    const std::uint64_t cell = n / 4;
    const auto k = double(cell % cells[2]), j = double(cell / cells[2] % cells[1]),
               i = double(cell / cells[2] / cells[1]);
    return origin + Vec3{(i + o[0]) * edge.x, (j + o[1]) * edge.y, (k + o[2]) * edge.z};
  }
};

Crystal crystal_of(const BedScene& scene, std::array<int, 3> cells, double largest) {
  Crystal made{.cells = cells};
  for (int c = 0; c < 3; ++c) {
    const bool wall = scene.sides[c] == Side::wall;   // sites lie a quarter of a cell from the ends of the crystal
    made.edge[c] = wall ? (scene.length[c] - largest) / (cells[c] - 0.5) : scene.length[c] / cells[c];
    made.origin[c] = wall ? 0.5 * largest - 0.25 * made.edge[c] : 0;
  }
  const Vec3 half = 0.5 * made.edge;
  made.nearest = std::min({std::hypot(half.x, half.y), std::hypot(half.y, half.z), std::hypot(half.x, half.z)});
  return made;
}

/// The widest of the crystals near the ideal one that have a site for every grain.
Crystal crystal_for(const BedScene& scene, std::uint64_t count, double largest) {
  const Vec3 length = scene.length;
  const double ideal = std::cbrt(4 * length.x * length.y * length.z / double(count));
  std::optional<Crystal> best;
  for (int n = 0; n < 64; ++n) {
    const std::array<int, 3> more = {n % 4, n / 4 % 4, n / 16};
    std::array<int, 3> cells{};
    for (int c = 0; c < 3; ++c) cells[c] = std::max(1, static_cast<int>(length[c] / ideal) - 1 + more[c]);
    const Crystal one = crystal_of(scene, cells, largest);
    if (one.sites() < count) continue;
    if (!best || one.nearest > best->nearest) best = one;
  }
  if (best && best->nearest > largest) return *best;
  throw Error(ErrorKind::study_invalid,
              fmt::format("bed: {} grains of up to {:.4g} m do not fit a box of {:.4g} x {:.4g} x {:.4g} m without "
                          "touching",
                          count, largest, length.x, length.y, length.z),
              "fewer grains, or a larger box; edges that are equal multiples of each other pack best");
}

/// Grains sorted into cells at least one largest diameter wide.
class CellList {
 public:
  CellList(const BedScene& scene, double largest) : scene_(scene), box_(scene) {
    for (int c = 0; c < 3; ++c) count_[c] = std::max(1, static_cast<int>(scene.length[c] / largest));
    members_.resize(std::size_t(count_[0]) * count_[1] * count_[2]);
  }
  void insert(std::uint32_t grain, Vec3 place) { members_[cell(place)].push_back(grain); }
  void remove(std::uint32_t grain, Vec3 place) {
    auto& those = members_[cell(place)];
    those.erase(std::ranges::find(those, grain));
  }
  /// True if visit(neighbour) is true for any grain that might touch one at `place`.
  template <class Visit>
  bool any_near(Vec3 place, Visit&& visit) const {
    std::array<std::array<int, 3>, 3> near{};
    std::array<int, 3> n{};
    for (int c = 0; c < 3; ++c)
      for (int step = -1; step <= 1; ++step) {
        int one = along(place, c) + step;
        if (box_.periodic(c)) one = (one + count_[c]) % count_[c];
        else if (one < 0 || one >= count_[c]) continue;
        int* const end = near[c].data() + n[c];
        if (std::find(near[c].data(), end, one) == end) near[c][n[c]++] = one;
      }
    for (int i = 0; i < n[0]; ++i)
      for (int j = 0; j < n[1]; ++j)
        for (int k = 0; k < n[2]; ++k)
          for (const auto grain : members_[index(near[0][i], near[1][j], near[2][k])])
            if (visit(grain)) return true;
    return false;
  }

 private:
  int along(Vec3 place, int c) const {
    return std::clamp(static_cast<int>(place[c] / scene_.length[c] * count_[c]), 0, count_[c] - 1);
  }
  std::size_t index(int i, int j, int k) const { return (std::size_t(i) * count_[1] + j) * count_[2] + k; }
  std::size_t cell(Vec3 place) const { return index(along(place, 0), along(place, 1), along(place, 2)); }

  const BedScene& scene_;
  PeriodicBox box_;
  std::array<int, 3> count_{};
  std::vector<std::vector<std::uint32_t>> members_;
};

/// As many of the crystal's sites as there are grains, the vacancies spread evenly.
std::vector<Vec3> choose_sites(const Crystal& crystal, std::uint64_t count) {
  std::vector<Vec3> places(count);
  for (std::uint64_t n = 0; n < count; ++n) places[n] = crystal.site(n * crystal.sites() / count);
  return places;
}

}   // namespace

void check_suspension_fits(const BedScene& scene, double largest_diameter) {
  if (scene.source.count > 0) crystal_for(scene, scene.source.count, largest_diameter);
}

std::vector<Vec3> places_in_suspension(const BedScene& scene, const std::vector<double>& diameters) {
  if (diameters.empty()) return {};
  const double largest = std::ranges::max(diameters);
  const Crystal crystal = crystal_for(scene, diameters.size(), largest);
  auto places = choose_sites(crystal, diameters.size());

  const PeriodicBox box(scene);
  CellList cells(scene, largest);
  for (std::uint32_t i = 0; i < places.size(); ++i) cells.insert(i, places[i]);
  const auto fits = [&](std::uint32_t grain, Vec3 place) {
    for (int c = 0; c < 3; ++c) {
      const double r = 0.5 * diameters[grain];
      if (!box.periodic(c) && (place[c] < r || place[c] > scene.length[c] - r)) return false;
    }
    return !cells.any_near(place, [&](std::uint32_t other) {
      const double apart = 0.5 * (diameters[grain] + diameters[other]);
      return other != grain && norm2(box.shortest(place - places[other])) < apart * apart;
    });
  };
  const double reach = crystal.nearest - largest;
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (std::uint32_t i = 0; i < places.size(); ++i) {
      RandomStream random(scene.source.seed, Stream::grain_place, i, 1 + sweep);
      Vec3 move;
      for (int c = 0; c < 3; ++c) move[c] = (2 * random.uniform() - 1) * reach;
      const Vec3 place = box.wrapped(places[i] + move);
      if (!fits(i, place)) continue;
      cells.remove(i, places[i]);
      places[i] = place;
      cells.insert(i, place);
    }
  return places;
}

}   // namespace bedload

// Who the grains of a scene are: of a packed bed by its kind, of a table by looking.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/coupling/packing_of_others.hpp"
#include "solver/coupling/wall_effects.hpp"
#include "solver/expected_bed.hpp"
#include "solver/grains/bed_packing.hpp"
#include "solver/scene_numbers.hpp"

namespace bedload {

namespace {

constexpr double neighbourhood = 2;     // radius around a grain in which others count, in diameters
constexpr double packed_around = 0.2;   // packing of others, by that measure, at grains that lie on each other
constexpr double packed = 0.5;          // packing at which grains that float cannot pass each other
constexpr double sparse =
    0.2;   // expected depth in diameters below which settled grains are no bed: a fifth of a layer

/// What two spheres have in common [m3]; `far` apart, the larger first.
double common_volume(double large, double small, double far) {
  if (far >= large + small) return 0;
  if (far <= large - small) return sphere_volume(2 * small);
  const double depth = large + small - far, difference = large - small;
  return std::numbers::pi * depth * depth * (far * far + 2 * far * (large + small) - 3 * difference * difference) /
         (12 * far);
}

/// Packing density of the other grains within two diameters of each grain, in the space that it leaves; a wall is empty.
class Neighbourhoods {
 public:
  Neighbourhoods(const StaggeredGrid& grid, const Grains& grains)
      : grid_(grid), grains_(grains), order_(grains.size()) {
    for (std::size_t n = 0; n < order_.size(); ++n) order_[n] = n;
    std::ranges::stable_sort(order_, {}, [&](std::size_t n) { return grains.position[n].x; });
    largest_ = *std::ranges::max_element(grains.diameter);
  }
  std::vector<double> packing() const {
    std::vector<double> found(grains_.size(), 0.0);
    const double reach = (neighbourhood + 0.5) * largest_, length = grid_.length().x;
    for (std::size_t a = 0; a < order_.size(); ++a)
      for (std::size_t step = 1; step < order_.size(); ++step) {   // downstream, round the period
        const std::size_t b = a + step;
        if (b >= order_.size() && !grid_.periodic(0)) break;
        const double ahead = x_of(b % order_.size()) - x_of(a) + (b >= order_.size() ? length : 0.0);
        if (ahead > reach) break;
        add(order_[a], order_[b % order_.size()], ahead, found);
      }
    return found;
  }

 private:
  double x_of(std::size_t place) const { return grains_.position[order_[place]].x; }
  /// Of the images across the seam in x, the one `ahead`; in y and z the nearest.
  void add(std::size_t n, std::size_t m, double ahead, std::vector<double>& found) const {
    Vec3 apart = grains_.position[m] - grains_.position[n];
    apart.x = ahead;
    for (int c = 1; c < 3; ++c)
      if (grid_.periodic(c)) apart[c] -= grid_.length()[c] * std::round(apart[c] / grid_.length()[c]);
    for (const auto& [at, other] : {std::pair{n, m}, {m, n}}) {
      const double radius = neighbourhood * grains_.diameter[at];
      const double space = sphere_volume(2 * radius) - sphere_volume(grains_.diameter[at]);
      found[at] += common_volume(std::max(radius, 0.5 * grains_.diameter[other]),
                                 std::min(radius, 0.5 * grains_.diameter[other]), norm(apart)) /
                   space;
    }
  }

  const StaggeredGrid& grid_;
  const Grains& grains_;
  std::vector<std::size_t> order_;   // by x
  double largest_;
};

/// True for a grain that falls to a bottom, or rises to a lid.
bool lands(const BedScene& bed, double density) {
  const double weight = (density - bed.fluid.density) * bed.gravity.z;
  return bed.sides[2] == Side::wall && (weight < 0 || (weight > 0 && bed.top == Top::lid));
}

/// a/z to the wall that is nearest now, or 1 where a grain that is not fixed comes to rest.
double nearness_of(const Scene& scene, const Grains& grains, std::size_t n) {
  if (!grains.fixed[n] && lands(scene.bed, grains.density[n])) return 1;
  const auto wall = nearest_wall(scene.grid, grains.position[n]);
  return wall ? std::min(0.5 * grains.diameter[n] / wall->distance, 1.0) : 0;
}

void count_table(const Scene& scene, GrainCensus& census) {
  const Grains grains = place_grains(scene.bed);
  const auto around = Neighbourhoods(scene.grid, grains).packing();
  census.smallest = *std::ranges::min_element(grains.diameter);
  for (std::size_t n = 0; n < grains.size(); ++n) {
    census.mobile |= !grains.fixed[n];
    census.fastest = std::max(census.fastest, norm(grains.velocity[n]));
    if (!grains.fixed[n]) census.fastest_spin = std::max(census.fastest_spin, norm(grains.spin[n]));
    census.densest = std::max(census.densest, around[n]);
    census.loosest = std::min(census.loosest, around[n]);
    if (loneness(around[n], scene.terms.crowded) > 0)
      census.nearness = std::max(census.nearness, nearness_of(scene, grains, n));
  }
  census.bed = census.densest > packed_around;
}

void count_packed(const Scene& scene, GrainCensus& census) {
  const auto& bed = scene.bed;
  census.mobile = !bed.source.fixed;
  const double dispersed = static_cast<double>(bed.source.count) * sphere_volume(bed.grains.diameter) /
                           (bed.length.x * bed.length.y * bed.length.z);
  const bool settles = needs_settling(bed) && expected_bed_depth(bed) > sparse * bed.grains.diameter;
  census.bed = settles || dispersed > packed;
  census.densest = settles ? loose_packing : dispersed;
  census.loosest = settles ? 0 : dispersed;
  if (!settles && loneness(dispersed, scene.terms.crowded) > 0 && census.mobile && lands(bed, bed.grains.density))
    census.nearness = 1;
  census.smallest = smallest_diameter(bed);
}

}   // namespace

GrainCensus census_of(const Scene& scene) {
  GrainCensus census;
  const auto& bed = scene.bed;
  if (bed.source.kind == BedSource::Kind::none || bed.source.count == 0) return census;
  census.any = true;
  if (bed.source.kind == BedSource::Kind::file) count_table(scene, census);
  else count_packed(scene, census);
  const bool walls = std::ranges::find(bed.sides, Side::wall) != bed.sides.end();
  census.collide = census.mobile && (bed.source.count > 1 || walls);
  census.may_turn = census.fastest_spin > 0 || (census.collide && bed.grains.friction > 0);
  return census;
}

}   // namespace bedload

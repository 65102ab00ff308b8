// Where grains start: loose random layers to pour, regular layers, or a table.
#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/random_stream.hpp"
#include "solver/grains/bed_packing.hpp"
#include "solver/grains/box_walls.hpp"
#include "solver/grains/grain_table.hpp"
#include "solver/grains/neighbour_search.hpp"
#include "solver/grains/suspension.hpp"

namespace bedload {
namespace {

/// Layers of nx x ny places, one above the other, each place wide enough for the largest grain.
struct Layers {
  std::uint64_t nx, ny, count;
  Vec3 spacing;   // [m]
};

std::uint64_t places_along(double length, double pitch) {
  return static_cast<std::uint64_t>(length / pitch * (1 + 1e-12));
}

/// Layers whose places are `clearance` largest diameters apart, if the grains then fit below the top.
std::optional<Layers> layers_with(const BedScene& scene, double largest, double clearance) {
  const double pitch = clearance * largest;
  const std::uint64_t nx = places_along(scene.length.x, pitch), ny = places_along(scene.length.y, pitch);
  if (nx * ny == 0) return std::nullopt;
  const std::uint64_t count = (scene.source.count + nx * ny - 1) / (nx * ny);
  if (count > places_along(scene.length.z, pitch)) return std::nullopt;
  // Without a bottom the grains are spread over the whole height.
  const double height = scene.sides[2] == Side::periodic ? scene.length.z / static_cast<double>(count) : pitch;
  return Layers{
      nx, ny, count, {scene.length.x / static_cast<double>(nx), scene.length.y / static_cast<double>(ny), height}};
}

Layers layers_that_fit(const BedScene& scene, double largest) {
  const bool poured = scene.source.kind == BedSource::Kind::poured;
  for (const double clearance : {1.15, 1.1, 1.05, 1.0}) {
    if (!poured && clearance > 1.0) continue;
    if (const auto layers = layers_with(scene, largest, clearance)) return *layers;
  }
  const std::uint64_t fit = places_along(scene.length.x, largest) * places_along(scene.length.y, largest) *
                            places_along(scene.length.z, largest);
  throw Error(
      ErrorKind::study_invalid,
      fmt::format(
          "bed: {} grains of up to {:.4g} m do not fit the box of {:.4g} x {:.4g} x {:.4g} m before they settle; "
          "{} do",
          scene.source.count, largest, scene.length.x, scene.length.y, scene.length.z, fit),
      "raise box.height, or lower bed.count or bed.depth");
}

/// Normal about the mean, drawn anew beyond two deviations.
double draw_diameter(const BedScene& scene, std::uint32_t grain) {
  RandomStream random(scene.source.seed, Stream::grain_diameter, grain);
  double deviation = random.normal();
  while (std::abs(deviation) > 2) deviation = random.normal();
  return scene.grains.diameter * (1 + scene.grains.spread * deviation);
}

/// Place number n of its layer; a last layer with fewer grains than places has them spread evenly.
Vec3 place_in_layers(const BedScene& scene, const Layers& layers, std::uint64_t grain) {
  const std::uint64_t per_layer = layers.nx * layers.ny, layer = grain / per_layer;
  const std::uint64_t in_layer = std::min(per_layer, scene.source.count - layer * per_layer);
  const std::uint64_t site = grain % per_layer * per_layer / in_layer;
  const std::uint64_t row = site / layers.ny, column = site % layers.ny;
  return {(static_cast<double>(row) + 0.5) * layers.spacing.x, (static_cast<double>(column) + 0.5) * layers.spacing.y,
          (static_cast<double>(layer) + 0.5) * layers.spacing.z};
}

/// Within the room that a place leaves a grain; whole layers are also shifted along periodic sides.
Vec3 shaken(const BedScene& scene, const Layers& layers, double largest, std::uint64_t grain, Vec3 place) {
  const auto layer = static_cast<std::uint32_t>(grain / (layers.nx * layers.ny));
  RandomStream of_grain(scene.source.seed, Stream::grain_place, static_cast<std::uint32_t>(grain));
  RandomStream of_layer(scene.source.seed, Stream::grain_place, layer, 1);
  for (int c = 0; c < 3; ++c) {
    place[c] += (of_grain.uniform() - 0.5) * std::max(0.0, layers.spacing[c] - largest);
    const double shift = of_layer.uniform() * layers.spacing[c];
    if (c < 2 && scene.sides[c] == Side::periodic) place[c] += shift;
  }
  return PeriodicBox(scene).wrapped(place);
}

Grains grains_in_layers(const BedScene& scene) {
  Grains grains;
  if (scene.source.count == 0) return grains;
  grains.resize(scene.source.count);
  for (std::uint32_t i = 0; i < grains.size(); ++i) grains.diameter[i] = draw_diameter(scene, i);
  std::ranges::fill(grains.density, scene.grains.density);
  const double largest = *std::ranges::max_element(grains.diameter);
  check_periodic_sides(PeriodicBox(scene), largest);
  const Layers layers = layers_that_fit(scene, largest);
  for (std::uint64_t i = 0; i < grains.size(); ++i) {
    grains.position[i] = place_in_layers(scene, layers, i);
    if (scene.source.kind == BedSource::Kind::poured)
      grains.position[i] = shaken(scene, layers, largest, i, grains.position[i]);
  }
  return grains;
}

Grains grains_in_suspension(const BedScene& scene) {
  Grains grains;
  grains.resize(scene.source.count);
  for (std::uint32_t i = 0; i < grains.size(); ++i) grains.diameter[i] = draw_diameter(scene, i);
  std::ranges::fill(grains.density, scene.grains.density);
  std::ranges::fill(grains.fixed, std::uint8_t{scene.source.fixed});
  if (grains.size() > 0) check_periodic_sides(PeriodicBox(scene), std::ranges::max(grains.diameter));
  grains.position = places_in_suspension(scene, grains.diameter);
  return grains;
}

}   // namespace

Grains place_grains(const BedScene& scene) {
  switch (scene.source.kind) {
    case BedSource::Kind::none: return {};
    case BedSource::Kind::file: return read_grain_table(scene);
    case BedSource::Kind::suspension: return grains_in_suspension(scene);
    case BedSource::Kind::poured:
    case BedSource::Kind::lattice: break;
  }
  return grains_in_layers(scene);
}

}   // namespace bedload

// The bed that all benchmarks share: one periodic tile of 2000 grains poured once, and repeated side by side.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

#include "checkpoint/checkpoint.hpp"
#include "solver/grains/bed_packing.hpp"

namespace bedload::benchmarks {

inline constexpr std::size_t grains_of_a_tile = 2000;
inline constexpr double grain_diameter = 1e-3;     // mean; spread 5 % [m]
inline constexpr double tile_edge = 15e-3;         // along x and y; the bed is then about 8 d deep [m]
inline constexpr double box_height = 20e-3;        // [m]
inline constexpr double submerged_weight = 6.54;   // per mass: (1 - 1000/3000) 9.81 [m/s2]

/// 5 MPa: stiff enough for every code that is compared with (one takes no less), and 1e-5 s is then 0.17 Rayleigh times of
/// the smallest grain.
inline BedScene scene_of_tiles(int along_x, int along_y) {
  BedScene scene;
  scene.fluid = {1000, 1e-5};
  scene.grains = {grain_diameter, 3000, 0.05, 0.4, 0.6, 0.3, 5e6};
  scene.source = {BedSource::Kind::poured, grains_of_a_tile * along_x * along_y, "", 1};
  scene.length = {along_x * tile_edge, along_y * tile_edge, box_height};
  scene.sides = {Side::periodic, Side::periodic, Side::wall};
  scene.gravity = {0, 0, -9.81};
  scene.dem_step = 1e-5;
  return scene;
}

struct Bed {
  BedScene scene;
  Grains grains;
  ContactHistory contacts;
};

/// Poured by the first benchmark that asks, and kept beside the benchmarks for all others, of this build or a changed one:
/// they then start on the same bed. Remove settled_tile.*.h5 to have it poured anew.
inline Bed settled_tile() {
  const auto file = std::filesystem::path(BEDLOAD_BENCHMARK_DIR) / fmt::format("settled_tile.{}.h5", physics_version);
  Bed tile{scene_of_tiles(1, 1), {}, {}};
  if (std::filesystem::exists(file)) {
    State state = read_checkpoint(file);
    tile.grains = std::move(state.grains), tile.contacts = std::move(state.contacts);
    return tile;
  }
  tile.grains = place_grains(tile.scene);
  BedPacking packing(tile.scene);
  while (!packing.advance(tile.grains, tile.contacts).settled) {
  }
  State state;
  state.grains = tile.grains, state.contacts = tile.contacts;
  write_checkpoint(file, state);
  return tile;
}

/// Tiles side by side, along x and y, with the contacts across their seams and all springs: at rest as the tile is.
inline Bed repeated(const Bed& tile, int along_x, int along_y) {
  Bed bed{scene_of_tiles(along_x, along_y), {}, {}};
  const std::size_t n = tile.grains.size();
  const auto tile_at = [&](int i, int j) {
    return std::size_t((i + along_x) % along_x) * along_y + std::size_t((j + along_y) % along_y);
  };
  bed.grains.resize(n * along_x * along_y);
  for (int i = 0; i < along_x; ++i)
    for (int j = 0; j < along_y; ++j) {
      const std::size_t first = n * tile_at(i, j);
      for (std::size_t g = 0; g < n; ++g) {
        bed.grains.position[first + g] = tile.grains.position[g] + Vec3{i * tile_edge, j * tile_edge, 0};
        bed.grains.diameter[first + g] = tile.grains.diameter[g];
        bed.grains.density[first + g] = tile.grains.density[g];
      }
      for (std::size_t k = 0; k < tile.contacts.size(); ++k) {
        const std::uint32_t lower = tile.contacts.lower[k], higher = tile.contacts.higher[k];
        std::size_t partner = higher;   // a wall
        if (higher < n) {
          const Vec3 apart = tile.grains.position[higher] - tile.grains.position[lower];
          const int across_x = -int(std::rint(apart.x / tile_edge)), across_y = -int(std::rint(apart.y / tile_edge));
          partner += n * tile_at(i + across_x, j + across_y);
        }
        bed.contacts.lower.push_back(std::uint32_t(first + lower));
        bed.contacts.higher.push_back(std::uint32_t(partner));
        bed.contacts.spring.push_back(tile.contacts.spring[k]);
      }
    }
  renumber_in_space(bed.scene, bed.grains, bed.contacts);   // sorts the contacts, turns those whose order is the other
  return bed;
}

/// Tiles along x and y of the beds measured: 2 000, 20 000, 200 000, 1 000 000 grains. That of 20 000 is 75 d x 30 d.
inline std::array<int, 2> tiles_of(std::size_t grains) {
  switch (grains) {
    case 2'000: return {1, 1};
    case 20'000: return {5, 2};
    case 200'000: return {10, 10};
    case 1'000'000: return {25, 20};
  }
  throw std::invalid_argument(fmt::format("no bed of {} grains: 2000, 20000, 200000 or 1000000", grains));
}

/// The last bed asked for is kept.
inline const Bed& settled_bed(std::size_t grains) {
  static const Bed tile = settled_tile();
  static Bed bed;
  const auto [along_x, along_y] = tiles_of(grains);
  if (bed.grains.size() != grains) bed = repeated(tile, along_x, along_y);
  return bed;
}

/// What acts on the grains of a bed besides contacts: their submerged weight and, on those of the top layers, a push along x
/// of `push` weights against a linear drag.
struct Drive {
  std::vector<Vec3> acceleration;
  std::vector<double> relaxation;
  GrainDrive drive() const { return {.push = acceleration, .relaxation = relaxation}; }
};

inline constexpr double pushed_depth =
    3.5 * grain_diameter;   // of the layers below the highest grain that are pushed [m]
inline constexpr double push_in_weights = 0.8;
inline constexpr double drag_coefficient = 1.6e-4;   // of a pushed grain [kg/s]: about 100 1/s

inline Drive drive_of(const Bed& bed, bool eroding) {
  const Grains& grains = bed.grains;
  Drive drive{std::vector(grains.size(), Vec3{0, 0, -submerged_weight}), std::vector(grains.size(), 0.0)};
  if (!eroding) return drive;
  double top = 0;
  for (const Vec3& p : grains.position) top = std::max(top, p.z);
  for (std::size_t i = 0; i < grains.size(); ++i) {
    if (grains.position[i].z < top - pushed_depth) continue;
    drive.acceleration[i].x = push_in_weights * submerged_weight;
    drive.relaxation[i] = drag_coefficient / (grains.density[i] * sphere_volume(grains.diameter[i]));
  }
  return drive;
}

}   // namespace bedload::benchmarks

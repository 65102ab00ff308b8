// Where the bed ends and the flow begins: solid fraction by height, surface level, roughness, porosity.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "base/vec3.hpp"
#include "solver/grains/contact_history.hpp"
#include "solver/grains/grains.hpp"
#include "solver/grains/slice_volume.hpp"

namespace bedload {

/// Horizontally averaged solid fraction phi [-] in `bins` equal layers of the box, from exact slices.
/// Slices beyond bottom and top count in the outermost layers, so that the sum is the grains' volume.
std::vector<double> solid_fraction(const Grains&, Vec3 length, std::size_t bins);

struct BedSurface {
  double height = 0;      // z_b [m]: highest level at which phi is half of the bulk's; 0 without a bed
  double top = 0;         // mean elevation of the highest grain surface over columns of (d/2)^2 [m]
  double slope = 0;       // dz/dx of that elevation by least squares, rising downstream [-]
  double roughness = 0;   // standard deviation of the surface's elevation over columns of (d/2)^2 [m]
  double porosity = 1;    // of the bulk: the layers that hold the middle half of the solid volume [-]
};

/// Elevation of the highest grain surface above the middle of every column of about (d/2)^2 [m]; the bottom, 0, where there is none.
struct Elevations {
  long nx = 0, ny = 0;
  std::vector<double> heights;   // of column (i, j) at i ny + j

  /// Beyond an end the columns begin anew at the other.
  double& at(long i, long j) { return heights[index(i, j)]; }
  double at(long i, long j) const { return heights[index(i, j)]; }

 private:
  std::size_t index(long i, long j) const {
    const auto wrapped = [](long k, long n) { return ((k % n) + n) % n; };
    return static_cast<std::size_t>(wrapped(i, nx) * ny + wrapped(j, ny));
  }
};

/// Of grains of mean diameter d [m] that are slower than `slow` [m/s].
Elevations elevations(const Grains&, Vec3 length, double diameter,
                      double slow = std::numeric_limits<double>::infinity());

/// Surface of a bed of grains of mean diameter d [m]; layers of d/10. Layers looser than phi = 0.1 are no bed.
BedSurface bed_surface(const Grains&, Vec3 length, double diameter);

/// Mean number of grains that a grain touches, over those that can move (fixed: 1 = never, as in Grains); walls are not counted.
double coordination(const ContactHistory&, std::span<const std::uint8_t> fixed);

/// The same among the grains that bear something: rattlers, which touch fewer than two grains or walls, are left out with
/// their contacts, and then those that have become so; 0 where none is left. Fixed grains bear like walls.
double bearing_coordination(const ContactHistory&, std::span<const std::uint8_t> fixed);

}   // namespace bedload

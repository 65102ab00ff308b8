// Solid fraction, the half-density level, and the elevation seen from above.
#include "solver/bed/bed_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace bedload {

std::vector<double> solid_fraction(const Grains& grains, Vec3 length, std::size_t bins) {
  std::vector<double> volume(bins);
  const double bin = length.z / static_cast<double>(bins);
  const auto layer = [&](double z) {
    return static_cast<std::size_t>(std::clamp(z / bin, 0.0, static_cast<double>(bins - 1)));
  };
  for (std::size_t p = 0; p < grains.size(); ++p) {
    const double radius = grains.diameter[p] / 2, z = grains.position[p].z;
    const std::size_t first = layer(z - radius), last = layer(z + radius);
    for (std::size_t k = first; k <= last; ++k) {
      const double below = k == first ? -radius : static_cast<double>(k) * bin - z;
      const double above = k == last ? radius : static_cast<double>(k + 1) * bin - z;
      volume[k] += slice_volume(radius, below, above);
    }
  }
  for (double& v : volume) v /= length.x * length.y * bin;
  return volume;
}

namespace {

/// Mean phi between the levels that have a quarter and three quarters of the solid below them: deep enough to be
/// free of the surface, high enough to be free of the layering at the bottom, and defined for any bed.
double bulk_fraction(const std::vector<double>& phi) {
  const double total = std::accumulate(phi.begin(), phi.end(), 0.0);
  double below = 0, solid = 0, thickness = 0;
  for (const double layer : phi) {
    const double inside = std::min(below + layer, 0.75 * total) - std::max(below, 0.25 * total);
    if (inside > 0) solid += inside, thickness += inside / layer;
    below += layer;
  }
  return thickness > 0 ? solid / thickness : 0;
}

/// Highest level at which phi passes `half`, linear between the centres of the layers [layers].
double highest_crossing(const std::vector<double>& phi, double half) {
  for (std::size_t k = phi.size(); k-- > 0;) {
    if (phi[k] < half) continue;
    const double centre = static_cast<double>(k) + 0.5;
    if (k + 1 == phi.size()) return static_cast<double>(phi.size());
    return centre + (phi[k] - half) / (phi[k] - phi[k + 1]);
  }
  return 0;
}

long columns_along(double edge, double diameter) { return std::max(1L, std::lround(2 * edge / diameter)); }

}   // namespace

Elevations elevations(const Grains& grains, Vec3 length, double diameter, double slow) {
  Elevations top{columns_along(length.x, diameter), columns_along(length.y, diameter), {}};
  top.heights.resize(static_cast<std::size_t>(top.nx * top.ny));
  const double hx = length.x / static_cast<double>(top.nx), hy = length.y / static_cast<double>(top.ny);
  for (std::size_t p = 0; p < grains.size(); ++p) {
    if (norm2(grains.velocity[p]) > slow * slow) continue;
    const double radius = grains.diameter[p] / 2;
    const Vec3 at = grains.position[p];
    for (long i = std::lround((at.x - radius) / hx); (static_cast<double>(i) + 0.5) * hx < at.x + radius; ++i)
      for (long j = std::lround((at.y - radius) / hy); (static_cast<double>(j) + 0.5) * hy < at.y + radius; ++j) {
        const double x = (static_cast<double>(i) + 0.5) * hx - at.x, y = (static_cast<double>(j) + 0.5) * hy - at.y;
        const double rise = radius * radius - x * x - y * y;
        if (rise < 0) continue;
        double& column = top.at(i, j);
        column = std::max(column, at.z + std::sqrt(rise));
      }
  }
  return top;
}

namespace {

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Slope along x by least squares of `top`, columns of equal x in a row.
double slope_of(const std::vector<double>& top, double length, double diameter) {
  const auto nx = static_cast<std::size_t>(columns_along(length, diameter)), ny = top.size() / nx;
  double moment = 0, squares = 0;
  for (std::size_t n = 0; n < top.size(); ++n) {
    const double x = ((static_cast<double>(n / ny) + 0.5) / static_cast<double>(nx) - 0.5) * length;
    moment += x * top[n], squares += x * x;
  }
  return squares > 0 ? moment / squares : 0;
}

double standard_deviation(const std::vector<double>& values) {
  const double count = static_cast<double>(values.size()), mean = mean_of(values);
  double squares = 0;
  for (const double v : values) squares += (v - mean) * (v - mean);
  return std::sqrt(squares / count);
}

}   // namespace

BedSurface bed_surface(const Grains& grains, Vec3 length, double diameter) {
  const auto bins = static_cast<std::size_t>(std::max(1L, std::lround(10 * length.z / diameter)));
  const std::vector<double> phi = solid_fraction(grains, length, bins);
  const double bulk = bulk_fraction(phi);
  constexpr double loosest_bed = 0.1;
  if (bulk < loosest_bed) return {};
  const std::vector<double> top = elevations(grains, length, diameter).heights;
  return {.height = highest_crossing(phi, bulk / 2) * length.z / static_cast<double>(bins),
          .top = mean_of(top),
          .slope = slope_of(top, length.x, diameter),
          .roughness = standard_deviation(top),
          .porosity = 1 - bulk};
}

namespace {

constexpr auto first_wall = static_cast<std::uint32_t>(Wall::x_low);

bool is_free(std::uint8_t fixed) { return fixed != 1; }

std::int64_t free_among(std::span<const std::uint8_t> fixed) { return std::ranges::count_if(fixed, is_free); }

}   // namespace

double coordination(const ContactHistory& contacts, std::span<const std::uint8_t> fixed) {
  std::int64_t touches = 0;
  for (std::size_t c = 0; c < contacts.lower.size(); ++c)
    if (contacts.higher[c] < first_wall)
      touches += is_free(fixed[contacts.lower[c]]) + is_free(fixed[contacts.higher[c]]);
  const auto grains = free_among(fixed);
  return grains ? static_cast<double>(touches) / static_cast<double>(grains) : 0;
}

double bearing_coordination(const ContactHistory& contacts, std::span<const std::uint8_t> fixed) {
  constexpr std::uint32_t fewest = 2;   // with friction; one contact holds nothing
  std::vector<std::uint8_t> bears(fixed.size(), 1);
  for (bool found = true; found;) {   // without the rattlers, others may be left with too little
    std::vector<std::uint32_t> touches(fixed.size(), 0);
    std::int64_t of_free = 0, left = 0;
    for (std::size_t c = 0; c < contacts.lower.size(); ++c) {
      const std::uint32_t a = contacts.lower[c], b = contacts.higher[c];
      const bool wall = b >= first_wall;
      if (!bears[a] || (!wall && !bears[b])) continue;
      ++touches[a];
      if (!wall) ++touches[b], of_free += is_free(fixed[a]) + is_free(fixed[b]);
    }
    found = false;
    for (std::size_t p = 0; p < fixed.size(); ++p) {
      if (!is_free(fixed[p])) continue;
      if (bears[p] && touches[p] < fewest) bears[p] = 0, found = true;
      left += bears[p];
    }
    if (!found) return left ? static_cast<double>(of_free) / static_cast<double>(left) : 0;
  }
  return 0;
}

}   // namespace bedload

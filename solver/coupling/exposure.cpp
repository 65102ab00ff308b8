#include "solver/coupling/exposure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace bedload {
namespace {

constexpr double shelter_reach = 2;   // of the distance at which two grains touch
constexpr std::size_t directions = 16;

/// Unit vectors round the horizon, none along an axis or a diagonal of regular beds.
std::array<Vec3, directions> horizon() {
  std::array<Vec3, directions> around;
  for (std::size_t i = 0; i < directions; ++i) {
    const double angle = 2 * std::numbers::pi * (static_cast<double>(i) + 0.5) / directions;
    around[i] = {std::cos(angle), std::sin(angle), 0};
  }
  return around;
}

}   // namespace

std::span<const double> Sheltering::find(const PeriodicBox& box, const Grains& grains) {
  static const std::array<Vec3, directions> around = horizon();
  const std::size_t n = grains.size();
  reach_.resize(n), level_.resize(n);
  for (std::size_t p = 0; p < n; ++p) reach_[p] = 0.5 * shelter_reach * grains.diameter[p];
  find_near_pairs(box, grains.position, reach_, {}, pairs_);
  highest_.assign(directions * n, -1);
  const auto shelter = [&](std::size_t p, std::size_t by, Vec3 from) {   // `from` p to the other
    const double radius = 0.5 * grains.diameter[p], width = 0.5 * grains.diameter[by];
    const double top = std::min((from.z + width) / radius, 1.0), distance2 = from.x * from.x + from.y * from.y;
    const double edge =
        std::sqrt(std::max(distance2 - width * width, 0.0));   // distance x cos of half the angle it fills
    for (std::size_t i = 0; i < directions; ++i)
      if (distance2 <= width * width || dot(around[i], from) >= edge)
        highest_[directions * p + i] = std::max(highest_[directions * p + i], top);
  };
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const std::size_t a = pairs_.lower[i], b = pairs_.higher[i];
    const Vec3 apart = box.shortest(grains.position[b] - grains.position[a]);
    shelter(a, b, apart), shelter(b, a, -apart);
  }
  for (std::size_t p = 0; p < n; ++p) {
    double sum = 0;
    for (std::size_t i = 0; i < directions; ++i) sum += highest_[directions * p + i];
    level_[p] = sum / directions;
  }
  return level_;
}

double exposed_moment(double level) {
  const double l = std::clamp(level, -1.0, 1.0), rest = 1 - l * l;
  return 2 / (3 * std::numbers::pi) * rest * std::sqrt(rest);
}

Vec3 exposure_velocity(double level, double diameter, Vec3 vorticity) {
  const Vec3 shear{vorticity.y, -vorticity.x, 0};   // vorticity x up
  return 0.5 * diameter * exposed_moment(level) * shear;
}

}   // namespace bedload

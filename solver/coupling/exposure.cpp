#include "solver/coupling/exposure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace bedload {
namespace {

constexpr double shelter_reach = 2;   // of the distance at which two grains touch
constexpr double skin = 0.1;          // of the radius; how far a grain goes before pairs are searched again
constexpr std::size_t directions = 16, fours = directions / 4;

/// Unit vectors round the horizon, none along an axis or a diagonal of regular beds.
struct Horizon {
  Quad x[fours], y[fours];
  Horizon() {
    for (std::size_t i = 0; i < directions; ++i) {
      const double angle = 2 * std::numbers::pi * (static_cast<double>(i) + 0.5) / directions;
      x[i / 4][i % 4] = std::cos(angle), y[i / 4][i % 4] = std::sin(angle);
    }
  }
};

}   // namespace

/// Lists all pairs that are near, and some more; those of before serve until a grain has left its skin.
void Sheltering::list_pairs(const PeriodicBox& box, const Grains& grains) {
  constexpr double sure = 1 - 1e-6;
  const std::size_t n = grains.size();
  bool covered = diameter_ == grains.diameter;
  for (std::size_t p = 0; covered && p < n; ++p) {
    const double margin = sure * skin * 0.5 * grains.diameter[p];
    covered = norm2(box.shortest(grains.position[p] - origin_[p])) <= margin * margin;
  }
  if (covered) return;
  origin_ = grains.position, diameter_ = grains.diameter;
  std::vector<double> reach(n);
  for (std::size_t p = 0; p < n; ++p) reach[p] = 0.5 * (shelter_reach + skin) * grains.diameter[p];
  find_near_pairs(box, origin_, reach, {}, pairs_);
}

std::span<const double> Sheltering::find(const PeriodicBox& box, const Grains& grains) {
  static const Horizon around;
  const std::size_t n = grains.size();
  list_pairs(box, grains);
  level_.resize(n);
  highest_.assign(fours * n, quad(-1.0));
  const auto shelter = [&](std::size_t p, std::size_t by, Vec3 from) {   // `from` p to the other
    const double radius = 0.5 * grains.diameter[p], width = 0.5 * grains.diameter[by];
    const double top = std::min((from.z + width) / radius, 1.0);
    if (top <= -1) return;
    const double distance2 = from.x * from.x + from.y * from.y, beyond = distance2 - width * width;
    // distance x cos of half the angle it fills; all round where it stands above or below
    const double edge = beyond > 0 ? std::sqrt(beyond) : -std::numeric_limits<double>::infinity();
    Quad* const highest = &highest_[fours * p];
    for (std::size_t i = 0; i < fours; ++i) {
      const Quad raised = highest[i] < top ? quad(top) : highest[i];
      highest[i] = around.x[i] * from.x + around.y[i] * from.y >= edge ? raised : highest[i];
    }
  };
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const std::size_t a = pairs_.lower[i], b = pairs_.higher[i];
    const Vec3 apart = box.shortest(grains.position[b] - grains.position[a]);
    const double near = 0.5 * shelter_reach * grains.diameter[a] + 0.5 * shelter_reach * grains.diameter[b];
    if (!(norm2(apart) < near * near)) continue;
    shelter(a, b, apart), shelter(b, a, -apart);
  }
  for (std::size_t p = 0; p < n; ++p) {
    double sum = 0;
    for (std::size_t i = 0; i < directions; ++i) sum += highest_[fours * p + i / 4][i % 4];
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

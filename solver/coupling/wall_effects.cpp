#include "solver/coupling/wall_effects.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bedload {
namespace {

constexpr double film_gap = 0.1;   // nearer than this to a wall, normal motion is a contact's

double gap_of(double k, double least) { return std::max(1 / k - 1, least); }

}   // namespace

std::optional<NearWall> nearest_wall(const StaggeredGrid& grid, Vec3 position) {
  std::optional<NearWall> nearest;
  const auto consider = [&](const NearWall& wall) {
    if (!nearest || wall.distance < nearest->distance) nearest = wall;
  };
  for (int c = 2; c >= 0; --c) {
    if (grid.periodic(c)) continue;
    consider({c, false, position[c]});
    if (c != 2 || grid.top == Top::lid) consider({c, true, grid.length()[c] - position[c]});
  }
  return nearest;
}

double drag_along_wall(double k) {
  const double q = std::min(k, 1.0);
  const double faxen = 1 / (1 - q * (9.0 / 16 - q * q * (1.0 / 8 - q * (45.0 / 256 + q / 16))));
  return std::max(faxen, 0.9588 - 8.0 / 15 * std::log(gap_of(k, wall_roughness)));
}

double drag_towards_wall(double k) {
  const double gap = gap_of(k, film_gap);
  return (6 * gap * gap + 9 * gap + 2) / (6 * gap * gap + 2 * gap);
}

double shear_drag_at_wall(double k) {
  const double diameters = 0.5 * gap_of(k, 0);
  return 1 + 0.138 * std::exp(-2 * diameters) + 9.0 / 16 / (1 + 2 * diameters);
}

double shear_torque_at_wall(double k) {
  const double k3 = std::min(k * k * k, 1.0);
  return 1 - 3.0 / 16 * k3 / (1 + (3.0 / 16 / 0.056 - 1) * k3);   // from one limit to the other
}

double spin_torque_at_wall(double k) {
  const double k3 = std::min(k * k * k, 1.0);
  return std::max(1 + 5.0 / 16 * k3, 0.3817 - 0.4 * std::log(gap_of(k, wall_roughness)));
}

double mean_response(bool along, double diameter, double normal, double tangential) {
  const double k = along ? 0.0685 * std::pow(normal / tangential, -0.29) : 0.0730;
  return 3 * std::numbers::pi * k * diameter / tangential;
}

double resolved_reflection(bool along, double distance, double diameter, double kappa, double normal,
                           double tangential) {
  const double z = along ? std::max(distance, 0.75 * normal) : distance;
  const double far = (along ? 9.0 / 16 : 9.0 / 8) * 0.5 * diameter / z;
  // Between the first image far off and all of kappa at the wall; how sharply they meet is fitted to the discrete equations.
  const double sharp = along ? 2 * std::pow(std::min(normal / tangential, 1.0), 0.3) : 1.6;
  return std::pow(std::pow(far, -sharp) + std::pow(kappa, -sharp), -1 / sharp);
}

WallDrag wall_drag(const NearWall& wall, double diameter, Vec3 removed, Vec3 reflected, double share) {
  const double k = 0.5 * diameter / wall.distance;
  WallDrag drag;
  for (int c = 0; c < 3; ++c) {
    const bool along = c != wall.axis;
    const double target = along ? drag_along_wall(k) : drag_towards_wall(k);
    const double at_rest = along ? shear_drag_at_wall(k) : std::min(target, 1 + 9.0 / 8 * k);
    const double moving = 1 + share * (target - 1), resting = 1 + share * (at_rest - 1);
    const double own = share * reflected[c] - removed[c];   // R - kappa
    drag.applied[c] = 1 / (1 + resting * own);
    drag.reflex[c] = moving * own;
    drag.slip[c] = moving * (1 - removed[c]) * drag.applied[c];
    drag.flow[c] = (resting - moving) * (1 - removed[c]) * drag.applied[c];
  }
  return drag;
}

}   // namespace bedload

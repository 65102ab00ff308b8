#include "solver/coupling/explicit_forces.hpp"

#include <algorithm>
#include <numbers>

#include "solver/coupling/lateral_forces.hpp"
#include "solver/coupling/wall_effects.hpp"

namespace bedload {
namespace {

Vec3 removed_at(const FlowAtGrains& flow, std::size_t p) { return flow.removed.empty() ? Vec3{} : flow.removed[p]; }

/// Undisturbed slip u - v: what the coefficient of drag has been corrected for, the lift is too.
Vec3 undisturbed_slip(const FlowAtGrains& flow, const Grains& grains, std::size_t p) {
  const Vec3 slip = flow.velocity[p] - grains.velocity[p], removed = removed_at(flow, p);
  return {slip.x / (1 - removed.x), slip.y / (1 - removed.y), slip.z / (1 - removed.z)};
}

/// The wall near a grain, and how far it counts: not among other grains.
struct WallThere {
  NearWall wall;
  double share;
};
std::optional<WallThere> wall_at(const StaggeredGrid& grid, Vec3 position, double others) {
  const double share = loneness(others);
  const auto wall = nearest_wall(grid, position);
  if (!wall || share == 0) return {};
  return WallThere{*wall, share};
}

void add_wall_drag(const Surroundings& around, const WallThere& there, double d, std::size_t p, FlowAtGrains& flow) {
  const Vec3 edges = around.grid.h, removed = removed_at(flow, p);
  const int n = there.wall.axis;
  const double tangential = std::sqrt(edges[(n + 1) % 3] * edges[(n + 2) % 3]);
  Vec3 reflected;
  for (int c = 0; c < 3; ++c) {
    const double multiplier = flow.drag[p][c] * (1 - removed[c]) / (3 * std::numbers::pi * around.viscosity * d);
    const double kappa = mean_response(c != n, d, edges[n], tangential);
    reflected[c] = multiplier * resolved_reflection(c != n, there.wall.distance, d, kappa, edges[n], tangential);
  }
  const WallDrag factors = wall_drag(there.wall, d, removed, reflected, there.share);
  const Vec3 wall_velocity{n == 2 && there.wall.upper ? around.lid_speed : 0, 0, 0};
  flow.force[p] += scaled(flow.drag[p], scaled(factors.flow, flow.velocity[p] - wall_velocity));
  flow.drag[p] = scaled(flow.drag[p], factors.slip);
}

}   // namespace

bool any_explicit(const Terms& terms) {
  return terms.shear_lift || terms.magnus || terms.wall_forces || terms.exposure;
}

void add_explicit_forces(const Surroundings& around, const Grains& grains, const Terms& terms, Sheltering& sheltering,
                         FlowAtGrains& flow) {
  if (!terms.drag || !any_explicit(terms)) return;
  std::span<const double> level;
  if (terms.exposure) level = sheltering.find(around.box, grains);
  for (std::size_t p = 0; p < grains.size(); ++p) {
    const double d = grains.diameter[p], nu = around.viscosity;
    std::optional<WallThere> there;
    if (terms.wall_forces) there = wall_at(around.grid, grains.position[p], flow.packing.others[p]);
    const Vec3 slip = undisturbed_slip(flow, grains, p), vorticity = flow.vorticity[p];
    if (there) add_wall_drag(around, *there, d, p, flow);
    Vec3 lift;
    if (terms.shear_lift) {
      lift = saffman_mei(slip, vorticity, d, nu);
      if (there) lift += there->share * (shear_lift_near_wall(slip, vorticity, d, nu, there->wall.distance) - lift);
    }
    if (terms.magnus) lift += magnus(slip, grains.spin[p] - 0.5 * vorticity, d, nu);
    if (terms.model_b()) lift = lift / std::clamp(flow.void_fraction[p], 0.26, 1.0);
    const Vec3 beta = flow.drag[p];
    flow.force[p] += lift_force(slip, lift, std::min({beta.x, beta.y, beta.z}));
    if (terms.exposure) flow.force[p] += scaled(beta, exposure_velocity(level[p], d, vorticity));
  }
}

}   // namespace bedload

#include "solver/coupling/explicit_forces.hpp"

#include <algorithm>
#include <numbers>

#include "solver/coupling/lateral_forces.hpp"
#include "solver/coupling/wall_effects.hpp"

namespace bedload {
namespace {

Vec3 removed_at(const FlowAtGrains& flow, std::size_t p) { return flow.removed.empty() ? Vec3{} : flow.removed[p]; }

/// 1/(1 - removed): undisturbed slip over the sampled one. Also what must be applied of a force to be felt as one: the flow
/// that its reaction makes at the grain takes the rest back as drag.
Vec3 without_own_flow(Vec3 removed) { return {1 / (1 - removed.x), 1 / (1 - removed.y), 1 / (1 - removed.z)}; }

Vec3 wall_velocity(const Surroundings& around, const NearWall& wall) {
  return {wall.axis == 2 && wall.upper ? around.lid_speed : 0, 0, 0};
}

/// The wall near a grain, and how far it counts: not among other grains.
struct WallThere {
  NearWall wall;
  double share;
};
std::optional<WallThere> wall_at(const StaggeredGrid& grid, Vec3 position, double share) {
  const auto wall = nearest_wall(grid, position);
  if (!wall || share == 0) return {};
  return WallThere{*wall, share};
}

/// What the wall makes of the drag, in which the flow of p is changed.
WallDrag add_wall_drag(const Surroundings& around, const WallThere& there, double d, std::size_t p,
                       FlowAtGrains& flow) {
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
  const Vec3 relative = flow.velocity[p] - wall_velocity(around, there.wall);
  flow.force[p] += scaled(flow.drag[p], scaled(factors.flow, relative));
  flow.drag[p] = scaled(flow.drag[p], factors.slip);
  return factors;
}

}   // namespace

bool any_explicit(const Terms& terms) {
  return terms.shear_lift || terms.magnus || terms.wall_forces || terms.exposure;
}

WallTorque wall_torque(const StaggeredGrid& grid, Vec3 position, double diameter, double loneness) {
  WallTorque factors;
  const auto there = wall_at(grid, position, loneness);
  if (!there) return factors;
  const double k = 0.5 * diameter / there->wall.distance;
  for (int c = 0; c < 3; ++c) {
    if (c == there->wall.axis) continue;
    factors.shear[c] += there->share * (shear_torque_at_wall(k) - 1);
    factors.spin[c] += there->share * (spin_torque_at_wall(k) - 1);
  }
  return factors;
}

namespace {

/// What a grain's lift is made of.
struct LiftedGrain {
  Vec3 slip, vorticity, relative_spin;   // slip: undisturbed
  Vec3 applied;                          // of a force, to be felt as one
  Vec3 at_wall;                          // lift vector of the wall's part
  double free = 1;                       // share of what is no wall's
};

/// Finds that, after making the drag that of the wall nearby.
LiftedGrain meet_wall(const Surroundings& around, const Grains& grains, const Terms& terms, std::size_t p,
                      FlowAtGrains& flow) {
  const double d = grains.diameter[p];
  LiftedGrain g{.vorticity = flow.vorticity[p], .applied = without_own_flow(removed_at(flow, p))};
  g.slip = scaled(g.applied, flow.velocity[p] - grains.velocity[p]);
  g.relative_spin = grains.spin[p] - 0.5 * g.vorticity;
  std::optional<WallThere> there;
  if (terms.wall_forces) there = wall_at(around.grid, grains.position[p], flow.packing.loneness(p));
  if (!there) return g;
  const WallDrag drag = add_wall_drag(around, *there, d, p, flow);
  const Vec3 wall = wall_velocity(around, there->wall), grain = grains.velocity[p] - wall;
  const Vec3 along = drag.undisturbed(flow.velocity[p] - wall, grain);
  g.applied = drag.applied, g.slip = along - grain, g.free = 1 - there->share;
  if (terms.shear_lift) {
    Vec3 normal;
    normal[there->wall.axis] = there->wall.upper ? -1 : 1;
    const Vec3 shear = cross(normal, along) / there->wall.distance;
    g.at_wall =
        there->share * shear_lift_near_wall(g.slip, g.vorticity, shear, d, around.viscosity, there->wall.distance);
  }
  return g;
}

}   // namespace

void add_explicit_forces(const Surroundings& around, const Grains& grains, const Terms& terms, Sheltering& sheltering,
                         FlowAtGrains& flow) {
  if (!terms.drag || !any_explicit(terms)) return;
  std::span<const double> level;
  if (terms.exposure) level = sheltering.find(around.box, grains);
  for (std::size_t first = 0; first < grains.size(); first += 4) {
    const std::size_t count = std::min<std::size_t>(grains.size() - first, 4);
    LiftedGrain four[4];
    Quad slip{}, vorticity{}, spin{}, diameter{}, by_shear{}, by_spin{};
    for (std::size_t k = 0; k < count; ++k) {
      const LiftedGrain& g = four[k] = meet_wall(around, grains, terms, first + k, flow);
      slip[k] = norm(g.slip), vorticity[k] = norm(g.vorticity), spin[k] = norm(g.relative_spin);
      diameter[k] = grains.diameter[first + k];
    }
    if (terms.shear_lift) by_shear = saffman_mei(slip, vorticity, diameter, around.viscosity);
    if (terms.magnus) by_spin = magnus(slip, spin, diameter, around.viscosity);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t p = first + k;
      const LiftedGrain& g = four[k];
      Vec3 lift = g.at_wall + g.free * (by_shear[k] * g.vorticity) + by_spin[k] * g.relative_spin;
      if (terms.model_b()) lift = lift / std::clamp(flow.void_fraction[p], least_void, 1.0);
      const Vec3 beta = flow.drag[p];
      const Vec3 limited = limited_lift(lift, std::min({beta.x, beta.y, beta.z}));
      flow.lift_clamps += limited != lift;
      flow.force[p] += scaled(g.applied, cross(g.slip, limited));
      if (terms.exposure) flow.force[p] += scaled(beta, exposure_velocity(level[p], grains.diameter[p], g.vorticity));
    }
  }
}

}   // namespace bedload

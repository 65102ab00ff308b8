// From a scene to its dimensionless numbers.
#include "solver/scene_numbers.hpp"

#include <algorithm>
#include <cmath>

#include "solver/bed/incipient_motion.hpp"
#include "solver/coupling/drag_laws.hpp"
#include "solver/coupling/wall_effects.hpp"
#include "solver/dimensionless.hpp"
#include "solver/expected_bed.hpp"

namespace bedload {

namespace {

using Kind = FlowRamp::Kind;

constexpr double carried_share = 0.2;   // of the shear rate times d: speed at which shear throws grains at each other
constexpr double couette_transition = 1300;   // U h/nu beyond which a Couette flow may stay turbulent
constexpr double channel_transition = 1500;   // of the mean speed, between plates
constexpr double log_law_at_the_top = 8.5;    // u+ at a rough bed's grains, Nikuradse

double density_ratio(const Scene& scene) { return scene.bed.grains.density / scene.bed.fluid.density; }

double weight_per_mass(const Scene& scene) {   // submerged, per mass of fluid [m/s2]
  return reduced_gravity(density_ratio(scene), norm(scene.bed.gravity));
}

/// Shear rate at the bed or bottom that a level of the drive means in laminar flow, whether turbulence is on or not [1/s].
double shear_of_level(Scene scene, std::size_t level, double height, double gap) {
  scene.terms.turbulence = false;
  const auto flow = imposed_flow(scene, level, height);
  if (scene.drive.kind == Kind::lid) return std::abs(flow.lid_speed) / gap;
  return std::abs(flow.gradient) * (scene.bed.top == Top::free_slip ? gap : gap / 2) / scene.bed.fluid.viscosity;
}

/// The levels of the weakest and of the strongest flow: a ramp may go down, or turn round.
struct LevelRange {
  std::size_t weakest, strongest;
};
LevelRange range_of_levels(const FlowRamp& drive) {
  const auto& levels = drive.levels;
  const auto size = [](double level) { return std::abs(level); };
  const auto [low, high] = std::ranges::minmax_element(levels, {}, size);
  return {static_cast<std::size_t>(low - levels.begin()), static_cast<std::size_t>(high - levels.begin())};
}

/// Of the viscous stress at that shear rate; infinite without submerged weight.
double shields_of_shear(const Scene& scene, double shear) {
  const auto& fluid = scene.bed.fluid;
  const double stress = fluid.density * fluid.viscosity * shear;
  return shields_number(stress, fluid.density, density_ratio(scene), norm(scene.bed.gravity),
                        scene.bed.grains.diameter);
}
double shear_of_shields(const Scene& scene, double shields) {
  const auto& fluid = scene.bed.fluid;
  const double stress = stress_of_shields(shields, fluid.density, density_ratio(scene), norm(scene.bed.gravity),
                                          scene.bed.grains.diameter);
  return stress / (fluid.density * fluid.viscosity);
}

/// kappa at the speed of fall. A grain that moves leaves its own flow behind: the Oseen factor of a force spread over a width
/// w, 1/(1 + 0.49 U w/nu) within 8 %, with w that of a sphere's worth of kernel, 0.4 d/kappa.
double self_response(const Scene& scene, double speed) {
  const double d = scene.bed.grains.diameter, nu = scene.bed.fluid.viscosity;
  const Vec3 h = scene.grid.h;
  const double creeping = std::max(mean_response(true, d, h.z, h.x), mean_response(false, d, h.z, h.x));
  const double left_behind = 1 / (1 + 0.49 * reynolds_number(speed, 0.4 * d / creeping, nu));
  const double multiplier = std::visit(
      [&](const auto& law) { return law.multiplier(1, reynolds_number(speed, d, nu)); }, drag_law(scene.drag));
  return creeping * multiplier * left_behind;
}

void grain_numbers(const Scene& scene, SceneNumbers& n) {
  const auto& bed = scene.bed;
  const double d = bed.grains.diameter, nu = bed.fluid.viscosity, g = norm(bed.gravity);
  n.density_ratio = density_ratio(scene);
  const double weight = weight_per_mass(scene);
  const double box = bed.length.x * bed.length.y * bed.length.z;
  if (weight > 0) {
    n.galileo = galileo_number(n.density_ratio, g, d, nu);
    n.settling_speed = terminal_speed(scene.drag, nu, n.density_ratio, d, g);
    n.settling_reynolds = reynolds_number(n.settling_speed, d, nu);
    if (n.density_ratio > 1) n.grain_time = grain_time(d, n.density_ratio, g, n.settling_speed);
  }
  n.solid_fraction = static_cast<double>(bed.source.count) * sphere_volume(d) / box;
  n.self_response = self_response(scene, weight > 0 ? n.settling_speed : 0);
}

/// u+ at the centre of a surface grain in viscous flow.
double viscous_speed(double friction_reynolds) { return 0.5 * friction_reynolds; }

/// b at the centre of a surface grain at rest: 1 where the speed grows with height; where the log law of a bed as rough as its
/// grains is large reaches it, d/2 up, 1/((1 + 1/15) ln 16).
double shear_per_slip(const Scene& scene, const SceneNumbers& n) {
  const bool by_log_law = scene.terms.turbulence && viscous_speed(n.friction_reynolds) > log_law_at_the_top;
  return by_log_law ? 1 / ((1 + 1.0 / 15) * std::log(16.0)) : 1;
}

void flow_numbers(const Scene& scene, const GrainCensus& census, SceneNumbers& n) {
  const auto& bed = scene.bed;
  const double d = bed.grains.diameter, nu = bed.fluid.viscosity, height = n.bed_depth * d;
  const double first = shear_of_level(scene, 0, height, n.gap);
  n.shear_rate = first;
  if (census.any) {
    const bool heavy = weight_per_mass(scene) > 0;
    const auto imposed = [&](std::size_t level) { return std::abs(imposed_flow(scene, level, height).shields); };
    const auto [weakest, strongest] = range_of_levels(scene.drive);
    if (heavy) n.lowest_shields = imposed(weakest), n.highest_shields = imposed(strongest);
    if (census.bed && census.mobile && shields_of_shear(scene, first) < quoted_shields)
      n.shear_rate = shear_of_shields(scene, quoted_shields);
    const double shields = shields_of_shear(scene, n.shear_rate);
    if (heavy) n.shields = shields;
    n.friction_reynolds = reynolds_number(std::sqrt(nu * n.shear_rate), d, nu);
    n.shear_reynolds = shear_reynolds_number(n.shear_rate, d, nu);
    n.lift_per_weight = 1.10 * shields * n.shear_reynolds;
    n.torque_per_weight = 6 * shields;
    n.shear_per_slip = shear_per_slip(scene, n);
  }
  const bool lid = scene.drive.kind == Kind::lid;
  n.flow_speed = n.shear_rate * n.gap / (lid ? 1 : bed.top == Top::free_slip ? 3 : 6);
  n.gap_reynolds = reynolds_number(n.flow_speed, n.gap, nu);
}

/// The fastest slip: falling, thrown, in the shear at the bed's surface, in a flow through the grains.
double largest_slip(const Scene& scene, const GrainCensus& census, const SceneNumbers& n) {
  const double d = scene.bed.grains.diameter, nu = scene.bed.fluid.viscosity;
  double slip = census.fastest;
  if (census.mobile && !std::isnan(n.settling_speed)) slip = std::max(slip, n.settling_speed);
  if (!std::isnan(n.shear_rate)) {
    const double height = n.bed_depth * d;
    const double highest = shear_of_level(scene, range_of_levels(scene.drive).strongest, height, n.gap);
    const double shear = std::max(n.shear_rate, highest);
    const double friction_speed = std::sqrt(nu * shear);
    const double viscous = viscous_speed(reynolds_number(friction_speed, d, nu));
    slip = std::max(slip, friction_speed * (scene.terms.turbulence ? std::min(viscous, log_law_at_the_top) : viscous));
  }
  if (scene.drive.kind == Kind::through_flow)
    for (const double level : scene.drive.levels) slip = std::max(slip, std::abs(level));
  return reynolds_number(slip, d, nu);
}

void impact_numbers(const Scene& scene, const GrainCensus& census, SceneNumbers& n) {
  const double d = scene.bed.grains.diameter;
  const double fall = std::isnan(n.settling_speed) ? 0 : n.settling_speed;
  const double carried = std::isnan(n.shear_rate) ? 0 : carried_share * n.shear_rate * d;
  n.impact_speed = std::max({fall, carried, census.fastest});
  n.impact_stokes = impact_stokes_number(n.density_ratio, d, n.impact_speed, scene.bed.fluid.viscosity);
}

}   // namespace

bool is_sheared(const Scene& scene) {
  const bool flows = scene.drive.kind == Kind::lid || scene.drive.kind == Kind::pressure;
  return flows && scene.bed.sides[2] == Side::wall && !scene.drive.levels.empty();
}

SceneNumbers numbers_of(const Scene& scene, const GrainCensus& census) {
  const auto& bed = scene.bed;
  SceneNumbers n;
  n.bed_depth = census.any ? std::min(expected_bed_depth(bed), 0.95 * bed.length.z) / bed.grains.diameter : 0;
  n.gap = bed.length.z - n.bed_depth * bed.grains.diameter;
  if (census.any) grain_numbers(scene, n);
  if (census.bed) n.solid_fraction = loose_packing;
  if (is_sheared(scene)) flow_numbers(scene, census, n);
  if (!census.any) return n;
  if (census.mobile) impact_numbers(scene, census, n);
  n.grain_reynolds = largest_slip(scene, census, n);
  return n;
}

double turbulent_gap(const Scene& scene) {
  return scene.drive.kind == Kind::lid ? couette_transition : channel_transition;
}

GapFlow gap_flow(const Scene& scene, const SceneNumbers& n) {
  if (!(n.gap_reynolds > turbulent_gap(scene))) return GapFlow::laminar;   // nan where nothing is sheared
  if (scene.bed.sides[0] == Side::wall) return GapFlow::enclosed;
  return n.friction_reynolds <= smooth_bed_reynolds ? GapFlow::over_smooth_bed : GapFlow::turbulent;   // nan: no bed
}

}   // namespace bedload

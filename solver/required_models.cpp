// The rules: term by term, when it matters, and the ratio that says so.
#include "solver/required_models.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "solver/bed/flow_ramp.hpp"
#include "solver/bed/incipient_motion.hpp"
#include "solver/coupling/drag_laws.hpp"
#include "solver/dimensionless.hpp"
#include "solver/expected_bed.hpp"

namespace bedload {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double added_mass_coefficient = 0.5;   // of a sphere
constexpr double couette_transition = 1300;      // U h/nu beyond which a Couette flow may stay turbulent
constexpr double channel_transition = 1500;      // of the mean speed, between plates
constexpr double rough_transition = 5;           // Re* up to which the bed is hydraulically smooth

bool sheared(const Scene& scene) {
  const bool flows = scene.drive.kind == FlowRamp::Kind::lid || scene.drive.kind == FlowRamp::Kind::pressure;
  return flows && scene.bed.sides[2] == Side::wall;
}
bool has_grains(const Scene& scene) { return scene.bed.source.kind != BedSource::Kind::none; }

/// What imposes a Shields number on the expected bed, whatever the levels of the ramp count.
double flow_speed_at(const Scene& scene, double shields, double gap) {
  const auto& bed = scene.bed;
  const double stress = stress_of_shields(shields, bed.fluid.density, bed.grains.density / bed.fluid.density,
                                          norm(bed.gravity), bed.grains.diameter);
  const double shear = stress / (bed.fluid.density * bed.fluid.viscosity);   // at the bed
  if (scene.drive.kind == FlowRamp::Kind::lid) return shear * gap;
  return bed.top == Top::free_slip ? shear * gap / 3 : shear * gap / 6;   // mean of a film, of a channel
}

void flow_numbers(const Scene& scene, SceneNumbers& n) {
  const auto& bed = scene.bed;
  const double height = n.bed_depth * bed.grains.diameter;
  const auto levels = scene.drive.levels.size();
  n.lowest_shields = imposed_flow(scene, 0, height).shields;
  n.highest_shields = imposed_flow(scene, levels - 1, height).shields;
  n.shields = scene.drive.quantity == FlowRamp::Quantity::shields ? quoted_shields : n.highest_shields;
  n.friction_reynolds = friction_reynolds_number(n.shields, n.galileo);
  n.shear_reynolds = shear_reynolds_number(n.shields, n.galileo);
  n.flow_speed = flow_speed_at(scene, n.shields, n.gap);
  n.gap_reynolds = reynolds_number(n.flow_speed, n.gap, bed.fluid.viscosity);
  const double shear = n.shear_reynolds * bed.fluid.viscosity / (bed.grains.diameter * bed.grains.diameter);
  n.impact_stokes = impact_stokes_number(n.density_ratio, bed.grains.diameter, 0.2 * shear * bed.grains.diameter,
                                         bed.fluid.viscosity);
}

ModelChoice drag(const Scene& scene, const SceneNumbers& n) {
  const double loading = n.solid_fraction * n.density_ratio;
  return {"drag", scene.terms.drag, has_grains(scene), loading,
          fmt::format("{} drag, two-way: mass loading {:.3g} > 0.001", name_of(scene.drag), loading)};
}

ModelChoice buoyancy(const Scene& scene, const SceneNumbers& n) {
  return {"buoyancy", scene.terms.buoyancy, has_grains(scene), 1 / n.density_ratio,
          fmt::format("carries {:.3g} of a grain's weight (1/s)", 1 / n.density_ratio)};
}

ModelChoice pressure_gradient(const Scene& scene, const SceneNumbers& n) {
  const bool wanted = has_grains(scene) && n.density_ratio < 5;
  const auto why = fmt::format(
      "s = {:.3g} {} 5{}", n.density_ratio,
      wanted ? "<" : ">=", scene.terms.model_b() ? "; off means Model B, good for steady, nearly uniform flow" : "");
  return {"pressure_gradient", scene.terms.pressure_gradient, wanted, n.density_ratio, why};
}

ModelChoice viscous_stress(const Scene& scene, const SceneNumbers& n) {
  const bool wanted = has_grains(scene) && n.density_ratio < 5;
  return {"viscous_stress", scene.terms.viscous_stress, wanted, n.density_ratio,
          scene.terms.model_b() ? "off together with pressure_gradient (Model B)"
                                : "the other half of Model A beside pressure_gradient"};
}

ModelChoice added_mass(const SceneNumbers& n) {
  const double share = added_mass_coefficient / (n.density_ratio + added_mass_coefficient);
  return {"added_mass", false, n.density_ratio < 5, share,
          fmt::format("{:.2g} of the inertia of an accelerating grain; not in this version; steady drag and thus onset "
                      "feel it little",
                      share)};
}

ModelChoice shear_lift(const SceneNumbers& n) {
  const double ratio = 1.10 * n.shields * n.shear_reynolds;
  return {"shear_lift", false, n.shear_reynolds > 0.5 && ratio > 0.05, ratio,
          fmt::format("lift per weight 1.10 theta Re_g = {:.2g} (matters above 0.05); not in this version", ratio)};
}

ModelChoice lubrication(const SceneNumbers& n) {
  const double ratio = n.impact_stokes > 0 ? 1 - std::exp(-35 / n.impact_stokes) : 1;
  return {"lubrication", false, n.impact_stokes < 2000, ratio,
          fmt::format("impact Stokes number {:.2g}: the film takes {:.2g} of a rebound; not in this version",
                      n.impact_stokes, ratio)};
}

ModelChoice viscous_torque(const SceneNumbers& n) {
  const double ratio = 6 * n.shields;
  return {"viscous_torque", false, ratio > 0.05, ratio,
          fmt::format("torque per weight and radius 6 theta = {:.2g} (matters above 0.05); not in this version; "
                      "theta_c comes out too high without it",
                      ratio)};
}

bool turbulent(const Scene& scene, const SceneNumbers& n) {
  const double limit = scene.drive.kind == FlowRamp::Kind::lid ? couette_transition : channel_transition;
  return n.friction_reynolds > rough_transition && n.gap_reynolds > limit;
}

ModelChoice turbulence(const Scene& scene, const SceneNumbers& n) {
  const bool lid = scene.drive.kind == FlowRamp::Kind::lid;
  const double limit = lid ? couette_transition : channel_transition;
  return {
      "turbulence", false, turbulent(scene, n), n.gap_reynolds / limit,
      fmt::format(
          "Re* = {:.3g}, gap Reynolds number {:.3g} at theta = {:.2g} (turbulent above Re* 5 and {:.0f}): laminar {}",
          n.friction_reynolds, n.gap_reynolds, n.shields, limit, turbulent(scene, n) ? "assumed" : "indeed")};
}

}   // namespace

SceneNumbers numbers_of(const Scene& scene) {
  const auto& bed = scene.bed;
  const double d = bed.grains.diameter, nu = bed.fluid.viscosity, g = norm(bed.gravity);
  SceneNumbers n;
  n.density_ratio = bed.grains.density / bed.fluid.density;
  const bool heavy = n.density_ratio > 1 && g > 0;
  n.galileo = heavy ? galileo_number(n.density_ratio, g, d, nu) : nan;
  const double fall = heavy ? terminal_speed(scene.drag, nu, n.density_ratio, d, g) : nan;
  n.grain_time = heavy ? grain_time(d, n.density_ratio, g, fall) : nan;
  n.settling_reynolds = reynolds_number(fall, d, nu);
  n.solid_fraction = has_grains(scene) ? loose_packing : 0;
  n.bed_depth = std::min(expected_bed_depth(bed), 0.95 * bed.length.z) / d;
  n.gap = bed.length.z - n.bed_depth * d;
  n.lowest_shields = n.highest_shields = n.shields = n.friction_reynolds = n.shear_reynolds = nan;
  n.flow_speed = n.gap_reynolds = n.impact_stokes = nan;
  if (sheared(scene) && heavy) flow_numbers(scene, n);
  return n;
}

std::vector<ModelChoice> required_models(const Scene& scene) {
  const auto n = numbers_of(scene);
  std::vector<ModelChoice> models{drag(scene, n), buoyancy(scene, n), pressure_gradient(scene, n),
                                  viscous_stress(scene, n), added_mass(n)};
  if (std::isnan(n.shields)) return models;
  for (auto& model : {shear_lift(n), lubrication(n), viscous_torque(n), turbulence(scene, n)}) models.push_back(model);
  return models;
}

std::vector<std::string> warnings_of(const Scene& scene) {
  std::vector<std::string> warnings;
  const auto n = numbers_of(scene);
  if (!std::isnan(n.shields) && turbulent(scene, n)) {
    warnings.push_back(
        fmt::format("this laminar scene is not physical: theta = {:.2g} means a {} of {:.3g} m/s, a gap Reynolds "
                    "number of {:.2g} and Re* = {:.3g}; "
                    "the real flow is turbulent. A more viscous liquid or smaller grains make it laminar",
                    n.shields, scene.drive.kind == FlowRamp::Kind::lid ? "lid speed" : "mean speed", n.flow_speed,
                    n.gap_reynolds, n.friction_reynolds));
  }
  for (const auto& model : required_models(scene)) {
    const bool of_this_version = model.term == "drag" || model.term == "buoyancy" ||
                                 model.term == "pressure_gradient" || model.term == "viscous_stress";
    if (of_this_version && model.wanted && !model.on)
      warnings.push_back(fmt::format("{} is left out, though the scene wants it: {}", model.term, model.reason));
  }
  return warnings;
}

}   // namespace bedload

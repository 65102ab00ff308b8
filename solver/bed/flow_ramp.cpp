// Shields number to lid speed or driving gradient, and back.
#include "solver/bed/flow_ramp.hpp"

#include <cmath>

#include <fmt/format.h>

#include "base/error.hpp"
#include "solver/bed/turbulent_flow.hpp"
#include "solver/scene.hpp"

namespace bedload {

double shields_stress(const FluidProperties& fluid, const GrainProperties& grains, double gravity) {
  return (grains.density - fluid.density) * gravity * grains.diameter;
}

namespace {

double gap_above(const Scene& scene, double bed_height) {
  const double gap = scene.bed.length.z - bed_height;
  if (gap > 0) return gap;
  throw Error(
      ErrorKind::study_invalid,
      fmt::format("the bed fills its box: its surface stands at {:.4g} m of {:.4g} m, and no flow fits above it",
                  bed_height, scene.bed.length.z),
      "raise box.height or lower bed.count");
}

/// Stress on the bed per kinematic drive: tau_b = rho_f * slope * U for a lid, rho_f * slope * G for a gradient.
double bed_stress_per_drive(const Scene& scene, double gap) {
  if (scene.drive.kind == FlowRamp::Kind::lid) return scene.bed.fluid.viscosity / gap;
  return scene.bed.top == Top::free_slip ? gap : gap / 2;
}

}   // namespace

ImposedFlow imposed_flow(const Scene& scene, std::uint64_t hold, double bed_height) {
  return scene.drive.kind == FlowRamp::Kind::none ? ImposedFlow{}
                                                  : imposed_level(scene, scene.drive.levels.at(hold), bed_height);
}

ImposedFlow imposed_level(const Scene& scene, double level, double bed_height) {
  const FlowRamp& ramp = scene.drive;
  if (ramp.kind == FlowRamp::Kind::none) return {};
  if (ramp.kind == FlowRamp::Kind::push) return {.push = level};
  if (ramp.kind == FlowRamp::Kind::through_flow) return {.through_flow = level};
  const double density = scene.bed.fluid.density;
  const bool has_bed_stress =
      scene.bed.sides[2] == Side::wall;   // without bottom and top there is no tau_b to speak of
  const double per_drive = has_bed_stress ? bed_stress_per_drive(scene, gap_above(scene, bed_height)) : 0;
  const double stress = shields_stress(scene.bed.fluid, scene.bed.grains, norm(scene.bed.gravity));

  ImposedFlow flow;
  if (scene.terms.turbulence && has_bed_stress && ramp.kind == FlowRamp::Kind::lid) {
    const bool by_speed = ramp.quantity == FlowRamp::Quantity::lid_speed;
    const double friction_speed =
        by_speed ? friction_speed_under_lid(scene, bed_height, level) : std::sqrt(level * stress / density);
    flow.lid_speed = by_speed ? level : turbulent_flow(scene, bed_height, friction_speed).lid_speed;
    flow.shields = stress > 0 ? density * friction_speed * std::abs(friction_speed) / stress : 0;
    return flow;
  }
  double drive = level;
  if (ramp.quantity == FlowRamp::Quantity::shields) drive = level * stress / (density * per_drive);
  if (ramp.quantity == FlowRamp::Quantity::gradient) drive = level / density;   // [Pa/m] per mass of fluid
  flow.shields = stress > 0 ? density * per_drive * drive / stress : 0;
  (ramp.kind == FlowRamp::Kind::lid ? flow.lid_speed : flow.gradient) = drive;
  return flow;
}

double friction_speed_of(const Scene& scene, const ImposedFlow& flow, double bed_height) {
  if (scene.drive.kind == FlowRamp::Kind::lid) return friction_speed_under_lid(scene, bed_height, flow.lid_speed);
  const double stress = bed_stress_per_drive(scene, gap_above(scene, bed_height)) * flow.gradient;
  return std::copysign(std::sqrt(std::abs(stress)), stress);
}

double steady_increment(const Scene& scene, const ImposedFlow& change, double bed_height, double z) {
  const double height = scene.bed.length.z, above = z - bed_height;
  if (above <= 0) return 0;
  const double gap = height - bed_height;
  const double couette = change.lid_speed * above / gap;
  const double film = above * gap - above * above / 2;   // no stress at the top
  const double channel = above * (height - z) / 2;       // lid at rest
  return couette + change.gradient / scene.bed.fluid.viscosity * (scene.bed.top == Top::free_slip ? film : channel);
}

}   // namespace bedload

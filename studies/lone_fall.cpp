#include "studies/lone_fall.hpp"

#include <fmt/format.h>

#include <limits>

#include "base/error.hpp"
#include "base/log.hpp"
#include "solver/coupling/drag_laws.hpp"
#include "solver/experiment.hpp"

namespace bedload {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double let_go = 0.75, upper = 0.55, lower = 0.35;   // of the box's height

/// The scene with one grain for its bed, at a place across [m], and no flow.
Scene one_grain(const Scene& scene, double x, double y) {
  Scene lone = scene;
  lone.bed.source = {.kind = BedSource::Kind::file, .count = 1};
  lone.bed.source.csv = fmt::format("x,y,z,diameter,density,fixed\n{},{},{},{},{},0\n", x, y,
                                    let_go * scene.bed.length.z, scene.bed.grains.diameter, scene.bed.grains.density);
  lone.bed.gravity = {0, 0, -norm(scene.bed.gravity)};
  lone.drive = {.kind = FlowRamp::Kind::none};
  lone.onset.method = Onset::Method::none;
  lone.shear = {}, lone.frozen_depth = 0, lone.record.tracks.clear();
  return lone;
}

/// The time that a fall takes through a level, between two steps [s].
double passing(double level, double z_before, double z, double time_before, double time) {
  return time_before + (z_before - level) / (z_before - z) * (time - time_before);
}

double fall_speed(Scene lone, double longest) {
  lone.drive.dwell = longest, lone.record.every = longest;
  if (!problems_of(lone).empty()) return unknown;
  const double height = lone.bed.length.z;
  Experiment experiment(lone);
  State state = experiment.begin();
  double entered = unknown;
  while (!Experiment::finished(state)) {
    const double z_before = state.grains.position[0].z, before = state.clock.time;
    experiment.step(state);
    const double z = state.grains.position[0].z, now = state.clock.time;
    if (z_before >= upper * height && z < upper * height) entered = passing(upper * height, z_before, z, before, now);
    if (z < lower * height)
      return (upper - lower) * height / (passing(lower * height, z_before, z, before, now) - entered);
  }
  return unknown;
}

}   // namespace

std::array<double, 4> lone_fall_speeds(const Scene& scene) {
  if (scene.bed.sides[2] == Side::periodic || scene.bed.grains.density <= scene.bed.fluid.density) return no_falls;
  const double g = norm(scene.bed.gravity), d = scene.bed.grains.diameter;
  const double free =
      terminal_speed(scene.drag, scene.bed.fluid.viscosity, scene.bed.grains.density / scene.bed.fluid.density, d, g);
  if (!(free > 0)) return no_falls;
  const double longest = 10 * scene.bed.length.z / free;
  const auto at = [&](double i, double j) {
    return fall_speed(
        one_grain(scene, 0.5 * scene.bed.length.x + i * scene.grid.h.x, 0.5 * scene.bed.length.y + j * scene.grid.h.y),
        longest);
  };
  try {
    return {at(0, 0), at(0, 0.5), at(0.5, 0), at(0.5, 0.5)};
  } catch (const Error& error) {
    log_note(fmt::format("a lone grain cannot fall through this box: {}", error.what()));
    return no_falls;
  }
}

}   // namespace bedload

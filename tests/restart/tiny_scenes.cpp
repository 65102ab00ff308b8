// Boxes of a few hundred cells, grains soft enough for long steps.
#include "tests/restart/tiny_scenes.hpp"

#include <fmt/format.h>

#include <array>

#include "solver/grains/grain_dynamics.hpp"

namespace bedload::test {
namespace {

constexpr double diameter = 0.5e-3;   // [m]

/// A poured bed of `count` grains of density 2000 kg/m3 in a box of length x width x height diameters, in an oil of 1e-5 m2/s.
Scene poured_bed(std::uint64_t count, Vec3 box_in_diameters, std::array<int, 3> cells) {
  Scene scene;
  scene.bed.fluid = {.density = 1000, .viscosity = 1e-5};
  scene.bed.grains = {.diameter = diameter, .density = 2000, .friction = 0.5, .restitution = 0.6, .poisson = 0.25};
  scene.bed.grains.young_modulus = 2e4;   // soft, for long steps
  scene.bed.source = {.kind = BedSource::Kind::poured, .count = count, .seed = 7};
  scene.bed.length = diameter * box_in_diameters;
  scene.bed.sides = {Side::periodic, Side::periodic, Side::wall};
  scene.bed.gravity = {0, 0, -9.81};
  scene.grid.cells = cells;
  for (int c = 0; c < 3; ++c) scene.grid.h[c] = scene.bed.length[c] / cells[c];
  return scene;
}

/// Holds of `dwell` fluid steps at each level, sampled every seventh.
void add_ramp(Scene& scene, FlowRamp::Kind kind, std::vector<double> shields, int dwell) {
  const GrainProperties& g = scene.bed.grains;
  scene.bed.dem_step = 0.15 * rayleigh_time(g.diameter * (1 - 2 * g.spread), g.density, g.young_modulus, g.poisson);
  scene.steps.fluid_interval = 10 * scene.bed.dem_step;
  scene.drive = {.kind = kind, .quantity = FlowRamp::Quantity::shields, .levels = std::move(shields)};
  scene.drive.dwell = dwell * scene.steps.fluid_interval;
  scene.onset.method = Onset::Method::none;
  scene.record = {.every = 7 * scene.steps.fluid_interval, .tracks = {0, 42}};
  scene.grid.sides = scene.bed.sides, scene.grid.top = scene.bed.top;
  validate(scene);
}

}   // namespace

TinyScene lid_driven() {
  Scene scene = poured_bed(120, {8, 6, 10}, {4, 3, 20});
  add_ramp(scene, FlowRamp::Kind::lid, {0.05, 1.5, 0.2}, 40);
  return {"lid", scene};
}

TinyScene stream_on_a_slope() {
  Scene scene = poured_bed(100, {8, 6, 9}, {4, 3, 12});
  scene.bed.sides[1] = Side::wall;
  scene.bed.top = Top::free_slip;
  scene.bed.gravity = 9.81 * Vec3{0.05, 0, -0.99875};
  scene.bed.grains.spread = 0.2;
  scene.terms.pressure_gradient = scene.terms.viscous_stress = false;
  add_ramp(scene, FlowRamp::Kind::pressure, {0.1, 1.2}, 40);
  return {"slope", scene};
}

TinyScene suspension() {
  Scene scene = poured_bed(0, {8, 6, 8}, {4, 3, 8});
  scene.bed.fluid.viscosity = 2e-6;
  scene.bed.grains.density = 3000;
  scene.bed.sides = {Side::periodic, Side::periodic, Side::periodic};
  scene.bed.source = {.kind = BedSource::Kind::file, .count = 64, .csv = "x,y,z,diameter,density,fixed\n"};
  for (int n = 0; n < 64; ++n) {   // in rows closer along x than wide, the first of them fixed
    const double x = 1.2 * (n % 4) + 0.3, y = 1.5 * (n / 4 % 4) + 0.2 * (n % 3), z = 2 * (n / 16) + 0.4 * (n % 2);
    scene.bed.source.csv +=
        fmt::format("{},{},{},{},3000,{}\n", x * diameter, y * diameter, z * diameter, diameter, int(n < 2));
  }
  add_ramp(scene, FlowRamp::Kind::none, {0, 0}, 40);
  scene.steps.fluid_interval *= 2;   // beyond a tenth of the grain time
  return {"suspension", scene};
}

TinyScene syrup_through_a_layer() {
  Scene scene = poured_bed(0, {7, 5, 6}, {3, 4, 17});
  scene.bed.fluid.viscosity = 1e-2;
  scene.bed.sides = {Side::periodic, Side::periodic, Side::periodic};
  scene.bed.source = {.kind = BedSource::Kind::file, .count = 36, .csv = "x,y,z,diameter,density,fixed\n"};
  scene.drag = DragLawName::stokes;
  scene.terms.self_disturbance = true;
  const auto add = [&](double x, double y, double z, int fixed) {
    scene.bed.source.csv +=
        fmt::format("{},{},{},{},2000,{}\n", x * diameter, y * diameter, z * diameter, diameter, fixed);
  };
  for (int n = 0; n < 35; ++n) add(n % 7 + 0.3, n / 7 + 0.4, 1.1, 1);
  add(14.0 / 3, 2.5, 4, 0);   // on an edge, where its own flow is fastest
  add_ramp(scene, FlowRamp::Kind::none, {1e-3, -2e-3}, 3);
  scene.drive.kind = FlowRamp::Kind::through_flow, scene.drive.quantity = FlowRamp::Quantity::through_flow;
  scene.record.tracks = {35};
  validate(scene);
  return {"syrup", scene};
}

TinyScene every_term() {
  Scene scene = poured_bed(90, {8, 6, 9}, {4, 3, 12});
  scene.bed.sides[1] = Side::wall;
  scene.bed.grains.rolling_friction = 0.1;
  scene.bed.fluid.viscosity = 2e-6;   // strong shear: lifts beyond their laws
  Terms& terms = scene.terms;
  terms.self_disturbance = terms.added_mass = terms.shear_lift = terms.magnus = terms.viscous_torque = true;
  terms.wall_forces = terms.wet_restitution = terms.exposure = terms.turbulence = true;
  add_ramp(scene, FlowRamp::Kind::lid, {0.1, 1.5}, 12);
  return {"every_term", scene};
}

TinyScene taken_again() {
  Scene scene = poured_bed(0, {8, 6, 8}, {4, 3, 8});
  scene.bed.source = {.kind = BedSource::Kind::file, .count = 2, .csv = "x,y,z,diameter,density,fixed\n"};
  for (int n = 0; n < 2; ++n)
    scene.bed.source.csv +=
        fmt::format("{},{},{},{},2000,0\n", diameter, (2 + 2 * n) * diameter, (3 + 2 * n) * diameter, diameter);
  add_ramp(scene, FlowRamp::Kind::none, {0, 0}, 8);
  scene.drive.kind = FlowRamp::Kind::push, scene.drive.quantity = FlowRamp::Quantity::push;
  scene.drive.levels = {1000, 10};
  scene.record.tracks = {0, 1};
  validate(scene);
  return {"taken_again", scene};
}

TinyScene layers(FluidRung rung) {
  Scene scene = poured_bed(120, {8, 6, 10}, {1, 1, 25});
  scene.fluid = rung;
  scene.bed.fluid.viscosity = 2e-6;   // eddies and lifts matter
  scene.bed.grains.rolling_friction = 0.1;
  scene.terms.shear_lift = scene.terms.magnus = scene.terms.exposure = true;
  scene.terms.wet_restitution = scene.terms.turbulence = true;
  add_ramp(scene, rung == FluidRung::column ? FlowRamp::Kind::lid : FlowRamp::Kind::pressure, {0.05, 1.5, 0.2}, 30);
  return {std::string(name_of(rung)), scene};
}

TinyScene hopping() {
  Scene scene = poured_bed(110, {8, 6, 8}, {1, 1, 20});
  scene.fluid = FluidRung::column;
  scene.bed.gravity = 10 * scene.bed.gravity;   // so that a hold is many grain times long
  add_ramp(scene, FlowRamp::Kind::lid, {0.08, 0.15}, 100);
  return {"hopping", scene};
}

TinyScene search() {
  Scene scene = poured_bed(0, {8, 6, 6}, {4, 3, 12});
  scene.bed.source = {.kind = BedSource::Kind::file, .count = 20, .csv = "x,y,z,diameter,density,fixed\n"};
  for (int n = 0; n < 20; ++n) {   // each stands on the bottom, in rows a little apart
    const double x = 1.6 * (n % 5) + 0.5, y = 1.5 * (n / 5) + 0.3 * (n % 2) + 0.5;
    scene.bed.source.csv += fmt::format("{},{},{},{},2000,0\n", x * diameter, y * diameter, 0.5 * diameter, diameter);
  }
  add_ramp(scene, FlowRamp::Kind::lid, {0.05, 0.5, 5}, 14);
  scene.bed.grains.rolling_friction = 0.5;
  scene.onset = {.method = Onset::Method::bisect, .bracket = 2, .hold = 21 * scene.steps.fluid_interval};
  scene.record.tracks = {0, 19};
  validate(scene);
  return {"search", scene};
}

TinyScene sheared() {
  Scene scene = lid_driven().scene;
  scene.shear = {.shields = 0.8, .time = 30 * scene.steps.fluid_interval};
  scene.drive.levels = {0.05, 1.5};
  validate(scene);
  return {"sheared", scene};
}

TinyScene frozen_below() {
  Scene scene = lid_driven().scene;
  scene.frozen_depth = diameter;
  scene.bed.grains.rolling_friction = 0.1, scene.terms.wet_restitution = true;   // contacts that remember all they can
  scene.drive.levels = {0.05, 1.5};
  validate(scene);
  return {"frozen", scene};
}

}   // namespace bedload::test

// Which scenes can run.
#include "solver/scene.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.hpp"
#include "solver/expected_bed.hpp"
#include "solver/grains/bed_packing.hpp"

namespace bedload {

namespace {

using Found = std::vector<SceneProblem>;

bool packed(const BedScene& bed) {
  return bed.source.kind == BedSource::Kind::poured || bed.source.kind == BedSource::Kind::lattice;
}

void check_fit(const BedScene& bed, Found& found) {
  const double largest = largest_diameter(bed), depth = expected_bed_depth(bed);
  const char* edges[] = {"box.length", "box.width", "box.height"};
  for (int c = 0; c < 3; ++c) {
    if (bed.source.kind == BedSource::Kind::none || largest <= bed.length[c]) continue;
    found.push_back({edges[c], fmt::format("grains of {:.4g} m do not fit a box of {:.4g} m", largest, bed.length[c]),
                     "a larger box, or smaller grains"});
  }
  if (packed(bed) && depth > bed.length.z) {
    found.push_back({"bed.count",
                     fmt::format("{} grains make a bed about {:.3g} m deep and do not fit the box, {:.3g} m high",
                                 bed.source.count, depth, bed.length.z),
                     fmt::format("at most {} grains leave half of the box to the flow",
                                 std::floor(0.5 * bed.source.count * bed.length.z / depth))});
  }
  const bool poured = bed.source.kind == BedSource::Kind::poured;
  if (poured && bed.sides[2] == Side::periodic)
    found.push_back({"box.z", "poured grains settle on a bottom, and a periodic z has none",
                     "box.z = \"wall\", or bed.source = \"lattice\""});
  if (poured && norm2(bed.gravity) == 0)
    found.push_back({"box.gravity", "poured grains do not settle without gravity",
                     "bed.source = \"lattice\", \"file\" or \"none\""});
  if (bed.gravity.z > 0 || std::abs(bed.gravity.x) > std::abs(bed.gravity.z))
    found.push_back({"box.slope", "the box may be tilted by at most 45 degrees", "for example \"2 deg\""});
}

void check_grid(const Scene& scene, Found& found) {
  const auto& grid = scene.grid;
  if (scene.fluid != FluidRung::box) {
    if (grid.cells[2] < 3)
      found.push_back({"box.cell.z", fmt::format("{} layers are no profile", grid.cells[2]),
                       fmt::format("layers of at most {:.4g} m", scene.bed.length.z / 3)});
    return;
  }
  const char* cells[] = {"box.cell.xy", "box.cell.xy", "box.cell.z"};
  for (int c = 0; c < 3; ++c) {
    if (grid.cells[c] >= 3) continue;
    found.push_back({cells[c],
                     fmt::format("the box is {} cell{} across in {}; the kernel between grains and grid spans three",
                                 grid.cells[c], grid.cells[c] == 1 ? "" : "s", "xyz"[c]),
                     fmt::format("a cell of at most {:.4g} m, or a larger box", scene.bed.length[c] / 3)});
  }
  const double largest = scene.bed.grains.diameter * (1 + 2 * scene.bed.grains.spread),
               cube = largest * largest * largest;
  if (scene.bed.source.kind == BedSource::Kind::none || grid.cell_volume() >= cube) return;
  found.push_back({"box.cell.xy",
                   fmt::format("a cell holds {:.3g} d^3 of the largest grain; a single grain could then fill the space "
                               "around a face",
                               grid.cell_volume() / cube),
                   "cells of at least 1 d^3, for example xy = \"2 d\" with z = \"0.5 d\""});
}

/// What a flow with one velocity at each height cannot have.
void check_rung(const Scene& scene, Found& found) {
  if (scene.fluid == FluidRung::box) return;
  const auto& bed = scene.bed;
  const bool column = scene.fluid == FluidRung::column;
  const std::string_view name = column ? "column" : "profile";
  const auto refuse = [&](const char* key, const std::string& message, const std::string& hint) {
    found.push_back({key, fmt::format("models.fluid = \"{}\": {}", name, message), hint});
  };
  for (const int c : {0, 1})
    if (bed.sides[c] == Side::wall)
      refuse(c == 0 ? "box.x" : "box.y", "one velocity for each height knows no side walls",
             fmt::format("box.{} = \"periodic\", or models.fluid = \"box\"", "xy"[c]));
  if (bed.sides[2] == Side::periodic)
    refuse("box.z", "its flow stands on a bottom, and a periodic z has none",
           "box.z = \"wall\", or models.fluid = \"box\"");
  if (scene.fluid_start == FluidStart::taylor_green)
    refuse("fluid.start", "vortices have no one velocity for each height",
           "start = \"rest\", or models.fluid = \"box\"");
  if (scene.smoothing != Smoothing{})
    refuse("models.smoothing", "slices of grains take the place of the kernel that it widens",
           "leave smoothing out, or models.fluid = \"box\"");
  for (const auto& [term, member] : named_terms)
    if (scene.terms.*member && !carries(scene.fluid, member))
      refuse("models.terms", fmt::format("it does not carry {}", term),
             fmt::format("leave {} out, terms = \"auto\", or models.fluid = \"box\"", term));
  if (column && scene.terms.drag && scene.terms.model_b())
    refuse("models.terms", "its balance is that of Model A, without which momentum would not close",
           "add \"pressure_gradient\" and \"viscous_stress\", or models.fluid = \"box\"");
  if (!column && !scene.developed)
    refuse("drive.start", "a flow that answers to nothing is imposed as it is when steady",
           "start = \"developed\", or models.fluid = \"column\"");
}

void check_drive(const Scene& scene, Found& found) {
  using Kind = FlowRamp::Kind;
  const auto& bed = scene.bed;
  const bool walls = bed.sides[2] == Side::wall;
  if (scene.drive.kind == Kind::lid && !(walls && bed.top == Top::lid))
    found.push_back(
        {"drive.kind", "a lid drives the flow only where the box has one", "box.z = \"wall\" and box.top = \"lid\""});
  if (scene.drive.kind == Kind::pressure && bed.sides[0] == Side::wall)
    found.push_back({"drive.kind", "a pressure gradient moves nothing between walls in x", "box.x = \"periodic\""});
  if (scene.drive.kind == Kind::through_flow && walls)
    found.push_back({"drive.kind", "no net flux along z passes between bottom and top", "box.z = \"periodic\""});
  if (scene.drive.kind == Kind::push && (bed.grains.density <= bed.fluid.density || norm2(bed.gravity) == 0))
    found.push_back({"drive.kind", "grains without submerged weight cannot be pushed by a share of it",
                     "heavier grains, or gravity"});
  if (scene.fluid_start == FluidStart::taylor_green && !(scene.grid.periodic(0) && scene.grid.periodic(1)))
    found.push_back({"fluid.start", "Taylor-Green vortices need a box that is periodic in x and y",
                     "box.x = \"periodic\" and box.y = \"periodic\""});
  if (scene.drive.kind == Kind::none || scene.drive.quantity != FlowRamp::Quantity::shields) return;
  if (!walls)
    found.push_back({"drive.shields.from",
                     "a Shields number needs a bottom that carries the stress, and a periodic z has none",
                     "drive by gradient"});
  if (bed.grains.density <= bed.fluid.density || norm2(bed.gravity) == 0)
    found.push_back(
        {"drive.shields.from", "grains without submerged weight have no Shields number", "drive by speed or gradient"});
}

void check_shear(const Scene& scene, Found& found) {
  if (scene.shear.time == 0) return;
  if (!needs_settling(scene.bed))
    found.push_back({"bed.shear.shields", "only a bed that settles can be sheared and come to rest again",
                     "bed.source = \"poured\", or leave bed.shear out"});
  if (scene.drive.kind == FlowRamp::Kind::none || scene.drive.quantity != FlowRamp::Quantity::shields)
    found.push_back({"bed.shear.shields",
                     "a bed is sheared by the drive of the study, which has no Shields numbers here",
                     "give levels by drive.shields, or leave bed.shear out"});
}

/// Terms that act by the drag coefficient, are cut to half of it (lifts) or correct it; the viscous torque has its own.
constexpr NamedTerm beside_drag[] = {{"self_disturbance", &Terms::self_disturbance},
                                     {"shear_lift", &Terms::shear_lift},
                                     {"magnus", &Terms::magnus},
                                     {"wall_forces", &Terms::wall_forces},
                                     {"exposure", &Terms::exposure}};

void check_terms(const Scene& scene, Found& found) {
  const auto& terms = scene.terms;
  const auto refuse = [&](std::string message, std::string hint) {
    found.push_back({"models.terms", std::move(message), std::move(hint)});
  };
  if (terms.pressure_gradient != terms.viscous_stress)
    refuse("pressure_gradient and viscous_stress are two halves of one model of the void fraction: both or neither",
           "both (Model A), or neither (Model B)");
  if (terms.wet_restitution && terms.lubrication)
    refuse("wet_restitution and lubrication are both the film between grains that meet: together they count it twice",
           "keep one: wet_restitution costs nothing, lubrication resolves the film");
  for (const auto& [name, term] : beside_drag)
    if (scene.terms.*term && !terms.drag)
      refuse(fmt::format("{} works on the drag of a grain, and drag is left out", name),
             fmt::format("add \"drag\", or leave {} out", name));
  const bool has_wall = std::ranges::find(scene.bed.sides, Side::wall) != scene.bed.sides.end();
  if (terms.wall_forces && !has_wall)
    refuse("wall_forces belong to plane walls, and the box has none", "leave wall_forces out, or box.z = \"wall\"");
  const bool turns =
      terms.viscous_torque || scene.bed.grains.friction > 0 || scene.bed.source.kind == BedSource::Kind::file;
  if (terms.magnus && !turns)
    refuse("magnus is the force of a grain's spin, and nothing turns these: no viscous_torque, no friction",
           "add \"viscous_torque\", or grains.friction");
  if (terms.exposure && scene.bed.source.kind == BedSource::Kind::none)
    refuse("exposure is that of grains in a bed, and there is none", "leave exposure out");
}

/// Further smoothing of the kernel.
void check_smoothing(const Scene& scene, Found& found) {
  const struct {
    const char* key;
    double sigma, edge;
  } widths[] = {{"models.smoothing.xy", scene.smoothing.xy, std::min(scene.bed.length.x, scene.bed.length.y)},
                {"models.smoothing.z", scene.smoothing.z, scene.bed.length.z}};
  for (const auto& [key, sigma, edge] : widths)
    if (sigma < 0 || 4 * sigma > edge)
      found.push_back({key,
                       fmt::format("a standard deviation of {:.4g} m in a box of {:.4g} m, of which at most a quarter "
                                   "has a meaning",
                                   sigma, edge),
                       fmt::format("from 0 (none) to {:.4g} m", edge / 4)});
  if (scene.smoothing == Smoothing{}) return;
  for (const auto& [name, on] :
       {std::pair{"self_disturbance", scene.terms.self_disturbance}, {"wall_forces", scene.terms.wall_forces}})
    if (on)
      found.push_back({"models.terms",
                       fmt::format("{} takes from a lone grain what the grid gives back of its own flow, which is not "
                                   "known for a kernel widened by models.smoothing",
                                   name),
                       fmt::format("leave {} out, or models.smoothing", name)});
}

void check_roughness(const Scene& scene, Found& found) {
  if (scene.bottom_roughness == 0) return;
  if (!scene.terms.turbulence)
    found.push_back({"box.roughness",
                     "a rough wall has meaning only for a turbulent flow, and turbulence is not among the terms",
                     "add \"turbulence\" to models.terms, or leave roughness out"});
  if (scene.bed.sides[2] == Side::periodic)
    found.push_back({"box.roughness", "it is that of the bottom, and a periodic z has none", "leave it out"});
}

void check_frozen(const Scene& scene, Found& found) {
  if (scene.frozen_depth == 0) return;
  if (!needs_settling(scene.bed))
    found.push_back({"models.frozen_depth", "only a bed that lies on a bottom has a surface to be deep below",
                     "a poured bed or a lattice on a bottom, or leave frozen_depth out"});
  if (scene.frozen_depth < largest_diameter(scene.bed))
    found.push_back(
        {"models.frozen_depth",
         fmt::format("{:.3g} m is less than the largest grain, {:.3g} m: the surface itself would be frozen",
                     scene.frozen_depth, largest_diameter(scene.bed)),
         "\"3 d\", or 0 to move all grains"});
}

void check_crowded(const Scene& scene, Found& found) {
  if (scene.terms.crowded > 0 && scene.terms.crowded <= 1) return;
  found.push_back({"models.crowded",
                   fmt::format("no grains are packed to {:g}: above 0 and at most 1 are accepted", scene.terms.crowded),
                   "0.04, or up to 0.3 to see what it does to a bed's surface"});
}

void check_tracks(const Scene& scene, Found& found) {
  for (const auto id : scene.record.tracks) {
    if (scene.bed.source.kind == BedSource::Kind::file || id < scene.bed.source.count) continue;
    found.push_back({"record.tracks",
                     fmt::format("there is no grain {}: ids run from 0 to {}", id, scene.bed.source.count - 1),
                     "leave it out"});
  }
}

void check_steps(const Scene& scene, Found& found) {
  const double rayleigh = smallest_rayleigh_time(scene.bed);
  if (packed(scene.bed) && !scene.steps.beyond_limit && scene.bed.dem_step > 0.3 * rayleigh)
    found.push_back({"steps.dem",
                     fmt::format("{:.4g} s is {:.2g} Rayleigh times of the smallest grain", scene.bed.dem_step,
                                 scene.bed.dem_step / rayleigh),
                     "at most 0.3"});
  if (!(scene.bed.dem_step > 0)) found.push_back({"steps.dem", "the DEM step is not positive", ""});
  if (scene.steps.fluid_interval < scene.bed.dem_step)
    found.push_back({"steps.fluid", "the fluid step is shorter than the DEM step", ""});
}

}   // namespace

bool carries(FluidRung rung, bool Terms::*term) {
  constexpr bool Terms::*of_the_box[] = {&Terms::self_disturbance, &Terms::wall_forces};
  return rung == FluidRung::box || std::ranges::find(of_the_box, term) == std::end(of_the_box);
}

std::vector<SceneProblem> grain_problems_of(const BedScene& bed) {
  const auto& g = bed.grains;
  Found found;
  if (!(g.spread >= 0 && g.spread <= 0.3))
    found.push_back({"grains.spread", fmt::format("{} lets the smallest grain vanish", g.spread), "from 0 to 0.3"});
  if (g.restitution > 1)
    found.push_back(
        {"grains.restitution", fmt::format("{} makes energy in every collision", g.restitution), "from 0 to 1"});
  if (g.poisson > 0.49)
    found.push_back({"grains.poisson", fmt::format("{} is not Poisson's ratio of a solid", g.poisson),
                     "0 to 0.49; glass and quartz: 0.2-0.3"});
  if (needs_settling(bed) && g.density <= bed.fluid.density)
    found.push_back(
        {"grains.density",
         fmt::format("grains of {} kg/m3 do not settle in a fluid of {} kg/m3", g.density, bed.fluid.density),
         "heavier grains, or bed.source = \"file\""});
  return found;
}

std::vector<SceneProblem> problems_of(const Scene& scene) {
  Found found = grain_problems_of(scene.bed);
  check_fit(scene.bed, found);
  check_grid(scene, found);
  check_rung(scene, found);
  check_drive(scene, found);
  check_shear(scene, found);
  check_terms(scene, found);
  check_smoothing(scene, found);
  check_roughness(scene, found);
  check_frozen(scene, found);
  check_crowded(scene, found);
  check_tracks(scene, found);
  check_steps(scene, found);
  return found;
}

void validate(const Scene& scene) {
  std::string message;
  for (const auto& problem : problems_of(scene))
    message += fmt::format("{}{}: {}", message.empty() ? "" : "\n", problem.parameter, problem.message);
  if (!message.empty()) throw Error(ErrorKind::study_invalid, message);
}

}   // namespace bedload

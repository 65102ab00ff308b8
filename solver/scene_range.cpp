// Checks of range, one function each.
#include "solver/scene_range.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "solver/coupling/drag_laws.hpp"
#include "solver/dimensionless.hpp"
#include "solver/expected_bed.hpp"
#include "solver/grains/bed_packing.hpp"

namespace bedload {

namespace {

using Kind = FlowRamp::Kind;
using Found = std::vector<SceneProblem>;

constexpr double cohesive_size = 60e-6;       // [m]: silt and clay stick
constexpr double thermal_energy = 4.05e-21;   // k T at 20 degrees Celsius [J]
constexpr double brownian_peclet = 10;        // W' d/(k T) below which grains diffuse as fast as they fall
constexpr double largest_response = 0.7;      // kappa up to which a correction by 1/(1 - kappa) is trusted
constexpr double cells_in_a_gap = 4;
constexpr double cell_at_a_bed = 2;   // d: over more, the speed at a surface grain is that of the cell
constexpr double shallow_bed = 5;     // d: creep reaches the bottom
constexpr double sliding = 14 * std::numbers::pi / 180;   // over a flat bottom: docs/thresholds.md
constexpr double soft_overlap = 0.01;                     // of d
constexpr double lift_reynolds = 100, lift_shear = 0.4;   // Saffman & Mei, far from walls
constexpr double wall_lift_reynolds = 200;                // Zeng et al., a lone grain at a wall
constexpr double spin_reynolds = 140;                     // Oesterle & Bui Dinh

void laminar_assumed(const SceneFacts& f, Found& found) {
  const auto& n = f.n;
  const auto flow = gap_flow(f.scene, n);
  if (f.scene.terms.turbulence || flow == GapFlow::laminar || flow == GapFlow::enclosed) return;
  const bool smooth = flow == GapFlow::over_smooth_bed;
  const auto rough =
      std::isnan(n.friction_reynolds) ? std::string() : fmt::format(" and Re* = {:.3g}", n.friction_reynolds);
  found.push_back({"fluid.viscosity",
                   fmt::format("{}: {}a {} of {:.3g} m/s, a gap Reynolds number of {:.2g} (laminar up to {:g}){}; {}",
                               smooth ? "laminar is assumed" : "this laminar scene is not physical",
                               std::isnan(n.shields) ? "" : fmt::format("theta = {:.2g} means ", n.shields),
                               f.scene.drive.kind == Kind::lid ? "lid speed" : "mean speed", n.flow_speed,
                               n.gap_reynolds, turbulent_gap(f.scene), rough,
                               smooth ? "the sublayer covers the grains, but the flow above is turbulent"
                                      : "the real flow is turbulent"),
                   "a more viscous liquid or smaller grains make it laminar; the term turbulence models it"});
}

void drag_law_reynolds(const SceneFacts& f, Found& found) {
  const auto range = range_of(f.scene.drag);
  if (!f.scene.terms.drag || !(f.n.grain_reynolds > range.highest_re)) return;
  found.push_back({"models.drag",
                   fmt::format("grains come to Re = {:.3g}; the drag law {} is made for Re up to {:g}",
                               f.n.grain_reynolds, name_of(f.scene.drag), range.highest_re),
                   "another law (docs/physics_coupling.md lists their ranges), or a slower flow"});
}

void drag_law_packing(const SceneFacts& f, Found& found) {
  if (!f.grains.any || !f.scene.terms.drag) return;
  const auto range = range_of(f.scene.drag);
  const double dense = 1 - f.grains.densest, loose = 1 - f.grains.loosest;
  if (dense < range.lowest_void)
    found.push_back(
        {"models.drag",
         fmt::format("the void fraction among grains comes down to about {:.2g}; the drag law {} is made for {:g} "
                     "and more",
                     dense, name_of(f.scene.drag), range.lowest_void),
         "for beds and suspensions: di_felice, gidaspow, beetstra, tang, koch_hill or rong"});
  if (f.grains.mobile && loose > range.highest_void)
    found.push_back(
        {"models.drag",
         fmt::format("grains that stand free have a void fraction of about {:.2g} around them; the drag law {} is "
                     "made for {:g} and less, and leaves them with too little drag",
                     loose, name_of(f.scene.drag), range.highest_void),
         "gidaspow is ergun in the bed and Wen and Yu above it"});
}

void small_grains(const SceneFacts& f, Found& found) {
  if (!f.grains.mobile) return;
  const double d = f.grains.smallest;
  const auto& bed = f.scene.bed;
  const double weight = bed.fluid.density * reduced_gravity(f.n.density_ratio, norm(bed.gravity)) * sphere_volume(d);
  if (d < cohesive_size)
    found.push_back(
        {"grains.diameter",
         fmt::format("grains of {:.3g} micron: below about {:g} micron cohesion holds natural grains together; "
                     "there is none here",
                     1e6 * d, 1e6 * cohesive_size),
         "read the result as that of clean spheres, or take larger grains"});
  if (weight > 0 && weight * d < brownian_peclet * thermal_energy)
    found.push_back(
        {"grains.diameter",
         fmt::format("grains of {:.3g} micron diffuse by Brownian motion: Peclet number W' d/(k T) = {:.2g} < {:g}; "
                     "there is none here",
                     1e6 * d, weight * d / thermal_energy, brownian_peclet),
         "larger or heavier grains"});
}

void cells_and_lone_grains(const SceneFacts& f, Found& found) {
  if (!f.scene.terms.self_disturbance || f.grains.bed || !(f.n.self_response > largest_response)) return;
  found.push_back(
      {"box.cell.xy",
       fmt::format("cells of {:.2g} d on average are small for lone grains: kappa = {:.2g} of their drag comes "
                   "back as flow, and its correction is trusted up to {:g}",
                   f.edge() / f.diameter(), f.n.self_response, largest_response),
       fmt::format("cells of at least {:.2g} d", f.edge() / f.diameter() * f.n.self_response / largest_response)});
}

void cells_at_a_bed(const SceneFacts& f, Found& found) {
  if (!f.sheared_bed()) return;
  const double h = f.scene.grid.h.z;
  if (h > cell_at_a_bed * f.diameter())
    found.push_back(
        {"box.cell.z",
         fmt::format("cells {:.2g} d high: the flow at a surface grain is a mean over them, and theta_c depends on "
                     "their height",
                     h / f.diameter()),
         fmt::format("at most {:g} d, better 0.5 d", cell_at_a_bed)});
  if (f.n.gap < cells_in_a_gap * h)
    found.push_back(
        {"box.cell.z",
         fmt::format("the gap above the bed is {:.3g} cells high; its flow wants {:g}", f.n.gap / h, cells_in_a_gap),
         "flatter cells, or a higher box"});
}

void slope(const SceneFacts& f, Found& found) {
  const auto& g = f.scene.bed.gravity;
  const double tilt = std::atan2(std::abs(g.x), std::abs(g.z));
  if (!f.grains.bed || !f.grains.mobile || tilt < (1 - 1e-9) * sliding) return;
  const double degree = 180 / std::numbers::pi;
  found.push_back(
      {"box.slope",
       fmt::format(
           "{:.3g} degrees: beds of spheres on a flat bottom have been seen to slide over it as a whole from {:.0f} "
           "degrees on, without any flow, and the angle of repose of spheres is about 25",
           tilt * degree, sliding * degree),
       "a gentler slope, unless an avalanche is wanted"});
}

void depth(const SceneFacts& f, Found& found) {
  if (!f.sheared_bed() || !needs_settling(f.scene.bed) || f.n.bed_depth >= shallow_bed) return;
  found.push_back({"bed.count",
                   fmt::format("a bed {:.2g} d deep feels the flat bottom: creep reaches some {:g} d down",
                               f.n.bed_depth, shallow_bed),
                   "a deeper bed, for example depth = \"6 d\""});
}

/// What a hold must outlast: viscosity's way over a diameter (the rest of the flow is laid on), or over the whole gap.
void holds(const SceneFacts& f, Found& found) {
  if (!is_sheared(f.scene) || f.scene.onset.method != Onset::Method::ramp) return;
  const double d = f.diameter(), pi = std::numbers::pi;
  const double settle = f.scene.developed ? d * d / f.viscosity() : f.n.gap * f.n.gap / (pi * pi * f.viscosity());
  if (f.scene.drive.dwell >= settle) return;
  found.push_back(
      {"drive.dwell",
       fmt::format("holds of {:.2g} s are shorter than the {:.2g} s that viscosity takes over {}: onset is judged "
                   "before the flow is steady",
                   f.scene.drive.dwell, settle, f.scene.developed ? "a diameter at the bed's surface" : "the gap"),
       fmt::format("a dwell of at least \"{:.2g} s\"", settle)});
}

/// Overlap at the bottom, (G14): delta/d = [(pi/2) (1 - nu^2) N (rho_p - rho_f) g d/Y]^(2/3).
void stiffness(const SceneFacts& f, Found& found) {
  const auto& bed = f.scene.bed;
  const auto& g = bed.grains;
  if (!needs_settling(bed) || !(g.young_modulus > 0)) return;
  const double load =
      bed.fluid.density * reduced_gravity(f.n.density_ratio, norm(bed.gravity)) * g.diameter * bed_layers(bed);
  const double overlap =
      std::pow(0.5 * std::numbers::pi * (1 - g.poisson * g.poisson) * load / g.young_modulus, 2.0 / 3);
  if (!(overlap > soft_overlap)) return;
  found.push_back(
      {"grains.stiffness",
       fmt::format("the lowest grains overlap by {:.2g} of a diameter under the bed's weight; up to {:g} leaves "
                   "onset as it is",
                   overlap, soft_overlap),
       "\"auto\", or a larger modulus"});
}

/// A law for a term, and the Reynolds number of a grain up to which it is known.
void law_of_lift(const SceneFacts& f, const char* law, double limit, const char* term, Found& found) {
  if (f.n.grain_reynolds > limit)
    found.push_back(
        {"models.terms",
         fmt::format("grains come to Re = {:.3g}; the law of {} is known up to {:g}", f.n.grain_reynolds, law, limit),
         fmt::format("leave {} out, or a slower flow", term)});
}

void laws_of_lift(const SceneFacts& f, Found& found) {
  const auto& terms = f.scene.terms;
  if (terms.magnus) law_of_lift(f, "Oesterle and Bui Dinh for magnus", spin_reynolds, "magnus", found);
  if (!terms.shear_lift) return;
  if (terms.wall_forces && f.grains.nearness > 0 && !f.grains.bed)
    return law_of_lift(f, "Zeng et al. for shear_lift at a wall", wall_lift_reynolds, "shear_lift", found);
  law_of_lift(f, "Saffman and Mei for shear_lift", lift_reynolds, "shear_lift", found);
  const bool lies_in_shear = f.sheared_bed() || (f.sheared() && f.grains.nearness == 1);
  if (lies_in_shear && f.n.shear_per_slip > lift_shear)
    found.push_back(
        {"models.terms",
         fmt::format("a grain at rest at the surface has d|omega|/(2|w|) = {:.2g}; the law of Saffman and Mei for "
                     "shear_lift is made for {:g} and less, far from walls",
                     f.n.shear_per_slip, lift_shear),
         "read the lift on a bed as an order of magnitude, or leave shear_lift out; for lone grains, wall_forces "
         "brings the law of a wall"});
}

void idle_drive(const SceneFacts& f, Found& found) {
  const auto kind = f.scene.drive.kind;
  if (f.grains.mobile && !f.scene.terms.drag &&
      (kind == Kind::lid || kind == Kind::pressure || kind == Kind::through_flow))
    found.push_back({"drive.kind", "the drive moves the fluid, but without drag the fluid moves no grain",
                     "add \"drag\" to models.terms, or terms = \"auto\""});
}

}   // namespace

std::vector<SceneProblem> range_problems_of(const SceneFacts& facts) {
  Found found;
  for (const auto check : {laminar_assumed, drag_law_reynolds, drag_law_packing, small_grains, cells_and_lone_grains,
                           cells_at_a_bed, slope, depth, holds, stiffness, laws_of_lift, idle_drive})
    check(facts, found);
  return found;
}

}   // namespace bedload

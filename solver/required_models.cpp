// The rules: term by term, when it matters, and the ratio that says so (docs/physics.md, section 2).
#include "solver/required_models.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "solver/coupling/drag_laws.hpp"
#include "solver/coupling/lateral_forces.hpp"
#include "solver/coupling/packing_of_others.hpp"
#include "solver/coupling/spin_exchange.hpp"
#include "solver/dimensionless.hpp"
#include "solver/grains/grains.hpp"
#include "solver/scene_range.hpp"

namespace bedload {

namespace {

constexpr double two_way_loading = 1e-3;   // phi s: mass of grains per mass of fluid
constexpr double unsteady_share = 0.02;    // of the submerged weight, by accelerating fluid
constexpr double light_grain = 5;          // s below which a grain carries fluid along
constexpr double lone_added_mass = 0.5;    // of the displaced fluid
constexpr double slow_shear = 0.5;         // Re_g
constexpr double share_of_weight = 0.05;   // of a lateral force, or of a torque per radius
constexpr double spinning = 0.1;           // omega d/(2 w)
constexpr double inertial = 1;             // Re of a grain below which spin deflects nothing
constexpr double dry_impact = 2000;        // impact Stokes number
constexpr double near_wall = 0.05;         // a/z
constexpr double own_flow = 0.01;          // kappa: 1 % of a speed; d/h = 0.015 in slow flow
constexpr double loss_per_stokes = 35;     // ln of the restitution a film takes is 35/St

std::string_view side(bool above) { return above ? ">" : "<="; }

ModelChoice drag(const SceneFacts& f) {
  const double loading = f.grains.any ? f.n.solid_fraction * f.n.density_ratio : 0;
  const auto why =
      loading > two_way_loading
          ? fmt::format("mass loading phi s = {:.3g} > {:g}: both ways", loading, two_way_loading)
          : fmt::format("mass loading phi s = {:.3g} <= {:g}: the fluid hardly feels it", loading, two_way_loading);
  return {
      .wanted = f.grains.any,
      .ratio = loading,
      .reason = fmt::format("{}, by the law of {}; without it the flow moves no grain", why, name_of(f.scene.drag))};
}

ModelChoice buoyancy(const SceneFacts& f) {
  const double share = 1 / f.n.density_ratio;
  const auto worth = share < 1    ? fmt::format("grains weigh {:.3g} times too much", 1 / (1 - share))
                     : share == 1 ? std::string("grains sink where they should float")
                                  : std::string("grains sink where they should rise");
  return {.wanted = f.grains.any,
          .ratio = share,
          .reason = fmt::format("1/s = {:.3g} of a grain's weight; without it {}", share, worth)};
}

/// Both halves of Model A by one rule: fluid that accelerates as grains do, |Du/Dt| ~ g, pushes them by V rho_f Du/Dt.
double unsteady_ratio(const SceneFacts& f) { return 1 / std::abs(f.n.density_ratio - 1); }

ModelChoice pressure_gradient(const SceneFacts& f) {
  const double ratio = unsteady_ratio(f);
  return {.wanted = f.grains.any && ratio > unsteady_share,
          .ratio = ratio,
          .reason = fmt::format("fluid that accelerates by g pushes a grain with 1/|s - 1| = {:.3g} of its submerged "
                                "weight ({} {:g}); without it (Model B) only steady, nearly uniform flow is right",
                                ratio, side(ratio > unsteady_share), unsteady_share)};
}

ModelChoice viscous_stress(const SceneFacts& f) {
  const double ratio = unsteady_ratio(f);
  return {.wanted = f.grains.any && ratio > unsteady_share,
          .ratio = ratio,
          .reason =
              "the other half of Model A, together with pressure_gradient or not at all; without it the shear that "
              "varies over a grain does not pull it"};
}

/// What is known of a grain's own flow is known for the kernel as it is.
bool widened(const SceneFacts& f) { return f.scene.smoothing != Smoothing{}; }
constexpr auto not_widened =
    "the grid's response to a lone grain is not known for a kernel widened by models.smoothing";

ModelChoice self_disturbance(const SceneFacts& f) {
  if (widened(f)) return {.ratio = no_number, .reason = not_widened};
  const double share = f.n.self_response;
  if (loneness(f.grains.loosest, f.scene.terms.crowded) == 0)
    return {.ratio = no_number,
            .reason = fmt::format("no lone grain: a packing of at least {:.2g} around every one", f.grains.loosest)};
  const auto worth = share < 1 ? fmt::format("falls about {:.2g} % too fast", 100 * share / (1 - share))
                               : std::string("feels no drag worth the name");
  return {.wanted = share > own_flow,
          .ratio = share,
          .reason = fmt::format(
              "kappa = {:.2g} ({} {:g}) of a lone grain's drag comes back to it as flow, cells of {:.2g} d; "
              "without it a lone grain {}",
              share, side(share > own_flow), own_flow, f.edge() / f.diameter(), worth)};
}

ModelChoice added_mass(const SceneFacts& f) {
  const double share = lone_added_mass / (f.n.density_ratio + lone_added_mass);
  return {.wanted = f.grains.mobile && f.n.density_ratio < light_grain,
          .ratio = share,
          .reason =
              fmt::format("{:.2g} of the inertia of a grain of s = {:.3g} ({} {:g}); without it grains start and stop "
                          "that much too fast, steady motion stays",
                          share, f.n.density_ratio, f.n.density_ratio < light_grain ? "<" : ">=", light_grain)};
}

/// A force or torque that needs shear.
ModelChoice not_sheared(const std::string& what) {
  return {.ratio = 0, .reason = fmt::format("no shear over bed or bottom: {} = 0", what)};
}

ModelChoice shear_lift(const SceneFacts& f) {
  if (!f.sheared()) return not_sheared("1.10 theta Re_g");
  const double ratio = f.n.lift_per_weight, re = f.n.shear_reynolds;
  return {.wanted = re > slow_shear && ratio > share_of_weight,
          .ratio = ratio,
          .reason = fmt::format(
              "lift on a surface grain 1.10 theta Re_g = {:.2g} of its weight ({} {:g}), Re_g = {:.2g} "
              "({} {:g}); without it so much too heavy",
              ratio, side(ratio > share_of_weight), share_of_weight, re, side(re > slow_shear), slow_shear)};
}

constexpr auto nothing_turns = "no shear over bed or bottom, and no spin in the table of grains: nothing turns yet";

/// How fast grains and fluid turn against each other, and pass each other.
struct Turning {
  double spin, slip;       // [rad/s], [m/s]
  bool of_table = false;   // a grain that a table makes turn; else a surface grain that does not turn yet
  std::string_view who() const { return of_table ? "a grain that spins to begin with" : "a surface grain"; }
};
/// A surface grain at half a diameter from the bed, or a grain that a table makes turn faster than the shear.
Turning turning(const SceneFacts& f) {
  const double shear = f.sheared() ? f.n.shear_rate : 0;
  Turning t{0.5 * shear, 0.5 * shear * f.diameter()};
  if (f.grains.fastest_spin > t.spin) {
    const double fall = std::isnan(f.n.settling_speed) ? 0 : f.n.settling_speed;
    t = {f.grains.fastest_spin, std::max({t.slip, f.grains.fastest, fall}), true};
  }
  return t;
}

double submerged_weight(const SceneFacts& f) {   // per mass of fluid [m/s2]
  return reduced_gravity(f.n.density_ratio, norm(f.scene.bed.gravity));
}

ModelChoice magnus(const SceneFacts& f) {
  const auto turns = turning(f);
  if (!(turns.spin > 0)) return {.ratio = 0, .reason = nothing_turns};
  const double d = f.diameter(), nu = f.viscosity();
  const double spin_ratio = turns.spin * d / (2 * turns.slip), re = reynolds_number(turns.slip, d, nu);
  const double force = turns.slip * norm(bedload::magnus({turns.slip, 0, 0}, {0, turns.spin, 0}, d, nu));
  const double ratio = force > 0 ? force / (submerged_weight(f) * sphere_volume(d)) : 0;
  return {.wanted =
              f.grains.mobile && f.grains.may_turn && spin_ratio > spinning && re > inertial && ratio > share_of_weight,
          .ratio = ratio,
          .reason = fmt::format("force by spin {:.2g} of the weight of {} ({} {:g}), omega d/(2 w) = {:.2g} ({} {:g}), "
                                "Re = {:.2g} ({} {:g}); without it so much is missing beside shear lift",
                                ratio, turns.who(), side(ratio > share_of_weight), share_of_weight, spin_ratio,
                                side(spin_ratio > spinning), spinning, re, side(re > inertial), inertial)};
}

/// 6 theta in shear: 12 nu omega/(|s - 1| g d) at omega = gdot/2.
ModelChoice viscous_torque(const SceneFacts& f) {
  const auto turns = turning(f);
  if (!(turns.spin > 0)) return {.ratio = 0, .reason = nothing_turns};
  const double d = f.diameter(), nu = f.viscosity();
  const double by_spin =
      torque_factor(shear_reynolds_number(turns.spin, d, nu)) * 12 * nu * turns.spin / (submerged_weight(f) * d);
  const double ratio = turns.of_table ? by_spin : f.n.torque_per_weight;
  return {
      .wanted = f.grains.mobile && ratio > share_of_weight,
      .ratio = ratio,
      .reason = fmt::format("torque on {} {}{:.2g} of its weight times radius ({} {:g}); without it {}", turns.who(),
                            turns.of_table ? "" : "6 theta = ", ratio, side(ratio > share_of_weight), share_of_weight,
                            turns.of_table ? "it goes on spinning" : "theta_c comes out too high")};
}

ModelChoice wall_forces(const SceneFacts& f) {
  if (widened(f)) return {.ratio = no_number, .reason = not_widened};
  const double k = f.grains.nearness, ratio = 9.0 / 16 * k;
  if (k == 0)
    return {.ratio = 0,
            .reason = fmt::format("{}: a drag law for many grains knows the neighbours",
                                  loneness(f.grains.loosest, f.scene.terms.crowded) > 0 && !f.grains.bed
                                      ? "no plane wall near a lone grain"
                                      : "no lone grain beside a wall")};
  return {
      .wanted = k > near_wall,
      .ratio = ratio,
      .reason = fmt::format("a lone grain comes to a/z = {:.2g} ({} {:g}) of a wall: 9/16 a/z = {:.2g}; without it so "
                            "much drag is missing there, and more in contact",
                            k, side(k > near_wall), near_wall, ratio)};
}

/// Both film models; of the two, the one that is on, else restitution, which costs nothing.
ModelChoice film(const SceneFacts& f, bool chosen, bool other_on, std::string_view other) {
  const double st = f.n.impact_stokes, share = st > 0 ? 1 - std::exp(-loss_per_stokes / st) : 1;
  const bool wet = f.grains.collide && st < dry_impact && st > 0;
  auto why = !f.grains.collide ? std::string("nothing collides")
             : !(st > 0)       ? std::string("nothing is known to bring grains together")
                         : fmt::format("impact Stokes number {:.2g} ({} {:g}): the film takes {:.0f} % of a rebound",
                                       st, st < dry_impact ? "<" : ">=", dry_impact, 100 * share);
  why += chosen     ? "; without it collisions rebound as dry ones"
         : other_on ? fmt::format("; {} stands for it", other)
                    : fmt::format("; the cheaper {} would do, and is off too", other);
  return {.wanted = wet && chosen, .ratio = f.grains.collide && st > 0 ? share : no_number, .reason = why};
}
ModelChoice wet_restitution(const SceneFacts& f) {
  const auto& terms = f.scene.terms;
  return film(f, !terms.lubrication, terms.lubrication, "lubrication");
}
ModelChoice lubrication(const SceneFacts& f) {
  const auto& terms = f.scene.terms;
  return film(f, terms.lubrication, terms.wet_restitution, "wet_restitution");
}

ModelChoice exposure(const SceneFacts& f) {
  return {.ratio = no_number,
          .reason = f.grains.bed ? "an empirical factor for surface grains that stand out: only where a list names it; "
                                   "without it theta_c of random beds comes out too high"
                                 : "no bed to stand out of"};
}

std::string_view verdict_on(GapFlow flow) {
  switch (flow) {
    case GapFlow::laminar: return "laminar";
    case GapFlow::over_smooth_bed:
      return "laminar assumed: the sublayer covers the grains, the flow above is turbulent; without the term the lid "
             "or gradient is that of laminar flow";
    case GapFlow::turbulent: return "turbulent; without it laminar is assumed, against the numbers";
    case GapFlow::enclosed: break;
  }
  return "laminar assumed: walls across the flow, for which that limit is not made";
}

ModelChoice turbulence(const SceneFacts& f) {
  const auto& n = f.n;
  if (std::isnan(n.gap_reynolds)) return not_sheared("gap Reynolds number");
  const auto flow = gap_flow(f.scene, n);
  const auto bed = std::isnan(n.friction_reynolds)
                       ? std::string()
                       : fmt::format("Re* = {:.3g} ({} {:g}), ", n.friction_reynolds,
                                     side(n.friction_reynolds > smooth_bed_reynolds), smooth_bed_reynolds);
  return {.wanted = flow == GapFlow::turbulent,
          .ratio = n.gap_reynolds / turbulent_gap(f.scene),
          .reason =
              fmt::format("{}gap Reynolds number {:.3g} ({} {:g}){}: {}", bed, n.gap_reynolds,
                          side(n.gap_reynolds > turbulent_gap(f.scene)), turbulent_gap(f.scene),
                          std::isnan(n.shields) ? "" : fmt::format(" at theta = {:.2g}", n.shields), verdict_on(flow))};
}

ModelChoice rolling_friction(const SceneFacts& f) {
  const double mu = f.scene.bed.grains.rolling_friction;
  return {
      .term = "rolling_friction",
      .on = mu > 0,
      .ratio = mu,
      .reason = mu > 0 ? fmt::format("mu_r = {:g}, as grains.rolling_friction says; no rule asks for it", mu)
                       : "spheres roll freely; grains.rolling_friction stands for angular grains, no rule asks for it"};
}

struct Rule {
  std::string_view term;
  ModelChoice (*judge)(const SceneFacts&);
};
constexpr Rule rules[] = {{"drag", drag},
                          {"buoyancy", buoyancy},
                          {"pressure_gradient", pressure_gradient},
                          {"viscous_stress", viscous_stress},
                          {"self_disturbance", self_disturbance},
                          {"added_mass", added_mass},
                          {"shear_lift", shear_lift},
                          {"magnus", magnus},
                          {"viscous_torque", viscous_torque},
                          {"wall_forces", wall_forces},
                          {"wet_restitution", wet_restitution},
                          {"lubrication", lubrication},
                          {"exposure", exposure},
                          {"turbulence", turbulence}};
static_assert(std::size(rules) == std::size(named_terms));

constexpr auto without_grains = "there are no grains";

bool Terms::*member(std::string_view name) { return std::ranges::find(named_terms, name, &NamedTerm::name)->term; }

/// The ratio as a reader wants it beside a name.
std::string with_ratio(const ModelChoice& m) {
  return std::isfinite(m.ratio) ? fmt::format("{} ({:.2g})", m.term, m.ratio) : m.term;
}

}   // namespace

std::vector<ModelChoice> required_models(const SceneFacts& facts) {
  std::vector<ModelChoice> models;
  for (const auto& rule : rules) {
    const bool of_grains = rule.term != "turbulence";
    auto& m = models.emplace_back();
    if (facts.grains.any || !of_grains) m = rule.judge(facts);
    else m.ratio = no_number, m.reason = without_grains;
    const auto term = member(rule.term);
    if (!carries(facts.scene.fluid, term)) {
      const bool missed = std::exchange(m.wanted, false);
      m.reason += fmt::format("; models.fluid = \"{}\" does not carry it{}", name_of(facts.scene.fluid),
                              missed ? ": the box would" : "");
    }
    const bool of_model_a = term == &Terms::pressure_gradient || term == &Terms::viscous_stress;
    if (facts.scene.fluid == FluidRung::column && of_model_a && facts.grains.any && !m.wanted)
      m.wanted = true, m.reason += "; the column's balance is that of Model A";
    m.term = rule.term, m.on = facts.scene.terms.*term;
  }
  if (facts.grains.any) models.push_back(rolling_friction(facts));
  return models;
}

ModelChoice fluid_choice(const Scene& scene) {
  constexpr auto by_itself =
      "\"auto\" takes the box: a column only by models.accuracy, where x and y are periodic, the bed is level and a "
      "measured trade shows the difference to be below the accuracy asked for; an imposed profile never";
  const char* what = scene.fluid == FluidRung::box ? "the flow in three dimensions"
                     : scene.fluid == FluidRung::column
                         ? "one velocity at each height, both ways; as the study file or its models.accuracy says"
                         : "an imposed flow, which does not answer to grains; as the study file says";
  return {.term = fmt::format("fluid = {}", name_of(scene.fluid)),
          .on = true,
          .wanted = scene.fluid == FluidRung::box,
          .ratio = no_number,
          .reason = fmt::format("{}; {}", what, by_itself)};
}

std::vector<ModelChoice> decisions_of(const Scene& scene) {
  std::vector<ModelChoice> all = required_models(scene);
  all.insert(all.begin(), fluid_choice(scene));
  return all;
}

Terms wanted_terms(const Scene& scene) {
  Scene blank = scene;
  for (const auto& named : named_terms) blank.terms.*named.term = false;
  Terms wanted = blank.terms;
  for (const auto& m : required_models(blank))
    if (m.wanted) wanted.*member(m.term) = true;
  return wanted;
}

std::vector<std::string> warnings_of(const SceneFacts& facts) {
  std::vector<std::string> warnings;
  for (const auto& problem : range_problems_of(facts)) warnings.push_back(problem.message);
  const bool dry = std::ranges::none_of(named_terms, [&](const NamedTerm& t) { return facts.scene.terms.*t.term; });
  if (dry && facts.grains.any) {
    warnings.push_back(
        "terms = []: the grains are dry; no term joins them to the fluid, which only makes room for them");
    return warnings;
  }
  std::string left_out;
  for (const auto& m : required_models(facts))
    if (m.wanted && !m.on) left_out += (left_out.empty() ? "" : ", ") + with_ratio(m);
  if (!left_out.empty())
    warnings.push_back(
        fmt::format("models.terms leaves out what the rules want, with the ratio that decides: {}", left_out));
  return warnings;
}

}   // namespace bedload

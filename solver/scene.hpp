// Scene: every parameter of one box of fluid and grains, in SI, validated once, never changed by a run.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "solver/bed/flow_ramp.hpp"
#include "solver/fluid/staggered_grid.hpp"
#include "solver/grains/bed_scene.hpp"

namespace bedload {

enum class DragLawName { stokes, schiller_naumann, di_felice, ergun, gidaspow, koch_hill, beetstra, tang, rong };

inline constexpr DragLawName drag_law_names[] = {
    DragLawName::stokes,   DragLawName::schiller_naumann, DragLawName::di_felice, DragLawName::ergun,
    DragLawName::gidaspow, DragLawName::koch_hill,        DragLawName::beetstra,  DragLawName::tang,
    DragLawName::rong};

/// Which forces act between fluid and grains (besides contacts and weight), and what the liquid does to a collision.
struct Terms {
  bool drag = true, buoyancy = true, pressure_gradient = true, viscous_stress = true;
  bool self_disturbance = false;   // a lone grain is freed of the flow that it has set in motion itself
  bool added_mass = false, shear_lift = false, magnus = false, viscous_torque = false;
  bool wall_forces = false;       // factors on drag, lift and torque near plane walls
  bool wet_restitution = false;   // a collision rebounds by its Stokes number...
  bool lubrication = false;       // ...or by the film between the grains: not both
  bool exposure = false;          // more drag on grains that stand out of a bed
  bool turbulence = false;        // eddy viscosity and wall laws
  double crowded = 0.04;   // packing of others from which on nothing of what is right for a lone grain is left [-]
  /// pressure_gradient and viscous_stress are the grains' half of the void fraction in the fluid's equation:
  /// both (Model A) or neither (Model B).
  bool model_b() const { return !pressure_gradient; }
  bool operator==(const Terms&) const = default;
};

/// The terms by the names that study files and the database give them.
struct NamedTerm {
  std::string_view name;
  bool Terms::*term;
};
inline constexpr NamedTerm named_terms[] = {{"drag", &Terms::drag},
                                            {"buoyancy", &Terms::buoyancy},
                                            {"pressure_gradient", &Terms::pressure_gradient},
                                            {"viscous_stress", &Terms::viscous_stress},
                                            {"self_disturbance", &Terms::self_disturbance},
                                            {"added_mass", &Terms::added_mass},
                                            {"shear_lift", &Terms::shear_lift},
                                            {"magnus", &Terms::magnus},
                                            {"viscous_torque", &Terms::viscous_torque},
                                            {"wall_forces", &Terms::wall_forces},
                                            {"wet_restitution", &Terms::wet_restitution},
                                            {"lubrication", &Terms::lubrication},
                                            {"exposure", &Terms::exposure},
                                            {"turbulence", &Terms::turbulence}};

/// How much of the flow is computed: a profile that is imposed and does not answer to grains, one velocity for each height that
/// does, or the flow in three dimensions. The first two have a grid of one cell across.
enum class FluidRung { profile, column, box };
constexpr std::string_view name_of(FluidRung rung) {
  return rung == FluidRung::profile ? "profile" : rung == FluidRung::column ? "column" : "box";
}

/// The fluid before anything has moved.
enum class FluidStart { rest, taylor_green };

/// Width of a further smoothing of whatever passes between grains and grid: standard deviation of the kernel that it is
/// convolved with, across (x and y) and along z [m]; 0 = none.
struct Smoothing {
  double xy = 0, z = 0;
  bool operator==(const Smoothing&) const = default;
};

struct Onset {
  enum class Method { ramp, bisect, none };
  enum class Criterion { flux, moving_fraction };
  Method method = Method::ramp;
  Criterion criterion = Criterion::flux;
  double value = 1e-2;
  double bracket = 0.04;   // of a bisection: upper/lower - 1 at which it ends [-]
  double hold = 0;         // of a bisection: how long a level is held [s]
};

/// What a settled bed goes through before the flow of the study: a Shields number, held for a time, then rest.
struct BedShear {
  double shields = 0;   // [-]
  double time = 0;      // [s]; 0 = none
};

struct Steps {
  double fluid_interval = 0;   // longest fluid step asked for [s]: 10 DEM steps, or the study file's
  bool beyond_limit = false;   // DEM steps of more than 0.3 Rayleigh times are allowed, to measure what they do
};

struct RecordPlan {
  double every = 0;                    // [s]
  std::vector<std::uint64_t> tracks;   // grain ids whose trajectories are kept
};

struct Scene {
  BedScene bed;         // fluid, grains, walls, gravity, DEM step
  StaggeredGrid grid;   // cells of the box; same length, sides and top as bed
  FlowRamp drive;
  bool developed = true;   // each level begins with its steady flow; else with the flow that is there
  FluidStart fluid_start = FluidStart::rest;
  double start_speed = 0;        // of the Taylor-Green vortices [m/s]
  double bottom_roughness = 0;   // k_s of the bottom wall [m]; 0 = smooth
  BedShear shear;
  Onset onset;
  FluidRung fluid = FluidRung::box;
  DragLawName drag = DragLawName::di_felice;
  Terms terms;
  Smoothing smoothing;
  double frozen_depth = 0;   // below the bed's surface, beyond which grains are not moved [m]; 0 = all are
  Steps steps;
  RecordPlan record;
  bool bed_only = false;   // finished once the bed has settled (a bed directory)
};

/// Whether a rung has a term: what is made for the kernel between grains and cells, or for fluid that turns or goes along with
/// single grains, only the box has.
bool carries(FluidRung, bool Terms::*term);

/// Why a scene cannot run: the parameter by its name in a study file, what is wrong with it, the likely fix.
struct SceneProblem {
  std::string parameter, message, hint;
};
std::vector<SceneProblem> problems_of(const Scene&);
/// The same of the grains alone; needs neither their stiffness nor steps.
std::vector<SceneProblem> grain_problems_of(const BedScene&);

/// Refuses a scene that cannot run (ErrorKind::study_invalid), all problems in one message, one per line.
void validate(const Scene&);

}   // namespace bedload

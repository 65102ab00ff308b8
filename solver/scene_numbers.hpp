// The dimensionless numbers of a scene: what the rules for models and the warnings read.
#pragma once

#include <cmath>
#include <limits>

#include "solver/scene.hpp"

namespace bedload {

inline constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// Who the grains are, before anything has moved.
struct GrainCensus {
  bool any = false, mobile = false;   // grains at all; grains that are not fixed
  bool bed = false;                   // of grains that lie on each other
  bool collide = false;               // with each other or with walls
  bool may_turn = false;              // by friction, or because a table gives them spin
  double densest = 0;                 // packing density of the other grains at a grain, the largest [-]
  double loosest = 1;                 // the smallest; 0 above a bed, where grains that leave it go [-]
  double smallest = no_number;        // diameter [m]
  double fastest = 0;                 // speed that a table gives a grain [m/s]
  double fastest_spin = 0;            // that a table gives a grain that is not fixed [rad/s]
  double nearness = 0;                // a/z of a lone grain to the nearest no-slip wall that it has or comes to [-]
};
GrainCensus census_of(const Scene&);

/// nan where a number has no meaning: those of the grains without grains, those of the flow without shear.
struct SceneNumbers {
  double density_ratio = no_number;       // s [-]
  double galileo = no_number;             // Ga [-]
  double grain_time = no_number;          // t_d [s]; only of grains heavier than the fluid
  double settling_speed = no_number;      // of a lone grain, by the scene's drag law [m/s]
  double settling_reynolds = no_number;   // at that speed [-]
  double solid_fraction = 0;              // of the bed, or of the grains in the box [-]
  double bed_depth = 0;                   // expected, in grain diameters [-]
  double gap = 0;                         // that the bed leaves below the top [m]
  double lowest_shields = no_number;      // imposed [-]
  double highest_shields = no_number;
  double shields = no_number;             // at which the numbers of the flow are quoted [-]
  double shear_rate = no_number;          // at the bed or bottom, laminar [1/s]
  double friction_reynolds = no_number;   // Re* [-]
  double shear_reynolds = no_number;      // Re_g [-]
  double flow_speed = no_number;          // laminar: of the lid, or mean over the gap [m/s]
  double gap_reynolds = no_number;        // flow_speed gap/nu [-]
  double lift_per_weight = no_number;     // 1.10 theta Re_g [-]; infinite without submerged weight
  double torque_per_weight = no_number;   // 6 theta [-]; the same
  double shear_per_slip = no_number;   // b = d |omega|/(2 |w|) of a grain at rest at the surface of bed or bottom [-]
  double impact_speed = no_number;     // of a grain that falls, is carried by the shear or thrown by a table [m/s]
  double impact_stokes = no_number;    // at that speed [-]
  double grain_reynolds = no_number;   // the largest slip that a grain is expected to see, at the highest level [-]
  double self_response = no_number;    // kappa: share of a lone grain's own drag that comes back to it as flow [-]
};

/// An unresolved laminar bed begins to move near theta = 0.2 (mean-field estimate 0.19-0.21): what depends on the flow is
/// quoted there, or at the first level if that is higher, whatever the ramp's end, so that a longer ramp gets the same
/// answer. Where no bed can move, the first level counts.
inline constexpr double quoted_shields = 0.2;

SceneNumbers numbers_of(const Scene&, const GrainCensus&);
inline SceneNumbers numbers_of(const Scene& scene) { return numbers_of(scene, census_of(scene)); }

/// What rules and range checks read, found once: a scene stands for its facts wherever they are asked for, and who asks twice
/// makes them first. The scene must outlive them.
struct SceneFacts {
  SceneFacts(const Scene& of) : scene(of), grains(census_of(of)), n(numbers_of(of, grains)) {}
  const Scene& scene;
  GrainCensus grains;
  SceneNumbers n;

  double diameter() const { return scene.bed.grains.diameter; }
  double viscosity() const { return scene.bed.fluid.viscosity; }
  double edge() const { return std::cbrt(scene.grid.cell_volume()); }
  /// Grains in a flow that shears the box.
  bool sheared() const { return grains.any && !std::isnan(n.shear_rate); }
  bool sheared_bed() const { return grains.bed && sheared(); }
};

/// True where a flow shears the box between bottom and top.
bool is_sheared(const Scene&);

/// Reynolds number of the gap above which its flow may stay turbulent: of a lid's speed 1300, of a mean speed 1500.
double turbulent_gap(const Scene&);
/// Re* up to which a bed is hydraulically smooth.
inline constexpr double smooth_bed_reynolds = 5;
/// What the flow of the gap would be, by its Reynolds number.
enum class GapFlow {
  laminar,           // up to turbulent_gap, or nothing shears the box
  over_smooth_bed,   // turbulent beyond it, over grains that the viscous sublayer covers: Re* up to smooth_bed_reynolds
  turbulent,         // over grains that reach out of it, or over a bare bottom
  enclosed           // beyond it, with walls across: a cavity, for which the limits of channels are not made
};
GapFlow gap_flow(const Scene&, const SceneNumbers&);

}   // namespace bedload

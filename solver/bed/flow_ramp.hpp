// The flow that a case imposes: a staircase of holds, each held for one dwell.
#pragma once

#include <cstdint>
#include <vector>

namespace bedload {

/// One staircase. Level k is held for `dwell` seconds, then level k+1 begins.
struct FlowRamp {
  /// What is moved: the lid; the fluid, by a pressure gradient along x; the grains, by a force along x at their centres;
  /// all fluid and grains of a box without bottom and top, by a net volume flux along z.
  enum class Kind { none, lid, pressure, push, through_flow };
  /// What the levels count: [-], [m/s], [Pa/m], force per submerged weight [-], volume flux per area [m/s].
  enum class Quantity { shields, lid_speed, gradient, push, through_flow };
  Kind kind = Kind::none;
  Quantity quantity = Quantity::shields;
  std::vector<double> levels;
  double dwell = 0;   // [s]
};

/// What one hold does to the box (numerics: "Shields number imposed").
struct ImposedFlow {
  double shields = 0;        // nominal [-]
  double lid_speed = 0;      // [m/s]
  double gradient = 0;       // driving force per mass of fluid along x, G [m/s2]
  double push = 0;           // force along x on each grain, per submerged weight [-]
  double through_flow = 0;   // volume flux along z per area [m/s]
};

struct Scene;
struct FluidProperties;
struct GrainProperties;

/// The stress that makes a Shields number of one: (rho_p - rho_f) g d [Pa].
double shields_stress(const FluidProperties&, const GrainProperties&, double gravity);

/// The lid speed and gradient that level `hold` means over a bed whose surface is at z_b [m].
/// Lid: tau_b = rho_f nu U/(H - z_b), with turbulence that of turbulent_flow(). Pressure: tau_b = rho_f G (H - z_b), half of it under a lid at rest.
/// Refuses (study_invalid) a bed that fills its box.
ImposedFlow imposed_flow(const Scene&, std::uint64_t hold, double bed_height);
/// The same for a level that need not be one of the ramp's.
ImposedFlow imposed_level(const Scene&, double level, double bed_height);

/// What a change of the imposed flow adds, once steady, to the velocity at height z above a bed of height z_b [m/s]:
/// linear under a lid, parabolic under a gradient (no stress at a free-slip top, no slip at a lid), nothing below z_b.
double steady_increment(const Scene&, const ImposedFlow& change, double bed_height, double z);

/// u* [m/s] that a flow, once steady, has at the bed; for scenes with turbulence.
double friction_speed_of(const Scene&, const ImposedFlow&, double bed_height);

}   // namespace bedload

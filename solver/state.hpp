// State: the whole memory of a run.
#pragma once

#include <cstdint>
#include <string>

#include "solver/bed/bed_record.hpp"
#include "solver/fluid/fluid_state.hpp"
#include "solver/grains/contact_history.hpp"
#include "solver/grains/grains.hpp"

namespace bedload {

struct Clock {
  std::uint64_t step = 0;   // fluid steps (while packing: intervals) done; never decreases, names the checkpoint files
  double time = 0;          // [s] since the ramp began; while packing since pouring began
  bool operator==(const Clock&) const = default;
};

/// Where the experiment stands, and the sums of the hold under way.
struct Search {
  enum Phase : std::uint64_t { packing = 0, holding = 1, finished = 2 };
  std::uint64_t phase = packing;
  std::uint64_t hold = 0;              // index of the hold under way
  std::uint64_t hold_begun = 0;        // 1 once this hold's flow has been imposed
  double hold_start = 0;               // [s]
  double bed_height = 0;               // z_b when the hold began [m]
  double lid_speed = 0;                // imposed now [m/s]
  double gradient = 0;                 // imposed now [m/s2]
  double next_sample = 0;              // [s]
  // over the last half of the hold:
  double events = 0;                   // downstream displacements past d/2 [-]
  double events_squared = 0;           // sum over blocks, for the standard error [-]
  double block_events = 0;             // events of the block under way
  double blocks = 0;                   // finished blocks
  double moving_time = 0;              // integral of the moving fraction [s]
  double force_time = 0;               // integral of horizontal force on grains + bottom wall [N s]
  double fluid_momentum_start = 0;     // of the fluid below z_b when the last half began [kg m/s]
  double averaged_time = 0;            // length of the last half so far [s]
  double residual_time = 0;            // integral of |momentum residual| [N s]
  double sample_events = 0;            // events since the last sample
  bool operator==(const Search&) const = default;
};

/// The whole memory of a run. A quantity belongs here exactly when a step reads what an earlier step wrote.
struct State {
  Clock clock;
  FluidState fluid;
  Grains grains;
  ContactHistory contacts;
  Search search;
  BedRecord record;

  bool operator==(const State&) const = default;

  /// Visits every field in a fixed order as visit(name, array or number, unit). Serves save, load, equality, digest,
  /// inspect. Kinds of field: double, std::uint64_t, Field<Where>, and std::vector of double, Vec3, uint8_t, uint32_t.
  template <class Self, class Visit>
  static void each_field(Self& s, Visit&& visit);
};

template <class Self, class Visit>
void State::each_field(Self& s, Visit&& visit) {
  visit("clock/step", s.clock.step, "1");
  visit("clock/time", s.clock.time, "s");

  visit("fluid/u", s.fluid.velocity.x, "m/s");
  visit("fluid/v", s.fluid.velocity.y, "m/s");
  visit("fluid/w", s.fluid.velocity.z, "m/s");
  visit("fluid/pressure", s.fluid.pressure, "m2/s2");

  visit("grains/position", s.grains.position, "m");
  visit("grains/velocity", s.grains.velocity, "m/s");
  visit("grains/spin", s.grains.spin, "rad/s");
  visit("grains/diameter", s.grains.diameter, "m");
  visit("grains/density", s.grains.density, "kg/m3");
  visit("grains/fixed", s.grains.fixed, "1");
  visit("grains/mean_contact_force", s.grains.mean_contact_force, "N");
  visit("grains/travel", s.grains.travel, "m");

  visit("contacts/lower", s.contacts.lower, "1");
  visit("contacts/higher", s.contacts.higher, "1");
  visit("contacts/spring", s.contacts.spring, "m");

  visit("search/phase", s.search.phase, "1");
  visit("search/hold", s.search.hold, "1");
  visit("search/hold_begun", s.search.hold_begun, "1");
  visit("search/hold_start", s.search.hold_start, "s");
  visit("search/bed_height", s.search.bed_height, "m");
  visit("search/lid_speed", s.search.lid_speed, "m/s");
  visit("search/gradient", s.search.gradient, "m/s2");
  visit("search/next_sample", s.search.next_sample, "s");
  visit("search/events", s.search.events, "1");
  visit("search/events_squared", s.search.events_squared, "1");
  visit("search/block_events", s.search.block_events, "1");
  visit("search/blocks", s.search.blocks, "1");
  visit("search/moving_time", s.search.moving_time, "s");
  visit("search/force_time", s.search.force_time, "N s");
  visit("search/fluid_momentum_start", s.search.fluid_momentum_start, "kg m/s");
  visit("search/averaged_time", s.search.averaged_time, "s");
  visit("search/residual_time", s.search.residual_time, "N s");
  visit("search/sample_events", s.search.sample_events, "1");

  auto& p = s.record.samples;
  visit("record/samples/time", p.time, "s");
  visit("record/samples/hold", p.hold, "1");
  visit("record/samples/shields_nominal", p.shields_nominal, "1");
  visit("record/samples/shields_measured", p.shields_measured, "1");
  visit("record/samples/bed_height", p.bed_height, "m");
  visit("record/samples/roughness", p.roughness, "m");
  visit("record/samples/coordination", p.coordination, "1");
  visit("record/samples/flux", p.flux, "1");
  visit("record/samples/moving_fraction", p.moving_fraction, "1");
  visit("record/samples/mean_grain_speed", p.mean_grain_speed, "m/s");
  visit("record/samples/deepest_overlap", p.deepest_overlap, "1");
  visit("record/samples/momentum_residual", p.momentum_residual, "1");

  auto& h = s.record.holds;
  visit("record/holds/hold", h.hold, "1");
  visit("record/holds/start", h.start, "s");
  visit("record/holds/end", h.end, "s");
  visit("record/holds/shields_nominal", h.shields_nominal, "1");
  visit("record/holds/shields_measured", h.shields_measured, "1");
  visit("record/holds/lid_speed", h.lid_speed, "m/s");
  visit("record/holds/gradient", h.gradient, "m/s2");
  visit("record/holds/flux", h.flux, "1");
  visit("record/holds/flux_standard_error", h.flux_standard_error, "1");
  visit("record/holds/moving_fraction", h.moving_fraction, "1");
  visit("record/holds/bed_height", h.bed_height, "m");
  visit("record/holds/roughness", h.roughness, "m");
  visit("record/holds/porosity", h.porosity, "1");
  visit("record/holds/coordination", h.coordination, "1");
  visit("record/holds/momentum_residual", h.momentum_residual, "1");

  auto& b = s.record.profiles;
  visit("record/profiles/hold", b.hold, "1");
  visit("record/profiles/z", b.z, "m");
  visit("record/profiles/porosity", b.porosity, "1");
  visit("record/profiles/fluid_velocity", b.fluid_velocity, "m/s");
  visit("record/profiles/grain_velocity", b.grain_velocity, "m/s");

  auto& t = s.record.tracks;
  visit("record/tracks/time", t.time, "s");
  visit("record/tracks/grain", t.grain, "1");
  visit("record/tracks/x", t.x, "m");
  visit("record/tracks/y", t.y, "m");
  visit("record/tracks/z", t.z, "m");
  visit("record/tracks/vx", t.vx, "m/s");
  visit("record/tracks/vy", t.vy, "m/s");
  visit("record/tracks/vz", t.vz, "m/s");

  // A new member of State changes one of these sizes: list it above, then here.
  static_assert(sizeof(Clock) == 2 * 8 && sizeof(Search) == 18 * 8);
  static_assert(sizeof(FluidState) == 4 * sizeof(Field<Centre>));
  static_assert(sizeof(Grains) == 8 * sizeof(std::vector<Vec3>) && sizeof(ContactHistory) == 3 * sizeof(std::vector<Vec3>));
  static_assert(sizeof(BedRecord) == (12 + 15 + 5 + 8) * sizeof(std::vector<double>));
}

/// SHA-256 over each_field: name, unit, shape, little-endian bytes of the interior. Hexadecimal.
std::string state_digest(const State&);

/// Moves by hand when the same input gives other results; the changelog says why.
inline constexpr int physics_version = 1;

}  // namespace bedload

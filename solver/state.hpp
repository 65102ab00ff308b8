// State: the whole memory of a run.
#pragma once

#include <cstdint>
#include <string>

#include "solver/bed/bed_profiles.hpp"
#include "solver/bed/bed_record.hpp"
#include "solver/bed/grain_hops.hpp"
#include "solver/fluid/fluid_state.hpp"
#include "solver/grains/contact_history.hpp"
#include "solver/grains/grains.hpp"

namespace bedload {

struct Clock {
  std::uint64_t step = 0;    // fluid steps (while packing: intervals) done; never decreases, names the checkpoint files
  double time = 0;           // [s] since the ramp began, negative before; while packing since grains were let go
  double longest_step = 0;   // ceiling of the fluid step since one had to be retried [s]; 0 = none
  std::uint64_t good_steps = 0;   // since the ceiling last changed
  std::uint64_t retries = 0;      // steps undone and taken again shorter, in all
  bool operator==(const Clock&) const = default;
};

/// Sums over a stretch of a hold: what a row of the record is made of.
struct Window {
  double duration = 0;             // so far [s]; 0 = not begun
  double events = 0;               // times a grain passed another d/2 downstream [-]
  double moving_time = 0;          // integral of the moving fraction [s]
  double bed_impulse = 0;          // integral of the horizontal force of the fluid on grains and bottom [N s]
  double lid_impulse = 0;          // integral of the horizontal force on the fluid by lid and drive [N s]
  double outer_impulse = 0;        // integral of all horizontal forces from outside on fluid and grains [N s]
  double bed_fluid_momentum = 0;   // of the fluid below z_b when the window began [kg m/s]
  double momentum = 0;             // of all fluid and grains when the window began [kg m/s]
  bool operator==(const Window&) const = default;
};

/// Where the experiment stands, and the sums of the hold under way.
struct Search {
  enum Phase : std::uint64_t { packing = 0, holding = 1, finished = 2 };
  std::uint64_t phase = packing;
  std::uint64_t hold = 0;            // index of the hold under way
  std::uint64_t hold_begun = 0;      // 1 once this hold's flow has been imposed
  std::uint64_t purpose = 0;         // of this hold: a HoldPurpose
  double level = 0;                  // asked for, in the quantity of the drive
  double duration = 0;               // [s]
  double hold_start = 0;             // [s]
  double bed_height = 0;             // z_b when the hold began [m]
  double shields = 0;                // nominal, imposed now [-]
  double lid_speed = 0;              // imposed now [m/s]
  double gradient = 0;               // imposed now [m/s2]
  double push = 0;                   // imposed now, per submerged weight [-]
  double through_flow = 0;           // imposed now [m/s]
  double next_sample = 0;            // [s]
  Window half;                       // the last half of the hold
  Window sample;                     // since the last sample
  HoldHealth health;                 // of the steps of the hold
  double blocks = 0;                 // finished parts of the last half [-]
  double block_events = 0;           // events of the part under way [-]
  double block_events_squared = 0;   // sum over finished parts, for the standard error [-]
  HopSums hops;                      // of the last half of the hold
  ProfileSums profiles;              // of the last half of the hold
  bool operator==(const Search&) const = default;
};

/// The whole memory of a run. A quantity belongs here exactly when a step reads what an earlier step wrote.
struct State {
  Clock clock;
  FluidState fluid;
  Grains grains;
  ContactHistory contacts;
  ContactHistory asleep;   // contacts between grains that are frozen (bed/frozen_grains)
  GrainHops hops;          // of the hold under way; empty before the first
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
  visit("clock/longest_step", s.clock.longest_step, "s");
  visit("clock/good_steps", s.clock.good_steps, "1");
  visit("clock/retries", s.clock.retries, "1");

  visit("fluid/u", s.fluid.velocity.x, "m/s");
  visit("fluid/v", s.fluid.velocity.y, "m/s");
  visit("fluid/w", s.fluid.velocity.z, "m/s");
  visit("fluid/pressure", s.fluid.pressure, "m2/s2");
  visit("fluid/column_gradient", s.fluid.column_gradient, "m/s2");

  visit("grains/position", s.grains.position, "m");
  visit("grains/velocity", s.grains.velocity, "m/s");
  visit("grains/spin", s.grains.spin, "rad/s");
  visit("grains/diameter", s.grains.diameter, "m");
  visit("grains/density", s.grains.density, "kg/m3");
  visit("grains/fixed", s.grains.fixed, "1");
  visit("grains/mean_contact_force", s.grains.mean_contact_force, "N");
  visit("grains/mean_contact_torque", s.grains.mean_contact_torque, "N m");
  visit("grains/travel", s.grains.travel, "m");
  visit("grains/moved", s.grains.moved, "1");

  visit("contacts/lower", s.contacts.lower, "1");
  visit("contacts/higher", s.contacts.higher, "1");
  visit("contacts/spring", s.contacts.spring, "m");
  visit("contacts/damping", s.contacts.damping, "1");
  visit("contacts/rolling", s.contacts.rolling, "rad");

  visit("asleep/lower", s.asleep.lower, "1");
  visit("asleep/higher", s.asleep.higher, "1");
  visit("asleep/spring", s.asleep.spring, "m");
  visit("asleep/damping", s.asleep.damping, "1");
  visit("asleep/rolling", s.asleep.rolling, "rad");

  visit("hops/resting", s.hops.resting, "1");
  visit("hops/last_fast", s.hops.last_fast, "s");
  visit("hops/left_rest", s.hops.left_rest, "s");
  visit("hops/way", s.hops.way, "m");
  visit("hops/way_when_fast", s.hops.way_when_fast, "m");

  visit("search/phase", s.search.phase, "1");
  visit("search/hold", s.search.hold, "1");
  visit("search/hold_begun", s.search.hold_begun, "1");
  visit("search/purpose", s.search.purpose, "1");
  visit("search/level", s.search.level, "1");
  visit("search/duration", s.search.duration, "s");
  visit("search/hold_start", s.search.hold_start, "s");
  visit("search/bed_height", s.search.bed_height, "m");
  visit("search/shields", s.search.shields, "1");
  visit("search/lid_speed", s.search.lid_speed, "m/s");
  visit("search/gradient", s.search.gradient, "m/s2");
  visit("search/push", s.search.push, "1");
  visit("search/through_flow", s.search.through_flow, "m/s");
  visit("search/next_sample", s.search.next_sample, "s");
  visit("search/half/duration", s.search.half.duration, "s");
  visit("search/half/events", s.search.half.events, "1");
  visit("search/half/moving_time", s.search.half.moving_time, "s");
  visit("search/half/bed_impulse", s.search.half.bed_impulse, "N s");
  visit("search/half/lid_impulse", s.search.half.lid_impulse, "N s");
  visit("search/half/outer_impulse", s.search.half.outer_impulse, "N s");
  visit("search/half/bed_fluid_momentum", s.search.half.bed_fluid_momentum, "kg m/s");
  visit("search/half/momentum", s.search.half.momentum, "kg m/s");
  visit("search/sample/duration", s.search.sample.duration, "s");
  visit("search/sample/events", s.search.sample.events, "1");
  visit("search/sample/moving_time", s.search.sample.moving_time, "s");
  visit("search/sample/bed_impulse", s.search.sample.bed_impulse, "N s");
  visit("search/sample/lid_impulse", s.search.sample.lid_impulse, "N s");
  visit("search/sample/outer_impulse", s.search.sample.outer_impulse, "N s");
  visit("search/sample/bed_fluid_momentum", s.search.sample.bed_fluid_momentum, "kg m/s");
  visit("search/sample/momentum", s.search.sample.momentum, "kg m/s");
  HoldHealth::each(s.search.health, [&](const char* name, auto& measure, const char* unit) {
    visit((std::string("search/health/") + name).c_str(), measure, unit);
  });
  visit("search/blocks", s.search.blocks, "1");
  visit("search/block_events", s.search.block_events, "1");
  visit("search/block_events_squared", s.search.block_events_squared, "1");

  auto& c = s.search.hops;
  visit("search/hops/entrained", c.entrained, "1");
  visit("search/hops/deposited", c.deposited, "1");
  visit("search/hops/hop_length/sum", c.hop_length.sum, "m");
  visit("search/hops/hop_length/squares", c.hop_length.squares, "m2");
  visit("search/hops/hop_length/histogram", c.hop_length.histogram, "1");
  visit("search/hops/hop_duration/sum", c.hop_duration.sum, "s");
  visit("search/hops/hop_duration/squares", c.hop_duration.squares, "s2");
  visit("search/hops/hop_duration/histogram", c.hop_duration.histogram, "1");
  visit("search/hops/rest_time/sum", c.rest_time.sum, "s");
  visit("search/hops/rest_time/squares", c.rest_time.squares, "s2");
  visit("search/hops/rest_time/histogram", c.rest_time.histogram, "1");

  auto& f = s.search.profiles;
  visit("search/profiles/instants", f.instants, "1");
  visit("search/profiles/solid", f.solid, "m3");
  visit("search/profiles/motion", f.motion, "m4/s");
  visit("search/profiles/squares", f.squares, "m5/s2");
  visit("search/profiles/fluid_velocity", f.fluid_velocity, "m/s");

  visit("record/settled/solid_fraction", s.record.settled.solid_fraction, "1");
  visit("record/settled/coordination", s.record.settled.coordination, "1");
  visit("record/settled/shear_flux", s.record.settled.shear_flux, "1");

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
  visit("record/samples/moved_grains", p.moved_grains, "1");
  visit("record/samples/moving_speed", p.moving_speed, "m/s");
  visit("record/samples/deepest_overlap", p.deepest_overlap, "1");
  visit("record/samples/momentum_residual", p.momentum_residual, "1");

  auto& h = s.record.holds;
  visit("record/holds/hold", h.hold, "1");
  visit("record/holds/purpose", h.purpose, "1");
  visit("record/holds/level", h.level, "1");
  visit("record/holds/verdict", h.verdict, "1");
  visit("record/holds/start", h.start, "s");
  visit("record/holds/end", h.end, "s");
  visit("record/holds/shields_nominal", h.shields_nominal, "1");
  visit("record/holds/shields_measured", h.shields_measured, "1");
  visit("record/holds/lid_speed", h.lid_speed, "m/s");
  visit("record/holds/gradient", h.gradient, "m/s2");
  visit("record/holds/shields_lid", h.shields_lid, "1");
  visit("record/holds/stress_residual", h.stress_residual, "1");
  visit("record/holds/flux", h.flux, "1");
  visit("record/holds/flux_standard_error", h.flux_standard_error, "1");
  visit("record/holds/moving_fraction", h.moving_fraction, "1");
  visit("record/holds/moved_grains", h.moved_grains, "1");
  visit("record/holds/bed_height", h.bed_height, "m");
  visit("record/holds/bed_top", h.bed_top, "m");
  visit("record/holds/slope", h.slope, "1");
  visit("record/holds/roughness", h.roughness, "m");
  visit("record/holds/porosity", h.porosity, "1");
  visit("record/holds/coordination", h.coordination, "1");
  visit("record/holds/bearing_coordination", h.bearing_coordination, "1");
  visit("record/holds/momentum_residual", h.momentum_residual, "1");

  visit("record/health/hold", s.record.health.hold, "1");
  BedRecord::Health::Measures::each(s.record.health.measures, [&](const char* name, auto& column, const char* unit) {
    visit((std::string("record/health/") + name).c_str(), column, unit);
  });

  auto& m = s.record.hops;
  visit("record/hops/hold", m.hold, "1");
  visit("record/hops/duration", m.duration, "s");
  visit("record/hops/entrained", m.entrained, "1");
  visit("record/hops/deposited", m.deposited, "1");
  visit("record/hops/hops", m.hops, "1");
  visit("record/hops/hop_length", m.hop_length, "m");
  visit("record/hops/hop_length_deviation", m.hop_length_deviation, "m");
  visit("record/hops/hop_duration", m.hop_duration, "s");
  visit("record/hops/hop_duration_deviation", m.hop_duration_deviation, "s");
  visit("record/hops/rests", m.rests, "1");
  visit("record/hops/rest_time", m.rest_time, "s");
  visit("record/hops/rest_time_deviation", m.rest_time_deviation, "s");

  auto& e = s.record.hop_histograms;
  visit("record/hop_histograms/hold", e.hold, "1");
  visit("record/hop_histograms/lower", e.lower, "1");
  visit("record/hop_histograms/by_length", e.by_length, "1");
  visit("record/hop_histograms/by_duration", e.by_duration, "1");
  visit("record/hop_histograms/rests", e.rests, "1");

  auto& b = s.record.profiles;
  visit("record/profiles/hold", b.hold, "1");
  visit("record/profiles/z", b.z, "m");
  visit("record/profiles/porosity", b.porosity, "1");
  visit("record/profiles/fluid_velocity", b.fluid_velocity, "m/s");
  visit("record/profiles/grain_velocity", b.grain_velocity, "m/s");
  visit("record/profiles/granular_temperature", b.granular_temperature, "m2/s2");

  auto& t = s.record.tracks;
  visit("record/tracks/time", t.time, "s");
  visit("record/tracks/grain", t.grain, "1");
  visit("record/tracks/x", t.x, "m");
  visit("record/tracks/y", t.y, "m");
  visit("record/tracks/z", t.z, "m");
  visit("record/tracks/vx", t.vx, "m/s");
  visit("record/tracks/vy", t.vy, "m/s");
  visit("record/tracks/vz", t.vz, "m/s");
  visit("record/tracks/wx", t.wx, "rad/s");
  visit("record/tracks/wy", t.wy, "rad/s");
  visit("record/tracks/wz", t.wz, "rad/s");

  // A new member of State changes one of these sizes: list it above, then here.
  static_assert(sizeof(Clock) == 5 * 8 && sizeof(Window) == 8 * 8 && sizeof(HoldHealth) == 20 * 8 &&
                sizeof(Search) ==
                    17 * 8 + 2 * sizeof(Window) + sizeof(HoldHealth) + sizeof(HopSums) + sizeof(ProfileSums));
  static_assert(sizeof(ProfileSums) == 8 + 4 * sizeof(std::vector<double>) &&
                sizeof(HopSums) == 2 * 8 + 3 * (2 * 8 + sizeof(std::vector<double>)) &&
                sizeof(GrainHops) == 5 * sizeof(std::vector<double>));
  static_assert(sizeof(FluidState) == 4 * sizeof(Field<Centre>) + 8);
  static_assert(sizeof(Grains) == 10 * sizeof(std::vector<Vec3>) &&
                sizeof(ContactHistory) == 5 * sizeof(std::vector<Vec3>));
  static_assert(sizeof(BedRecord) == 3 * 8 + (13 + 24 + 21 + 12 + 5 + 6 + 11) * sizeof(std::vector<double>));
}

/// SHA-256 over each_field: name, unit, shape, little-endian bytes of the interior. Hexadecimal.
std::string state_digest(const State&);

/// Moves by hand when the same input gives other results; the changelog says why.
inline constexpr int physics_version = 9;

}   // namespace bedload

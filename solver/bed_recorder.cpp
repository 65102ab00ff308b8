// Sums over windows of a hold, and the rows made of them.
#include "solver/bed_recorder.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "solver/bed/bed_profiles.hpp"
#include "solver/bed/bed_surface.hpp"
#include "solver/bed/frozen_grains.hpp"
#include "solver/bed/incipient_motion.hpp"
#include "solver/coupling/drag_laws.hpp"
#include "solver/dimensionless.hpp"
#include "solver/grains/slice_volume.hpp"

namespace bedload {

namespace {

constexpr double blocks_per_half = 5;      // for the standard error of the flux: each a few grain times long
constexpr double instants_per_half = 64;   // of the profiles: under a grain time apart, yet a small part of the steps
constexpr double not_known =
    -1;   // a residual where walls or fixed grains take part unseen, or an imposed flow; a speed where nothing moves

double density_ratio(const Scene& scene) { return scene.bed.grains.density / scene.bed.fluid.density; }

double speed_scale_of(const Scene& scene) {
  const double weight = reduced_gravity(density_ratio(scene), norm(scene.bed.gravity));
  return std::sqrt(weight * scene.bed.grains.diameter);
}

double grain_time_of(const Scene& scene) {
  const double d = scene.bed.grains.diameter, s = density_ratio(scene), g = norm(scene.bed.gravity);
  const double fall = s > 1 && g > 0 ? terminal_speed(scene.drag, scene.bed.fluid.viscosity, s, d, g) : 0;
  return grain_time(d, s, g, fall);
}

void add(const StepHealth& step, HoldHealth& hold) {
  const auto worst = [](double& sum, double value) { sum = std::max(sum, value); };
  hold.shortest_step = hold.steps > 0 ? std::min(hold.shortest_step, step.dt) : step.dt;
  hold.steps += 1;
  worst(hold.longest_step, step.dt);
  hold.retries += step.retries;
  worst(hold.cfl, std::max(step.cfl, step.cfl_after));
  worst(hold.deepest_overlap, step.deepest_overlap);
  worst(hold.grain_travel, step.grain_travel);
  worst(hold.divergence, step.divergence);
  worst(hold.divergence_left, step.divergence_left);
  hold.void_clamps += double(step.void_clamps);
  hold.face_clamps += double(step.face_clamps);
  hold.disturbance_clamps += double(step.disturbance_clamps);
  hold.lift_clamps += double(step.lift_clamps);
  worst(hold.pressure_iterations, step.pressure_iterations);
  worst(hold.drag_iterations, step.drag_iterations);
  hold.limited_by_cfl += step.limited_by == StepLimit::cfl;
  hold.limited_by_drag += step.limited_by == StepLimit::drag;
  hold.limited_by_travel += step.limited_by == StepLimit::travel;
  hold.limited_by_contact += step.limited_by == StepLimit::contact;
  hold.limited_by_weight += step.limited_by == StepLimit::weight;
}

void append(double hold, HoldHealth health, BedRecord::Health& rows) {
  rows.hold.push_back(hold);
  std::vector<std::vector<double>*> columns;
  BedRecord::Health::Measures::each(rows.measures, [&](auto, auto& column, auto) { columns.push_back(&column); });
  HoldHealth::each(health, [&, n = 0u](auto, double measure, auto) mutable { columns[n++]->push_back(measure); });
}

}   // namespace

BedRecorder::BedRecorder(const Scene& scene)
    : scene_(scene),
      area_(scene.bed.length.x * scene.bed.length.y),
      stress_scale_(shields_stress(scene.bed.fluid, scene.bed.grains, norm(scene.bed.gravity))),
      speed_scale_(speed_scale_of(scene)),
      surface_grains_(surface_grains(scene)),
      grain_time_(grain_time_of(scene)),
      momentum_of_(scene) {}

void BedRecorder::begin_hold(State& state) const {
  Search& search = state.search;
  search.hold_start = state.clock.time;
  search.next_sample = search.hold_start + scene_.record.every;
  search.half = search.sample = {};
  search.health = {};
  search.blocks = search.block_events = search.block_events_squared = 0;
  search.hops = {};
  search.profiles = {};
  std::fill(state.grains.travel.begin(), state.grains.travel.end(), 0.0);
  std::fill(state.grains.moved.begin(), state.grains.moved.end(), std::uint8_t(0));
  begin_hops(state.grains, search.hold_start, rest_rule(), state.hops);
}

RestRule BedRecorder::rest_rule() const { return {slow_speed(), grain_time_, scene_.bed.grains.diameter}; }

void BedRecorder::before_step(State& state) {
  Search& search = state.search;
  in_last_half_ = state.clock.time - search.hold_start >= search.duration / 2;
  const bool open_half = in_last_half_ && search.half.duration == 0, open_sample = search.sample.duration == 0;
  if (open_half || open_sample) {
    const StreamwiseMomentum now = momentum_of_(state, search.bed_height);
    const Window opened{.bed_fluid_momentum = now.fluid_below, .momentum = now.total};
    if (open_half) search.half = opened;
    if (open_sample) search.sample = opened;
  }
  time_before_ = state.clock.time;
  x_before_.resize(state.grains.size());
  for (std::size_t p = 0; p < x_before_.size(); ++p) x_before_[p] = state.grains.position[p].x;
}

bool BedRecorder::after_step(State& state, const StepHealth& health, const StepBooks& books) {
  Search& search = state.search;
  const double period = scene_.grid.periodic(0) ? scene_.bed.length.x : 0;
  const double events = double(count_events(state.grains, x_before_, period, scene_.bed.grains.diameter));
  const double moving = double(count_moving(state.grains, speed_scale_)) / surface_grains_;
  if (grain_time_ > 0)
    follow_hops(state.grains, x_before_, period, time_before_, state.clock.time, rest_rule(), state.hops,
                in_last_half_ ? &search.hops : nullptr);
  const double on_bed = books.on_grains.x + books.on_bottom.x, outer = outer_force(state, books);
  const auto add_to = [&](Window& window) {
    window.duration += health.dt;
    window.events += events;
    window.moving_time += moving * health.dt;
    window.bed_impulse += on_bed * health.dt;
    window.lid_impulse += (books.driving.x - books.on_lid.x) * health.dt;
    window.outer_impulse += outer * health.dt;
  };
  add_to(search.sample);
  if (in_last_half_) {
    add_to(search.half);
    search.block_events += events;
    close_block(state);
    const double spacing = search.duration / 2 / instants_per_half;
    if (state.clock.time >= search.hold_start + search.duration / 2 + (search.profiles.instants + 1) * spacing)
      add_profile(state, search.profiles);
  }
  add(health, search.health);
  const bool sampled = state.clock.time >= search.next_sample;
  if (sampled) record_sample(state, health);
  return sampled;
}

/// The last half is cut into blocks whose scatter gives the standard error of its flux.
void BedRecorder::close_block(State& state) const {
  Search& search = state.search;
  const double half = search.duration / 2, into_half = state.clock.time - search.hold_start - half;
  const bool over = state.clock.time - search.hold_start >= search.duration;
  if (!over && into_half < (search.blocks + 1) * half / blocks_per_half) return;
  search.blocks += 1;
  search.block_events_squared += search.block_events * search.block_events;
  search.block_events = 0;
}

/// Horizontal force from outside on fluid and grains: drive, tilted weight and push, less what bottom, lid and walls take
/// up [N].
double BedRecorder::outer_force(const State& state, const StepBooks& books) const {
  const Grains& grains = state.grains;
  const Vec3 g = scene_.bed.gravity;
  double on_grains = 0;
  if (g.x != 0 || state.search.push != 0)
    for (std::size_t p = 0; p < grains.size(); ++p) {
      const double lifted = scene_.terms.buoyancy ? scene_.bed.fluid.density : 0;
      const double submerged = (grains.density[p] - lifted) * sphere_volume(grains.diameter[p]);
      on_grains += submerged * (g.x + (grains.fixed[p] ? 0 : state.search.push * norm(g)));
    }
  return books.driving.x + on_grains - books.on_bottom.x - books.on_lid.x - books.contact_on_walls.x;
}

double BedRecorder::flux(double events, double duration) const {
  return grain_time_ > 0 ? events * grain_time_ / (surface_grains_ * duration) : 0;
}

/// Of what drives the mixture, the part below z_b [N]. Of an imposed flow the fluid there stands still and hands nothing on: what remains is
/// what the volume of grains feels, in Model A.
double BedRecorder::driven_below(const State& state) const {
  const Search& search = state.search;
  const double per_volume = scene_.bed.fluid.density * search.gradient;
  if (scene_.fluid != FluidRung::profile || search.gradient == 0) return per_volume * area_ * search.bed_height;
  double solid = 0;
  if (!scene_.terms.model_b())
    for (std::size_t p = 0; p < state.grains.size(); ++p) {
      const double radius = state.grains.diameter[p] / 2;
      solid += slice_volume(radius, -radius, search.bed_height - state.grains.position[p].z);
    }
  return per_volume * solid;
}

/// tau_b A = force on grains + force on the bottom + d/dt of the fluid's momentum below z_b - the drive below z_b.
double BedRecorder::measured_shields(const State& state, const Window& window, const StreamwiseMomentum& now) const {
  if (stress_scale_ <= 0 || scene_.grid.periodic(2)) return 0;
  const double force =
      (window.bed_impulse + now.fluid_below - window.bed_fluid_momentum) / window.duration - driven_below(state);
  return force / (area_ * stress_scale_);
}

/// tau_b A = force of the lid on the fluid + the drive above z_b: what measured_shields is but for the d/dt of the momentum of
/// the fluid above z_b, where that momentum has nowhere else to go; 0 where it has.
double BedRecorder::lid_shields(const State& state, const Window& window) const {
  const StaggeredGrid& grid = scene_.grid;
  const bool seen = scene_.fluid != FluidRung::profile && grid.periodic(0) && grid.periodic(1) && !grid.periodic(2);
  if (!seen || stress_scale_ <= 0) return 0;
  return (window.lid_impulse / window.duration - driven_below(state)) / (area_ * stress_scale_);
}

/// What the momentum of fluid and grains did beyond the forces from outside, in units of a Shields number.
double BedRecorder::momentum_residual(const Grains& grains, const Window& window, const StreamwiseMomentum& now) const {
  const auto& fixed = grains.fixed;
  const bool seen = scene_.fluid != FluidRung::profile && scene_.grid.periodic(0) && scene_.grid.periodic(1) &&
                    scene_.frozen_depth == 0 && std::ranges::all_of(fixed, [](std::uint8_t f) { return f == 0; });
  if (!seen || stress_scale_ <= 0) return not_known;
  return std::abs(now.total - window.momentum - window.outer_impulse) / (window.duration * area_ * stress_scale_);
}

/// Of the grains that move at this instant [m/s].
double mean_moving_speed(const Grains& grains, double slow) {
  double sum = 0;
  std::size_t moving = 0;
  for (const Vec3 v : grains.velocity)
    if (norm(v) > slow) sum += norm(v), ++moving;
  return moving ? sum / double(moving) : not_known;
}

/// Where the bed stands now, and what moves: columns that samples and holds share.
template <class Rows>
void append_bed(const Scene& scene, const State& state, Rows& rows) {
  const BedSurface surface = bed_surface(state.grains, scene.bed.length, scene.bed.grains.diameter);
  rows.hold.push_back(double(state.search.hold));
  rows.shields_nominal.push_back(state.search.shields);
  rows.bed_height.push_back(surface.height);
  rows.moved_grains.push_back(double(count_moved(state.grains)));
  rows.roughness.push_back(surface.roughness);
  const bool whole = state.asleep.size() == 0;
  const ContactHistory joined = whole ? ContactHistory{} : all_contacts(state.contacts, state.asleep);
  const ContactHistory& contacts = whole ? state.contacts : joined;
  rows.coordination.push_back(coordination(contacts, state.grains.fixed));
  if constexpr (requires { rows.porosity; }) {
    rows.porosity.push_back(surface.porosity);
    rows.bed_top.push_back(surface.top);
    rows.slope.push_back(surface.slope);
    rows.bearing_coordination.push_back(bearing_coordination(contacts, state.grains.fixed));
  }
}

void BedRecorder::record_sample(State& state, const StepHealth& health) {
  Search& search = state.search;
  const Window& window = search.sample;
  const StreamwiseMomentum now = momentum_of_(state, search.bed_height);

  BedRecord::Samples& row = state.record.samples;
  append_bed(scene_, state, row);
  row.time.push_back(state.clock.time);
  row.shields_measured.push_back(measured_shields(state, window, now));
  row.flux.push_back(flux(window.events, window.duration));
  row.moving_fraction.push_back(window.moving_time / window.duration);
  row.moving_speed.push_back(mean_moving_speed(state.grains, slow_speed()));
  row.deepest_overlap.push_back(health.deepest_overlap);
  row.momentum_residual.push_back(momentum_residual(state.grains, window, now));
  record_tracks(state);

  search.sample = {};
  while (search.next_sample <= state.clock.time) search.next_sample += scene_.record.every;
}

void BedRecorder::record_tracks(State& state) const {
  BedRecord::Tracks& row = state.record.tracks;
  for (const std::uint64_t id : scene_.record.tracks) {
    const Vec3 x = state.grains.position.at(id), v = state.grains.velocity.at(id), w = state.grains.spin.at(id);
    row.time.push_back(state.clock.time);
    row.grain.push_back(double(id));
    row.x.push_back(x.x), row.y.push_back(x.y), row.z.push_back(x.z);
    row.vx.push_back(v.x), row.vy.push_back(v.y), row.vz.push_back(v.z);
    row.wx.push_back(w.x), row.wy.push_back(w.y), row.wz.push_back(w.z);
  }
}

/// A step of a ramp is judged by the whole ramp; a hold of a search by its own flux.
HoldVerdict BedRecorder::verdict_of(const State& state) const {
  const Search& search = state.search;
  if (search.purpose == std::uint64_t(HoldPurpose::ramp)) return HoldVerdict::none;
  const BedRecord::Samples& samples = state.record.samples;
  const auto first =
      static_cast<std::size_t>(std::ranges::lower_bound(samples.hold, double(search.hold)) - samples.hold.begin());
  const Thirds flux = thirds_of(std::span(samples.time).subspan(first), std::span(samples.flux).subspan(first),
                                search.hold_start, state.clock.time);
  return judge_hold(flux.middle, flux.last, scene_.onset.value);
}

void BedRecorder::close_hold(State& state) {
  Search& search = state.search;
  const Window& window = search.half;
  const StreamwiseMomentum now = momentum_of_(state, search.bed_height);
  const double scatter = search.block_events_squared - window.events * window.events / search.blocks;
  const double error_of_events =
      search.blocks > 1 ? std::sqrt(std::max(0.0, scatter) * search.blocks / (search.blocks - 1)) : 0;

  BedRecord::Holds& row = state.record.holds;
  append_bed(scene_, state, row);
  row.purpose.push_back(double(search.purpose));
  row.level.push_back(search.level);
  row.verdict.push_back(double(verdict_of(state)));
  row.start.push_back(search.hold_start);
  row.end.push_back(state.clock.time);
  row.shields_measured.push_back(measured_shields(state, window, now));
  const double lid = lid_shields(state, window), on_bed = row.shields_measured.back();
  row.shields_lid.push_back(lid);
  row.stress_residual.push_back(lid != 0 && on_bed != 0 ? std::abs(lid / on_bed - 1) : not_known);
  row.lid_speed.push_back(search.lid_speed);
  row.gradient.push_back(search.gradient);
  row.flux.push_back(flux(window.events, window.duration));
  row.flux_standard_error.push_back(flux(error_of_events, window.duration));
  row.moving_fraction.push_back(window.moving_time / window.duration);
  row.momentum_residual.push_back(momentum_residual(state.grains, window, now));
  append(double(search.hold), search.health, state.record.health);
  record_hops(state);
  if (search.profiles.instants == 0) add_profile(state, search.profiles);   // a hold of a step or two
  record_profiles(search.profiles, scene_.bed.length, double(search.hold), state.record.profiles);
}

void BedRecorder::record_hops(State& state) const {
  const double hold = double(state.search.hold);
  const HopSums& sums = state.search.hops;
  BedRecord::Hops& row = state.record.hops;
  row.hold.push_back(hold);
  row.duration.push_back(state.search.half.duration);
  row.entrained.push_back(sums.entrained), row.deposited.push_back(sums.deposited);
  row.hops.push_back(sums.hop_length.count());
  row.hop_length.push_back(sums.hop_length.mean());
  row.hop_length_deviation.push_back(sums.hop_length.standard_deviation());
  row.hop_duration.push_back(sums.hop_duration.mean());
  row.hop_duration_deviation.push_back(sums.hop_duration.standard_deviation());
  row.rests.push_back(sums.rest_time.count());
  row.rest_time.push_back(sums.rest_time.mean());
  row.rest_time_deviation.push_back(sums.rest_time.standard_deviation());
  BedRecord::HopHistograms& bins = state.record.hop_histograms;
  for (std::size_t bin = 0; bin < Spread::bins; ++bin) {
    bins.hold.push_back(hold);
    bins.lower.push_back(Spread::lower_edge(bin));
    bins.by_length.push_back(sums.hop_length.histogram[bin]);
    bins.by_duration.push_back(sums.hop_duration.histogram[bin]);
    bins.rests.push_back(sums.rest_time.histogram[bin]);
  }
}

double BedRecorder::slow_speed() const { return moving_speed(speed_scale_); }

void BedRecorder::record_settled_bed(State& state) const {
  constexpr double before_the_ramp = -1;
  auto& settled = state.record.settled;
  settled.solid_fraction = 1 - bed_surface(state.grains, scene_.bed.length, scene_.bed.grains.diameter).porosity;
  settled.coordination = coordination(state.contacts, state.grains.fixed);
  ProfileSums now;
  add_profile(state, now);
  record_profiles(now, scene_.bed.length, before_the_ramp, state.record.profiles);
}

void BedRecorder::add_profile(const State& state, ProfileSums& sums) const {
  add_instant(state.grains, state.fluid, scene_.grid, scene_.bed.grains.diameter, state.search.lid_speed, sums);
}

}   // namespace bedload

// Packing, then hold after hold: impose the flow, step, record, close. All memory is in State.
#include "solver/experiment.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/random_stream.hpp"
#include "solver/bed/bed_surface.hpp"
#include "solver/bed/frozen_grains.hpp"
#include "solver/bed/incipient_motion.hpp"
#include "solver/bed/onset_search.hpp"
#include "solver/bed/turbulent_flow.hpp"
#include "solver/bed_recorder.hpp"
#include "solver/grains/bed_packing.hpp"
#include "solver/initial_flow.hpp"
#include "solver/step_judgement.hpp"

namespace bedload {
namespace {

/// Brackets of many packings say most of their threshold together where no two end at the same levels.
double own_shift(std::uint64_t seed) { return RandomStream(seed, Stream::onset_level).uniform() - 0.5; }

/// What a coupled step may change, whole, kept to undo it; the record and the sums of the hold are written after it only.
class StateBefore {
 public:
  void keep(const State& state) {
    clock_ = state.clock, fluid_ = state.fluid, grains_ = state.grains, contacts_ = state.contacts;
  }
  void restore(State& state) const {
    state.clock = clock_, state.fluid = fluid_, state.grains = grains_, state.contacts = contacts_;
  }

 private:
  Clock clock_;
  FluidState fluid_;
  Grains grains_;
  ContactHistory contacts_;
};

/// What a flow finds before anything has moved.
struct SettledBed {
  Grains grains;
  ContactHistory contacts;
};

constexpr double usual_holds = 14;   // of a search, stirs counted by their length

}   // namespace

struct Experiment::Parts {
  explicit Parts(const Scene& given)
      : scene(given), coupler(given), recorder(given), packing(std::make_unique<BedPacking>(given.bed)) {}

  const Scene scene;
  Coupler coupler;
  BedRecorder recorder;
  std::unique_ptr<BedPacking> packing;
  StateBefore before;   // scratch of coupled_step
  SettledBed settled;   // where a search begins its holds

  std::optional<PlannedHold> next_hold(const BedRecord&) const;
  void start(State&);
  void start_shear(State&) const;
  void end_shear(State&);
  void start_ramp(State&);
  void return_to_settled_bed(State&);
  StepHealth pack(State&);
  StepHealth hold(State&);
  StepHealth coupled_step(State&);
  void begin_hold(State&);
  void freeze(State&) const;
  void forget_flow(State&) const;
  std::vector<double> steady_flow(const State&, const ImposedFlow&);
  void add_steady_flow(State&, const ImposedFlow& change);
};

Experiment::Experiment(const Scene& scene) : parts_(std::make_unique<Parts>(scene)) {}
Experiment::~Experiment() = default;
const Coupler& Experiment::coupler() const { return parts_->coupler; }
void Experiment::forget() {
  auto anew = std::make_unique<Parts>(parts_->scene);
  anew->settled = std::move(parts_->settled);   // handed in, or made once: no scratch
  parts_ = std::move(anew);
}

State Experiment::begin() const {
  State state;
  state.fluid = initial_flow(parts_->scene);
  state.grains = place_grains(parts_->scene.bed);
  if (!needs_settling(parts_->scene.bed)) parts_->start(state);
  return state;
}

State Experiment::begin_on(State settled) const {
  settled.fluid = initial_flow(parts_->scene);   // a bed's grid is not this scene's
  settled.search = {};
  settled.record = {};
  parts_->start(settled);
  return settled;
}

bool Experiment::reopen(State& state) const {
  if (!finished(state) || parts_->scene.bed_only || !parts_->next_hold(state.record)) return false;
  state.search.phase = Search::holding;
  ++state.search.hold;
  state.search.hold_begun = 0;
  return true;
}

StepHealth Experiment::step(State& state) {
  return state.search.phase == Search::packing ? parts_->pack(state) : parts_->hold(state);
}

void Experiment::branch_from(const State& settled) { parts_->settled = {settled.grains, settled.contacts}; }

double planned_time(const Scene& scene) {
  const FlowRamp& ramp = scene.drive;
  const auto levels = static_cast<double>(std::max<std::size_t>(1, ramp.levels.size()));
  return scene.onset.method == Onset::Method::bisect ? ramp.dwell * levels / 2 + usual_holds * scene.onset.hold
                                                     : ramp.dwell * levels;
}

StepHealth Experiment::Parts::pack(State& state) {
  const BedPacking::Progress progress = packing->advance(state.grains, state.contacts);
  ++state.clock.step;
  state.clock.time += progress.dt;
  if (progress.settled) {
    renumber_in_space(scene.bed, state.grains, state.contacts);
    start(state);
  }
  StepHealth health;
  health.dt = progress.dt;
  health.finite = std::isfinite(progress.energy);
  health.deepest_overlap = progress.deepest_overlap;
  health.settles = progress.settled || state.clock.time < packing->patience();
  return health;
}

/// Which hold comes next follows from those that are done, by the ramp or by a search; none when it is over.
std::optional<PlannedHold> Experiment::Parts::next_hold(const BedRecord& record) const {
  if (scene.onset.method == Onset::Method::bisect)
    return bedload::next_hold({.staircase = scene.drive.levels,
                               .bracket = scene.onset.bracket,
                               .stair = scene.drive.dwell,
                               .hold = scene.onset.hold,
                               .shift = own_shift(scene.bed.source.seed)},
                              judged_holds(record.holds));
  const std::vector<double>& levels = scene.drive.levels;
  if (ramp_is_over(record, scene.onset, levels.size())) return std::nullopt;
  const std::size_t hold = record.holds.hold.size();
  return PlannedHold{HoldPurpose::ramp, hold < levels.size() ? levels[hold] : 0, scene.drive.dwell, false};
}

/// The bed has come to rest: as it was poured, or after its shear.
void Experiment::Parts::start(State& state) {
  const bool sheared = state.search.purpose == std::uint64_t(HoldPurpose::shear);
  if (scene.shear.time > 0 && !sheared && !scene.bed_only) start_shear(state);
  else start_ramp(state);
}

void Experiment::Parts::start_shear(State& state) const {
  state.search.purpose = std::uint64_t(HoldPurpose::shear);
  state.clock.time = -scene.shear.time;
  state.search.phase = Search::holding;
}

/// The flow is taken away, and the bed comes to rest as it did when it was poured. Of the shear its flux is remembered alone.
void Experiment::Parts::end_shear(State& state) {
  recorder.close_hold(state);
  const double flux = state.record.holds.flux.back();
  state.record = {};
  state.hops = {};
  state.record.settled.shear_flux = flux;
  thaw(state.grains, state.contacts, state.asleep);
  state.fluid = initial_flow(scene);
  state.search = {};                                          // packing, ...
  state.search.purpose = std::uint64_t(HoldPurpose::shear);   // ... not for the first time
  state.clock.time = 0;
}

/// The bed is as the flow will find it: the ramp's clock starts here.
void Experiment::Parts::start_ramp(State& state) {
  if (scene.onset.method == Onset::Method::bisect) settled = {state.grains, state.contacts};
  recorder.record_settled_bed(state);
  state.clock.time = 0;
  state.search.purpose = std::uint64_t(HoldPurpose::ramp);
  state.search.phase = scene.bed_only ? Search::finished : Search::holding;
}

StepHealth Experiment::Parts::hold(State& state) {
  Search& search = state.search;
  if (!search.hold_begun) begin_hold(state);
  recorder.before_step(state);
  const StepHealth health = coupled_step(state);
  if (!ailment(health).empty()) return health;
  if (recorder.after_step(state, health, coupler.books())) freeze(state);
  if (state.clock.time - search.hold_start < search.duration) return health;

  if (search.purpose == std::uint64_t(HoldPurpose::shear)) return end_shear(state), health;
  recorder.close_hold(state);
  if (next_hold(state.record)) {
    ++search.hold;
    search.hold_begun = 0;
  } else {
    search.phase = Search::finished;
  }
  return health;
}

/// A step that went badly is undone and taken again at half its length. What is shorter stays so for a while: the ceiling is
/// part of the state, so that a resumed run takes the same steps. After the last try the state is that before the step.
StepHealth Experiment::Parts::coupled_step(State& state) {
  const double asked = std::min(scene.steps.fluid_interval, state.search.duration / 2);
  double ceiling = state.clock.longest_step > 0 ? state.clock.longest_step : asked;
  before.keep(state);
  StepHealth health;
  for (int retries = 0; retries <= most_retries; ++retries) {
    health = coupler.step(state, std::min(asked, ceiling));
    health.retries = retries;
    if (ailment(health).empty()) break;
    before.restore(state);
    coupler.forget();   // scratch may hold anything
    ceiling = health.dt / 2;
  }
  if (!ailment(health).empty()) return health;

  Clock& clock = state.clock;
  clock.retries += static_cast<std::uint64_t>(health.retries);
  if (health.retries > 0) clock.longest_step = health.dt, clock.good_steps = 0;
  if (clock.longest_step > 0 && ++clock.good_steps > steps_to_recover) {
    clock.longest_step = 2 * clock.longest_step < asked ? 2 * clock.longest_step : 0;
    clock.good_steps = 0;
  }
  return health;
}

/// Momentum crosses the gap in H^2/(pi^2 nu), far longer than a dwell: the steady flow of the new level is set at once.
void Experiment::Parts::begin_hold(State& state) {
  Search& search = state.search;
  const bool shear = search.purpose == std::uint64_t(HoldPurpose::shear);
  const PlannedHold plan =
      shear ? PlannedHold{HoldPurpose::shear, scene.shear.shields, scene.shear.time, false} : *next_hold(state.record);
  if (plan.from_settled) return_to_settled_bed(state);
  search.purpose = static_cast<std::uint64_t>(plan.purpose);
  search.level = plan.level, search.duration = plan.duration;
  search.bed_height = bed_surface(state.grains, scene.bed.length, scene.bed.grains.diameter).height;
  freeze(state);
  const ImposedFlow flow = imposed_level(scene, plan.level, search.bed_height);
  if (scene.fluid == FluidRung::profile) forget_flow(state);   // it is the new level's alone
  if (scene.developed)
    add_steady_flow(state,
                    {.lid_speed = flow.lid_speed - search.lid_speed, .gradient = flow.gradient - search.gradient});
  search.shields = flow.shields;
  search.lid_speed = flow.lid_speed;
  search.gradient = flow.gradient;
  search.push = flow.push;
  search.through_flow = flow.through_flow;

  search.hold_begun = 1;
  recorder.begin_hold(state);
}

/// Fluid, grains and contacts; the clock, the search and the record go on.
void Experiment::Parts::return_to_settled_bed(State& state) {
  if (settled.grains.size() == 0 && !needs_settling(scene.bed)) settled.grains = place_grains(scene.bed);
  if (settled.grains.size() != state.grains.size())
    throw Error(ErrorKind::internal, fmt::format("a search on {} grains has a settled bed of {}", state.grains.size(),
                                                 settled.grains.size()));
  forget_flow(state);
  state.grains = settled.grains;
  state.contacts = settled.contacts;
  state.asleep = {};
}

/// Which grains lie too deep to move is asked with every sample.
void Experiment::Parts::freeze(State& state) const {
  if (scene.frozen_depth > 0)
    freeze_deep_grains(scene.bed, scene.frozen_depth, recorder.slow_speed(), state.grains, state.contacts,
                       state.asleep);
}

void Experiment::Parts::forget_flow(State& state) const {
  state.fluid = initial_flow(scene);
  Search& s = state.search;
  s.shields = s.lid_speed = s.gradient = s.push = s.through_flow = 0;
}

/// u of every plane of cells. A column knows its own; in the box it is that over a bed which holds its fluid still.
std::vector<double> Experiment::Parts::steady_flow(const State& state, const ImposedFlow& flow) {
  if (scene.fluid == FluidRung::column) return coupler.steady_column(state.grains, flow);
  const double z_b = state.search.bed_height;
  return turbulent_flow(scene, z_b, friction_speed_of(scene, flow, z_b)).planes;
}

void Experiment::Parts::add_steady_flow(State& state, const ImposedFlow& change) {
  const StaggeredGrid& grid = scene.grid;
  if (!grid.periodic(0) || grid.periodic(2))
    return;   // between end walls, or without bottom and top, the flow is not this one
  const bool linear = !scene.terms.turbulence && scene.fluid != FluidRung::column;   // in what drives it
  std::vector<double> before_it, after_it;
  if (!linear) {
    const Search& s = state.search;
    before_it = steady_flow(state, {.lid_speed = s.lid_speed, .gradient = s.gradient});
    after_it =
        steady_flow(state, {.lid_speed = s.lid_speed + change.lid_speed, .gradient = s.gradient + change.gradient});
  }
  for (int k = 0; k < grid.cells[2]; ++k) {
    const auto n = static_cast<std::size_t>(k);
    const double more = linear ? steady_increment(scene, change, state.search.bed_height, (k + 0.5) * grid.h.z)
                               : after_it[n] - before_it[n];
    for (int i = 0; i < grid.cells[0]; ++i)
      for (int j = 0; j < grid.cells[1]; ++j) state.fluid.velocity.x[grid.index(i, j, k)] += more;
  }
}

}   // namespace bedload

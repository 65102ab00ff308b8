// Lock, fence, state; then step after step, with a heartbeat a second and a checkpoint when due.
#include "studies/case_runner.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <ctime>

#include <fmt/format.h>

#include "base/build_info.hpp"
#include "base/durable_file.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "checkpoint/checkpoint.hpp"
#include "checkpoint/checkpoint_series.hpp"
#include "scheduler/attempt.hpp"
#include "scheduler/heartbeat.hpp"
#include "scheduler/request.hpp"
#include "solver/bed/onset_moment.hpp"
#include "solver/bed/onset_search.hpp"
#include "solver/experiment.hpp"
#include "solver/step_judgement.hpp"
#include "studies/case_file.hpp"
#include "studies/performance.hpp"
#include "studies/stop_signals.hpp"

namespace bedload {

namespace fs = std::filesystem;

namespace {

constexpr double heartbeat_interval = 1;   // wall time [s]

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// CPU time of this process [s]: on a machine that is shared, less than the time that passes.
double cpu_seconds() {
  struct timespec spent {};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &spent);
  return static_cast<double>(spent.tv_sec) + 1e-9 * static_cast<double>(spent.tv_nsec);
}

/// One attempt at one case.
class Worker {
 public:
  explicit Worker(const RunCaseRequest&);
  int run();

 private:
  State first_state();
  void continue_or_end_ramp();
  int advance();
  void step();
  void beat();
  void publish();
  void finish();
  bool reached() const;
  /// Where the holds of a search find the bed that they branch from.
  fs::path branched_bed() const { return directory_ / (case_.scene.shear.time > 0 ? "sheared.h5" : "bed.h5"); }
  void say_how_the_shear_went() const;
  bool is_sheared_now() const { return state_.search.purpose == std::uint64_t(HoldPurpose::shear); }
  bool searches() const { return case_.scene.onset.method == Onset::Method::bisect; }
  bool asked_to_stop() const { return StopSignals::arrived() || requested_; }
  void say(const std::string& line) const { request_.report(line); }

  const RunCaseRequest& request_;
  const fs::path& directory_;
  CaseDirectory case_;
  Experiment experiment_;
  CheckpointSeries checkpoints_;
  State state_;
  Attempt attempt_;
  Performance performance_;
  double began_ = now(), cpu_began_ = cpu_seconds(), last_beat_ = 0, last_checkpoint_ = 0;
  std::uint64_t first_step_ = 0;
  std::uint64_t published_step_ = 0;
  bool requested_ = false;
};

Worker::Worker(const RunCaseRequest& request)
    : request_(request),
      directory_(request.directory),
      case_(read_case_directory(request.directory)),
      experiment_(case_.scene),
      checkpoints_(request.directory, case_.run.checkpoint_keep, [](const std::string& line) { log_warning(line); }) {}

/// Newest checkpoint, else the bed that was prepared, else grains as they are placed.
State Worker::first_state() {
  const bool has_bed = !case_.scene.bed_only && fs::exists(directory_ / "bed.h5");
  if (auto newest = checkpoints_.newest()) {
    published_step_ = newest->clock.step;
    if (searches() && fs::exists(branched_bed())) experiment_.branch_from(read_checkpoint(branched_bed()));
    return std::move(*newest);
  }
  return has_bed ? experiment_.begin_on(read_checkpoint(directory_ / "bed.h5")) : experiment_.begin();
}

/// The ramp may have been made longer, or shorter than what is done already.
void Worker::continue_or_end_ramp() {
  if (experiment_.reopen(state_)) return say("the ramp goes on: it was made longer, or its onset criterion changed");
  const bool past_the_end =
      !searches() && state_.search.phase == Search::holding && state_.search.hold >= case_.scene.drive.levels.size();
  if (past_the_end) state_.search.phase = Search::finished;
}

int Worker::run() {
  attempt_ = open_attempt(directory_);
  attempt_.version = fmt::format("{} {}", build_info().version, build_info().commit);
  attempt_.compiler = build_info().compiler;
  try {
    state_ = first_state();
    continue_or_end_ramp();
    attempt_.from_step = attempt_.step = first_step_ = state_.clock.step;
    write_attempt(directory_, attempt_);
    const int code = advance();
    close_attempt(directory_, attempt_, Experiment::finished(state_) ? Cause::finished : Cause::stopped);
    return code;
  } catch (const Error& error) {
    attempt_.core_seconds = cpu_seconds() - cpu_began_;
    if (error.kind != ErrorKind::fenced) close_attempt(directory_, attempt_, cause_of(error.kind), error.what());
    throw;
  }
}

bool Worker::reached() const {
  return request_.until && state_.search.phase == Search::holding && state_.clock.time >= *request_.until;
}

int Worker::advance() {
  const auto& bed = case_.scene.bed;
  say(fmt::format(
      "{}: {} grains, {} cells, E = {:.3g} Pa, DEM step {:.3g} s, fluid step at most {:.3g} s; from step {}",
      case_.label, state_.grains.size(), case_.scene.grid.cell_count(), bed.grains.young_modulus, bed.dem_step,
      case_.scene.steps.fluid_interval, state_.clock.step));
  last_checkpoint_ = now();
  while (!Experiment::finished(state_) && !reached() && !asked_to_stop()) {
    step();
    if (now() - last_beat_ >= heartbeat_interval) beat();
    if (now() - last_checkpoint_ >= case_.run.checkpoint_every) publish();
  }
  publish();
  beat();
  if (Experiment::finished(state_)) finish();
  say(describe(performance_, experiment_.coupler().times()));
  if (Experiment::finished(state_)) return 0;
  say(fmt::format("stopped at step {}, {:.4g} s; run it again to go on", state_.clock.step, state_.clock.time));
  return reached() ? 0 : static_cast<int>(ErrorKind::stopped);
}

void Worker::step() {
  const bool coupled = state_.search.phase == Search::holding;
  const auto holds_before = state_.record.holds.hold.size();
  const auto health = experiment_.step(state_);
  const bool settled = !coupled && state_.search.phase == Search::holding && !is_sheared_now();
  if (settled && searches()) write_checkpoint(branched_bed(), state_);   // its holds come back to it
  if (settled && case_.scene.shear.time > 0) say_how_the_shear_went();
  const bool closed = state_.record.holds.hold.size() > holds_before;
  if (closed && ends_at_onset(state_.record, case_.scene.onset)) write_checkpoint(directory_ / "onset.h5", state_);
  if (const auto cause = ailment(health); !cause.empty()) {
    throw Error(
        ErrorKind::numerical,
        fmt::format("{}: step {} at {:.6g} s: {} (fluid step {:.3g} s after {} retries, CFL {:.2g})", case_.label,
                    state_.clock.step, state_.clock.time, cause, health.dt, health.retries, health.cfl),
        "the checkpoint before is kept; a shorter steps.dem or steps.fluid, or stiffer grains, may help");
  }
  if (coupled) performance_.add(health, state_.grains.size(), case_.scene.grid.cell_count());
}

void Worker::say_how_the_shear_went() const {
  const auto& bed = state_.record.settled;
  say(fmt::format(
      "sheared at theta = {:.4g} and at rest again: flux {:.3g} at the end of the shear; solid fraction {:.4f}, "
      "coordination {:.3f}",
      case_.scene.shear.shields, bed.shear_flux, bed.solid_fraction, bed.coordination));
  if (bed.shear_flux >= case_.scene.onset.value)
    log_warning(
        fmt::format("{}: its bed was moving while it was sheared (flux {:.3g}): bed.shear.shields = {:.4g} is not "
                    "below its onset",
                    case_.label, bed.shear_flux, case_.scene.shear.shields));
}

void Worker::beat() {
  last_beat_ = now();
  const auto& search = state_.search;
  const double wall = last_beat_ - began_;
  attempt_.step = state_.clock.step;
  attempt_.core_seconds = cpu_seconds() - cpu_began_;
  Heartbeat beat;
  beat.pid = ::getpid();
  beat.step = state_.clock.step;
  beat.phase = search.phase == Search::packing   ? "packing"
               : search.phase != Search::holding ? "finished"
               : searches() || is_sheared_now()  ? std::string(name_of(HoldPurpose(search.purpose)))
                                                 : "ramp";
  beat.time = search.phase == Search::packing ? 0 : std::max(0.0, state_.clock.time);
  beat.planned_time = case_.scene.bed_only ? 0 : planned_time(case_.scene);
  beat.hold = static_cast<int>(search.hold) + 1;
  beat.holds = searches() ? 0 : static_cast<int>(case_.scene.drive.levels.size());
  beat.shields = search.shields;
  beat.steps_per_second = static_cast<double>(state_.clock.step - first_step_) / wall;
  beat.core_seconds = attempt_.core_seconds;
  write_heartbeat(directory_, beat);
  requested_ = read_request(directory_).has_value();
}

/// A checkpoint, if there is news and this attempt still owns the case.
void Worker::publish() {
  if (highest_attempt(directory_) != attempt_.number)
    throw Error(ErrorKind::fenced, fmt::format("{}: another attempt has taken over the case", directory_.string()));
  if (state_.clock.step != published_step_ || Experiment::finished(state_)) checkpoints_.publish(state_);
  published_step_ = state_.clock.step;
  last_checkpoint_ = now();
}

void Worker::finish() {
  if (case_.scene.bed_only) write_checkpoint(directory_ / "bed.h5", state_);
}

/// Finished, and nothing of what it leaves is missing.
bool complete(const fs::path& directory) {
  const auto newest = newest_position(directory);
  if (!newest || !newest->finished) return false;
  const auto one = read_case_directory(directory);
  if (one.scene.bed_only) return fs::exists(directory / "bed.h5");
  auto state = CheckpointSeries(directory, one.run.checkpoint_keep, [](const std::string&) {}).newest();
  return state && !Experiment(one.scene).reopen(*state);
}

}   // namespace

int run_case(const RunCaseRequest& request) {
  if (!fs::exists(request.directory / "case.toml"))
    throw Error(ErrorKind::not_found,
                fmt::format("{} is not a case directory: it has no case.toml", request.directory.string()),
                "`bedload run STUDY --prepare` makes case directories");
  const StopSignals signals;
  const auto lock =
      FileLock::lock_or_refuse(request.directory / "lock", fmt::format("case {}", request.directory.string()));
  if (complete(request.directory)) {
    request.report("finished already");
    return 0;
  }
  return Worker(request).run();
}

}   // namespace bedload

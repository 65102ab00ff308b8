// Runs the matrix: each scene straight, and again from its middle; books after every step.
#include "studies/extremes.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <sstream>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/thread_clock.hpp"
#include "checkpoint/checkpoint.hpp"
#include "solver/experiment.hpp"
#include "solver/step_judgement.hpp"
#include "studies/run_in_parallel.hpp"
#include "studies/study_file.hpp"
#include "studies/validation.hpp"
#include "studies/validation_files.hpp"

namespace bedload {
namespace {

constexpr double longest_packing = 60'000;   // intervals of packing

/// The base file with the overrides in place of what it says.
Study study_of(const ExtremeScene& scene, const std::string& more_lines) {
  Study study = validation_study(scene.base);
  std::string text = "format = 1\n";
  std::istringstream lines(scene.overrides + "\n" + more_lines);
  for (std::string line; std::getline(lines, line);) {
    const std::string_view without = "without ";
    if (!line.starts_with(without)) {
      text += line + "\n";
      continue;
    }
    const std::string path = line.substr(without.size());
    std::erase_if(study.settings,
                  [&](const auto& entry) { return entry.first == path || entry.first.starts_with(path + "."); });
  }
  for (const auto& [key, setting] : parse_study(text, scene.base + " with overrides").settings)
    study.settings[key] = setting;
  return study;
}

Case case_of(const ExtremeScene& scene, const std::string& more_lines) {
  return unfold(study_of(scene, more_lines), validation_text).at(0);
}

bool all_finite(const State& state) {
  bool finite = true;
  State::each_field(state, [&](auto&&, const auto& field, auto&&) {
    using Type = std::decay_t<decltype(field)>;
    if constexpr (std::is_same_v<Type, double>) finite &= std::isfinite(field);
    if constexpr (std::is_same_v<Type, std::vector<double>>)
      for (const double v : field) finite &= std::isfinite(v);
    if constexpr (std::is_same_v<Type, std::vector<Vec3>>)
      for (const Vec3& v : field) finite &= std::isfinite(norm2(v));
    if constexpr (requires { field.values; })
      for (const double v : field.values) finite &= std::isfinite(v);
  });
  return finite;
}

[[noreturn]] void fail(const State& state, const StepHealth& health, const std::string& why) {
  throw Error(ErrorKind::numerical, fmt::format("step {} at {:.6g} s: {} (fluid step {:.3g} s after {} retries)",
                                                state.clock.step, state.clock.time, why, health.dt, health.retries));
}

using Stop = std::function<bool()>;

void stop_if_asked(const Stop& stop) {
  if (stop()) throw Error(ErrorKind::stopped, "stopped");
}

/// One step, which must be a good one.
StepHealth advance(Experiment& experiment, State& state, const Stop& stop) {
  stop_if_asked(stop);
  const StepHealth health = experiment.step(state);
  if (const auto cause = ailment(health); !cause.empty()) fail(state, health, cause);
  return health;
}

/// The scene with its bed settled.
State settled(Experiment& experiment, const Stop& stop) {
  State state = experiment.begin();
  for (double packed = 0; state.search.phase == Search::packing; ++packed) {
    const StepHealth health = advance(experiment, state, stop);
    if (packed > longest_packing) fail(state, health, "the bed does not come to rest");
  }
  return state;
}

/// Lines that give the run its length: the time that its steps take when nothing ends it, since what limits a step (flow,
/// drag, contacts) shows only in the run.
std::string length_of(const ExtremeScene& scene, const Stop& stop) {
  const Case endless = case_of(scene, "drive.dwell = \"1e9 s\"");
  Experiment experiment(endless.scene);
  State state = settled(experiment, stop);
  for (int n = 0; n < scene.steps; ++n) advance(experiment, state, stop);
  const double dwell =
      state.clock.time / static_cast<double>(std::max<std::size_t>(1, endless.scene.drive.levels.size()));
  return fmt::format("drive.dwell = \"{} s\"\nrecord.every = \"{} s\"", dwell, dwell / 4);
}

/// Runs to the end. Returns a checkpoint of the middle of the ramp.
std::vector<std::byte> run_straight(const Scene& scene, State& state, ExtremeRow& row, const Stop& stop) {
  Experiment experiment(scene);
  ConservationBooks books(scene);
  state = settled(experiment, stop);
  row.grains = state.grains.size();
  const double half = planned_time(scene) / 2;
  std::vector<std::byte> middle;
  while (!Experiment::finished(state)) {
    const State before = state;
    const StepHealth health = advance(experiment, state, stop);
    books.add(before, state, health, experiment.coupler().books());
    row.books = books.worst();
    row.cfl = std::max({row.cfl, health.cfl, health.cfl_after});
    row.overlap = std::max(row.overlap, health.deepest_overlap);
    row.retries = state.clock.retries;
    if (middle.empty() && state.clock.time >= half && !Experiment::finished(state)) middle = checkpoint_image(state);
    if (++row.steps > most_steps) fail(state, health, "the steps have become too short to end");
  }
  return middle;
}

/// Runs to the end from a checkpoint.
State resumed(const Scene& scene, const std::vector<std::byte>& image, const std::string& name, const Stop& stop) {
  Experiment experiment(scene);
  State state = state_from_image(image, name);
  while (!Experiment::finished(state)) advance(experiment, state, stop);
  return state;
}

}   // namespace

ExtremeRow run_extreme(const ExtremeScene& scene, const Stop& stop) {
  ExtremeRow row{.scene = scene};
  const double began = thread_seconds();
  State state;
  try {
    stop_if_asked(stop);   // also where it would be refused
    const std::string length = length_of(scene, stop);
    row.scene.overrides += (scene.overrides.empty() ? "" : "\n") + length;
    const Case one = case_of(scene, length);
    const auto middle = run_straight(one.scene, state, row, stop);
    row.outcome = Outcome::finished;
    row.resumed_is_straight =
        !middle.empty() && state_digest(resumed(one.scene, middle, scene.name, stop)) == state_digest(state);
  } catch (const Error& error) {
    if (error.kind == ErrorKind::stopped) throw;
    row.outcome = error.kind == ErrorKind::numerical ? Outcome::failed : Outcome::refused;
    row.message = error.what();
  }
  row.all_finite = all_finite(state);
  row.core_seconds = thread_seconds() - began;
  return row;
}

std::string_view name_of(Outcome outcome) {
  constexpr std::string_view names[] = {"finished", "refused", "failed"};
  return names[static_cast<int>(outcome)];
}

std::string ExtremeRow::wrong() const {
  if (outcome != scene.expected) return fmt::format("{}, not {}", name_of(outcome), name_of(scene.expected));
  if (outcome == Outcome::refused) return message.empty() ? "refused without a word" : "";
  if (!all_finite) return "a number is not finite";
  if (outcome == Outcome::failed) return message.empty() ? "failed without a word" : "";
  if (grains > most_grains) return fmt::format("{} grains are more than {}", grains, most_grains);
  if (steps < fewest_steps || steps > most_steps)
    return fmt::format("{} fluid steps are not {} to {}", steps, fewest_steps, most_steps);
  if (!books.grains_unchanged) return "grains were lost or changed";
  if (!(books.fluid_volume <= exact_volume)) return "volume of the fluid";
  if (books.momentum && !(*books.momentum <= exact_momentum)) return "momentum";
  if (!(books.divergence <= (books.mobile ? most_left : exact_divergence))) return "divergence";
  if (books.energy && !(*books.energy <= energy_made)) return "energy";
  if (!resumed_is_straight) return "the resumed run differs";
  return {};
}

std::vector<ExtremeRow> run_extremes(const ExtremesOptions& options) {
  const auto scenes = extreme_scenes(options.quick);
  std::vector<std::optional<ExtremeRow>> ended(scenes.size());
  std::mutex speaking;
  run_in_parallel(scenes.size(), options.cores, [&](std::size_t n) {
    try {
      ended[n] = run_extreme(scenes[n], options.stop);
    } catch (const Error&) {
      return;   // stopped
    }
    const auto wrong = ended[n]->wrong();
    const std::lock_guard lock(speaking);
    options.progress(fmt::format("{}: {}: {} ({:.1f} s)", scenes[n].base, scenes[n].name,
                                 wrong.empty() ? "right" : "WRONG: " + wrong, ended[n]->core_seconds));
  });
  std::vector<ExtremeRow> rows;
  for (auto& row : ended)
    if (row) rows.push_back(std::move(*row));
  return rows;
}

Rows extremes_table(const std::vector<ExtremeRow>& rows) {
  Rows table{{"base", "scene", "outcome", "grains", "steps", "retries", "cfl", "overlap", "volume", "momentum",
              "divergence", "energy", "resumed", "wrong", "message", "overrides"},
             {}};
  const auto some = [](const std::optional<double>& book) { return book ? Value(*book) : Value(); };
  for (const ExtremeRow& row : rows) {
    const bool ran = row.outcome != Outcome::refused, ended = row.outcome == Outcome::finished;
    const auto ran_only = [&](double value) { return ran ? Value(value) : Value(); };
    std::string overrides = row.scene.overrides;
    for (auto at = overrides.find('\n'); at != overrides.npos; at = overrides.find('\n', at))
      overrides.replace(at, 1, "; ");
    std::string message = row.message;
    std::ranges::replace(message, '\n', ' ');
    table.rows.push_back({row.scene.base, row.scene.name, std::string(name_of(row.outcome)),
                          static_cast<std::int64_t>(row.grains), static_cast<std::int64_t>(row.steps),
                          static_cast<std::int64_t>(row.retries), ran_only(row.cfl), ran_only(row.overlap),
                          ran_only(row.books.fluid_volume), some(row.books.momentum), ran_only(row.books.divergence),
                          some(row.books.energy),
                          ended ? Value(std::string(row.resumed_is_straight ? "same" : "NO")) : Value(), row.wrong(),
                          message, overrides});
  }
  return table;
}

}   // namespace bedload

// Runs the matrix: each scene straight, and again from its middle; books after every step.
#include "studies/extremes.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <ctime>
#include <mutex>
#include <sstream>
#include <thread>

#include <fmt/format.h>

#include "base/error.hpp"
#include "checkpoint/checkpoint.hpp"
#include "solver/experiment.hpp"
#include "solver/required_models.hpp"
#include "solver/step_judgement.hpp"
#include "studies/study_file.hpp"
#include "studies/validation.hpp"
#include "studies/validation_files.hpp"

namespace bedload {
namespace {

// What the books must hold to; docs/physics_coupling.md says what is exact and what is bounded.
constexpr double exact_volume = 1e-10, exact_momentum = 1e-10, exact_divergence = 1e-8, energy_made = 0.01;
constexpr double most_left = 0.1;            // of a cell's volume per step, with mobile grains
constexpr double longest_ramp = 20'000;      // coupled steps: a scene that takes more has steps far below its own limit
constexpr double longest_packing = 60'000;   // intervals of packing

double thread_seconds() {
  struct timespec spent {};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &spent);
  return static_cast<double>(spent.tv_sec) + 1e-9 * static_cast<double>(spent.tv_nsec);
}

std::string embedded_text(const std::filesystem::path& file) {
  const auto name = file.filename().string();
  const auto found = std::ranges::find(validation_files(), name, &EmbeddedFile::name);
  if (found == validation_files().end())
    throw Error(ErrorKind::not_found, fmt::format("there is no file {} in studies/validation", name));
  return std::string(found->text);
}

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
  return unfold(study_of(scene, more_lines), embedded_text).at(0);
}

/// Length of a step that the flow allows, before the run: the interval asked for, or CFL 0.5 at the imposed speed.
double expected_step(const Scene& scene) {
  if (!scene.developed) return scene.steps.fluid_interval;
  const double speed = numbers_of(scene).flow_speed, fastest = std::isfinite(speed) ? std::abs(speed) * 1.5 : 0;
  const double by_flow = fastest > 0 ? 0.5 * scene.grid.h.x / fastest : scene.steps.fluid_interval;
  return std::min(by_flow, scene.steps.fluid_interval);
}

/// Lines that give the run its length.
std::string length_of(const ExtremeScene& scene) {
  const Case probe = case_of(scene, "");
  const double holds = static_cast<double>(std::max<std::size_t>(1, probe.scene.drive.levels.size()));
  const double dwell = scene.steps * expected_step(probe.scene) / holds;
  return fmt::format("drive.dwell = \"{:.4g} s\"\nrecord.every = \"{:.4g} s\"", dwell, dwell / 4);
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

/// Runs to the end. Returns a checkpoint of the middle of the ramp.
std::vector<std::byte> run_straight(const Scene& scene, State& state, ExtremeRow& row) {
  Experiment experiment(scene);
  ConservationBooks books(scene);
  state = experiment.begin();
  row.grains = state.grains.size();
  std::vector<std::byte> middle;
  State before;
  for (double packed = 0; state.search.phase == Search::packing; ++packed) {
    const StepHealth health = experiment.step(state);
    if (const auto cause = ailment(health); !cause.empty()) fail(state, health, cause);
    if (packed > longest_packing) fail(state, health, "the bed does not come to rest");
  }
  const double half = experiment.planned_time() / 2;
  while (!Experiment::finished(state)) {
    before = state;
    const StepHealth health = experiment.step(state);
    if (const auto cause = ailment(health); !cause.empty()) {
      row.all_finite = all_finite(state);
      fail(state, health, cause);
    }
    books.add(before, state, health, experiment.coupler().books());
    row.books = books.worst();
    row.cfl = std::max({row.cfl, health.cfl, health.cfl_after});
    row.overlap = std::max(row.overlap, health.deepest_overlap);
    row.retries = state.clock.retries;
    ++row.steps;
    if (middle.empty() && state.clock.time >= half && !Experiment::finished(state)) middle = checkpoint_image(state);
    if (static_cast<double>(row.steps) > longest_ramp) fail(state, health, "the steps have become too short to end");
  }
  return middle;
}

}   // namespace

ExtremeRow run_extreme(const ExtremeScene& scene) {
  ExtremeRow row{.scene = scene};
  const double began = thread_seconds();
  try {
    const std::string length = length_of(scene);
    row.scene.overrides += (scene.overrides.empty() ? "" : "\n") + length;
    const Case one = case_of(scene, length);
    State state;
    const auto middle = run_straight(one.scene, state, row);
    row.all_finite = all_finite(state);
    row.outcome = Outcome::finished;
    State resumed = middle.empty() ? state : state_from_image(middle, scene.name);
    Experiment again(one.scene);
    while (!Experiment::finished(resumed)) again.step(resumed);
    row.resumed_is_straight = !middle.empty() && state_digest(resumed) == state_digest(state);
  } catch (const Error& error) {
    row.outcome = error.kind == ErrorKind::numerical ? Outcome::failed : Outcome::refused;
    row.message = error.what();
  }
  row.core_seconds = thread_seconds() - began;
  return row;
}

std::string ExtremeRow::wrong() const {
  if (outcome != scene.expected) {
    constexpr const char* words[] = {"finished", "refused", "failed"};
    return fmt::format("{}, not {}", words[int(outcome)], words[int(scene.expected)]);
  }
  if (outcome == Outcome::refused) return message.empty() ? "refused without a word" : "";
  if (!all_finite) return "a number is not finite";
  if (outcome == Outcome::failed) return message.empty() ? "failed without a word" : "";
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
  std::vector<ExtremeRow> rows(scenes.size());
  std::atomic<std::size_t> next = 0;
  std::mutex speaking;
  const auto work = [&] {
    for (std::size_t n; (n = next++) < scenes.size();) {
      rows[n] = run_extreme(scenes[n]);
      const auto wrong = rows[n].wrong();
      const std::lock_guard lock(speaking);
      options.progress(fmt::format("{}: {}: {} ({:.1f} s)", scenes[n].base, scenes[n].name,
                                   wrong.empty() ? "right" : "WRONG: " + wrong, rows[n].core_seconds));
    }
  };
  const std::size_t all = std::max(1u, std::thread::hardware_concurrency());
  const std::size_t workers =
      std::min<std::size_t>(options.cores > 0 ? static_cast<std::size_t>(options.cores) : all, scenes.size());
  std::vector<std::thread> threads;
  for (std::size_t n = 1; n < workers; ++n) threads.emplace_back(work);
  work();
  for (auto& thread : threads) thread.join();
  return rows;
}

Rows extremes_table(const std::vector<ExtremeRow>& rows) {
  Rows table{{"base", "scene", "outcome", "grains", "steps", "retries", "cfl", "overlap", "volume", "momentum",
              "divergence", "energy", "resumed", "wrong", "message", "overrides"},
             {}};
  const auto some = [](const std::optional<double>& book) { return book ? Value(*book) : Value(); };
  for (const ExtremeRow& row : rows) {
    constexpr const char* words[] = {"finished", "refused", "failed"};
    const bool ran = row.outcome != Outcome::refused, ended = row.outcome == Outcome::finished;
    const auto ran_only = [&](double value) { return ran ? Value(value) : Value(); };
    std::string overrides = row.scene.overrides;
    for (auto at = overrides.find('\n'); at != overrides.npos; at = overrides.find('\n', at))
      overrides.replace(at, 1, "; ");
    std::string message = row.message;
    std::ranges::replace(message, '\n', ' ');
    table.rows.push_back({row.scene.base, row.scene.name, std::string(words[int(row.outcome)]),
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

// Climbing the ladder: cases side by side in threads, each rung measured when its last case is done.
#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/thread_clock.hpp"
#include "solver/experiment.hpp"
#include "solver/step_judgement.hpp"
#include "studies/plan.hpp"
#include "studies/run_in_parallel.hpp"
#include "studies/validation.hpp"

namespace bedload {

namespace {

/// A rung being climbed: a place for each of its cases, and how many are still to come.
struct Climb {
  Rung rung;
  RungResult result;
  std::vector<Case> cases;
  std::vector<std::optional<FinishedCase>> finished;
  std::vector<std::string> failures;   // by case; empty = none
  std::atomic<std::size_t> left = 0;
  std::atomic<bool> stopped = false;
};

struct Job {
  Climb* climb;
  std::size_t index;
  double cost;
};

/// Cases of all rungs, the costly ones first; a study file that cannot be used fails its rung.
std::vector<Job> jobs_of(std::vector<std::unique_ptr<Climb>>& climbs, bool quick) {
  std::vector<Job> jobs;
  for (auto& climb : climbs) {
    try {
      climb->cases = cases_of(climb->rung, quick);
    } catch (const Error& error) {
      climb->result.failure = error.what();
    }
    const auto count = climb->cases.size();
    climb->finished.resize(count);
    climb->failures.resize(count);
    climb->left = count;
    climb->result.cases = static_cast<int>(count);
    for (std::size_t n = 0; n < count; ++n)
      jobs.push_back({climb.get(), n, predicted_cost(climb->cases[n].scene).core_seconds});
  }
  std::ranges::stable_sort(jobs, std::ranges::greater{}, &Job::cost);
  return jobs;
}

/// What the rung's cases show, once all are done; their states are let go.
void measure(Climb& climb) {
  RungResult& result = climb.result;
  for (const auto& failure : climb.failures)
    if (result.failure.empty()) result.failure = failure;
  if (!result.failure.empty()) return;
  std::vector<FinishedCase> finished;
  for (auto& one : climb.finished) {
    result.core_seconds += one->core_seconds + one->packing_seconds;
    finished.push_back(std::move(*one));
  }
  climb.finished.clear();
  try {
    result.findings = climb.rung.measure(finished);
  } catch (const std::exception& error) {
    result.failure = error.what();
  }
}

std::string summary(const RungResult& r) {
  if (!r.failure.empty()) return fmt::format("{}: {}", r.study, r.failure);
  return fmt::format("{}: {} of {} rows in band, {} cases, {:.1f} core seconds", r.study, r.findings.in_band(),
                     r.findings.deciding(), r.cases, r.core_seconds);
}

}   // namespace

FinishedCase run_in_memory(const Case& one, const std::function<bool()>& stop) {
  FinishedCase run{.one = one, .state = {}, .drag = {}};
  const auto go_on = [&] {
    if (stop()) throw Error(ErrorKind::stopped, fmt::format("{}: stopped", one.label));
  };
  go_on();
  Experiment experiment(one.scene);
  double began = thread_seconds();
  run.state = experiment.begin();
  while (!Experiment::finished(run.state)) {
    go_on();
    const bool packing = run.state.search.phase == Search::packing;
    const StepHealth health = experiment.step(run.state);
    if (const auto cause = ailment(health); !cause.empty())
      throw Error(ErrorKind::numerical, fmt::format("{}: step {} at {:.6g} s: {}", one.label, run.state.clock.step,
                                                    run.state.clock.time, cause));
    if (packing && run.state.search.phase != Search::packing)
      run.packing_seconds = thread_seconds() - began, began = thread_seconds();
    if (packing) continue;
    ++run.fluid_steps;
    run.worst_divergence = std::max(run.worst_divergence, health.divergence);
    run.deepest_overlap = std::max(run.deepest_overlap, health.deepest_overlap);
  }
  run.core_seconds = thread_seconds() - began;
  const auto drag = experiment.coupler().drag_on_grains();
  run.drag.assign(drag.begin(), drag.end());
  return run;
}

std::vector<RungResult> climb(const std::vector<ValidationGroup>& groups, const ValidationOptions& options) {
  std::vector<std::unique_ptr<Climb>> climbs;
  for (const auto& group : groups)
    for (auto& rung : group.rungs()) {
      if (options.quick && !rung.quick) continue;
      auto& made = *climbs.emplace_back(std::make_unique<Climb>());
      made.result = {
          .group = std::string(group.name), .study = std::string(rung.study), .what = std::string(rung.what)};
      made.rung = std::move(rung);
    }
  const auto jobs = jobs_of(climbs, options.quick);

  std::mutex speaking;
  run_in_parallel(jobs.size(), options.cores, [&](std::size_t n) {
    Climb& climb = *jobs[n].climb;
    try {
      climb.finished[jobs[n].index] = run_in_memory(climb.cases[jobs[n].index], options.stop);
    } catch (const Error& error) {
      if (error.kind == ErrorKind::stopped) climb.stopped = true;
      else climb.failures[jobs[n].index] = error.what();
    } catch (const std::exception& error) {
      climb.failures[jobs[n].index] = error.what();
    }
    if (--climb.left > 0) return;
    if ((climb.result.stopped = climb.stopped)) return;
    measure(climb);
    const std::lock_guard lock(speaking);
    options.progress(summary(climb.result));
  });

  std::vector<RungResult> results;
  for (auto& climb : climbs) results.push_back(std::move(climb->result));
  return results;
}

}   // namespace bedload

// `bedload run`, `case`, `stop`, `retry`: what starts and ends workers.
#include <unistd.h>

#include <chrono>

#include <fmt/format.h>

#include "app/commands.hpp"
#include "base/counted.hpp"
#include "base/durable_file.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "base/units.hpp"
#include "scheduler/attempt.hpp"
#include "scheduler/request.hpp"
#include "studies/case_runner.hpp"
#include "studies/run_study.hpp"
#include "studies/study_file.hpp"

namespace bedload {

namespace {

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

void to_stderr(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

class Silence : public ProgressSink {
  void event(const std::string&) override {}
  void update(const Progress&) override {}
};

std::vector<CaseEntry> named_cases(const StudyOptions& options, const StudyPlace& place) {
  const auto known = read_cases(open_results(place));
  std::vector<CaseEntry> cases;
  const auto words = options.cases.empty() ? std::vector<std::string>{"*"} : options.cases;
  for (const auto& word : words)
    for (auto& entry : matching_cases(known, word)) cases.push_back(std::move(entry));
  std::erase_if(cases, [](const CaseEntry& entry) { return !entry.in_study; });
  return cases;
}

/// Beds are stopped with the whole study: other cases may wait for them.
std::vector<CaseEntry> cases_to_stop(const StudyOptions& options, const StudyPlace& place) {
  if (!options.cases.empty()) return named_cases(options, place);
  auto all = read_cases(open_results(place));
  std::erase_if(all, [](const CaseEntry& entry) { return !entry.is_bed && !entry.in_study; });
  return all;
}

}   // namespace

int run_command(const RunOptionsOfCommand& options) {
  const auto place = find_study(options.study.study, options.study.out);
  Silence silence;
  ProgressPrinter printer({.terminal = isatty(2) == 1, .colour = colour_wanted(2)}, to_stderr, seconds);
  const double began = seconds();
  const int code = run_study({.place = place,
                              .cores = options.cores,
                              .only = options.study.cases,
                              .prepare = options.prepare,
                              .rescan = options.rescan,
                              .recompute = options.recompute,
                              .replace = options.replace,
                              .sink = options.quiet ? static_cast<ProgressSink*>(&silence) : &printer});
  if (options.prepare) return code;
  log_note(fmt::format("wall time {}", duration_text(seconds() - began)));
  const auto named = options.study.out ? place.directory.string() : place.name;   // in the commands to come
  if (code == 75) log_note(fmt::format("stopped with work left; go on with: bedload run {}", named));
  if (code == 0 || code == 1) log_note(fmt::format("report in {}", write_report(place).string()));
  if (code == 0 && seeks_onset(read_study(place.file)))
    log_note(fmt::format("bedload curve {} shows the thresholds", named));
  if (code == 1) log_note(fmt::format("bedload explain {} CASE says why a case failed", named));
  return code;
}

int case_command(const std::string& directory, const std::optional<std::string>& until) {
  RunCaseRequest request{.directory = directory, .until = {}, .report = [](const std::string& line) {
                           fmt::print("{}\n", line);
                           std::fflush(stdout);
                         }};
  try {
    if (until) request.until = read_quantity(*until, dimension::time);
  } catch (const UnitError& problem) {
    throw Error(ErrorKind::usage, fmt::format("--until: {}", problem.what()), problem.hint);
  }
  return run_case(request);
}

/// Leaves a word in the directories: workers read it at their next heartbeat, a scheduler before it starts a case.
int stop_command(const StudyOptions& options) {
  const auto place = find_study(options.study, options.out);
  const bool scheduled = FileLock::holder(place.directory / "lock").has_value();
  int workers = 0, waiting = 0;
  for (const auto& entry : cases_to_stop(options, place)) {
    const auto directory = place.directory / entry.directory;
    const bool at_work = FileLock::holder(directory / "lock").has_value();
    const bool unfinished =
        entry.state == CaseState::pending || entry.state == CaseState::running;   // or about to lock
    const bool waits = scheduled && !at_work && unfinished;
    if (!at_work && !waits) continue;
    write_request(directory, Request::stop);
    workers += at_work;
    waiting += waits;
  }
  if (workers + waiting == 0) {
    log_note(fmt::format("nothing of {} is at work", place.name));
    return 0;
  }
  log_note(
      fmt::format("{} at work asked to write a checkpoint and stop, {} waiting kept from starting; "
                  "the next `bedload run` goes on",
                  workers, waiting));
  return 0;
}

/// An attempt that says so stands between the failure and what comes next.
int retry_command(const StudyOptions& options) {
  const auto place = find_study(options.study, options.out);
  int again = 0;
  for (const auto& entry : named_cases(options, place)) {
    const auto directory = place.directory / entry.directory;
    if (read_request(directory) == Request::hold) clear_request(directory);
    if (entry.state != CaseState::failed) continue;
    close_attempt(directory, open_attempt(directory), Cause::stopped, "retry asked for");
    ++again;
  }
  log_note(fmt::format("{} pending again; go on with: bedload run {}", counted(again, "failed case"), place.name));
  return 0;
}

}   // namespace bedload

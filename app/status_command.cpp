// `bedload status`: where every case stands.
#include <unistd.h>

#include <algorithm>
#include <map>
#include <thread>

#include <fmt/format.h>

#include "app/commands.hpp"
#include "app/tables.hpp"
#include "base/counted.hpp"
#include "base/durable_file.hpp"
#include "scheduler/heartbeat.hpp"
#include "scheduler/interrupts.hpp"
#include "scheduler/progress.hpp"
#include "studies/case_file.hpp"
#include "studies/plan.hpp"
#include "studies/results.hpp"
#include "studies/study_directory.hpp"

namespace bedload {

namespace fs = std::filesystem;

namespace {

/// One case as its directory shows it now; the database may be of an earlier moment.
struct Standing {
  const CaseEntry* entry;
  std::optional<LockHolder> worker;
  std::optional<Heartbeat> beat;
  double fraction = 0;   // of the planned model time
  double core_hours_left = 0;
};

Standing standing_of(const CaseEntry& entry, const fs::path& results) {
  Standing s{&entry, {}, {}};
  const auto directory = results / entry.directory;
  if (entry.state == CaseState::done) {
    s.fraction = 1;
    return s;
  }
  if (!fs::exists(directory / "case.toml")) return s;
  s.worker = FileLock::holder(directory / "lock");
  s.beat = read_heartbeat(directory);
  if (s.beat && s.beat->planned_time > 0) s.fraction = std::min(1.0, s.beat->time / s.beat->planned_time);
  s.core_hours_left = predicted_cost(read_case_directory(directory).scene).core_seconds * (1 - s.fraction) / 3600;
  return s;
}

std::string state_in_words(const Standing& s) {
  if (s.worker) return s.beat ? s.beat->phase : "starting";
  if (s.entry->state == CaseState::running) return "interrupted";
  return std::string(word(s.entry->state));
}

/// A search does not know how many holds it will take.
std::string hold_in_words(const Heartbeat& beat) {
  return beat.holds > 0 ? fmt::format("{}/{}", beat.hold, beat.holds) : fmt::format("{}", beat.hold);
}

Rows case_rows(const std::vector<Standing>& all) {
  Rows rows{{"case", "state", "hold", "theta", "percent", "steps_per_s", "worker", "core_hours_left", "message"}, {}};
  for (const auto& s : all) {
    if (s.entry->is_bed && s.entry->state == CaseState::done) continue;
    const bool holds =
        s.beat && s.beat->phase != "packing" && s.beat->phase != "finished" && s.entry->state != CaseState::done;
    rows.rows.push_back({s.entry->label, state_in_words(s), holds ? Value(hold_in_words(*s.beat)) : Value(),
                         holds ? Value(s.beat->shields) : Value(), 100 * s.fraction,
                         s.worker && s.beat ? Value(s.beat->steps_per_second) : Value(),
                         s.worker ? Value(fmt::format("pid {} on {}", s.worker->pid, s.worker->host)) : Value(),
                         s.core_hours_left, s.entry->message});
  }
  return rows;
}

std::string summary_of(const std::vector<Standing>& all, const StudyPlace& place, double core_hours_spent) {
  std::map<std::string, int> counts;
  double left = 0;
  int workers = 0, cases = 0;
  for (const auto& s : all) {
    left += s.core_hours_left;
    if (s.entry->is_bed) continue;
    ++cases, ++counts[state_in_words(s)];
    workers += s.worker.has_value();
  }
  std::string text = fmt::format("{}: {}:", place.name, counted(cases, "case"));
  for (const auto& [state, count] : counts) text += fmt::format(" {} {},", count, state);
  text.back() = ';';
  text += fmt::format(" {:.3g} core-hours spent, about {:.2g} left", core_hours_spent, left);
  if (workers > 0) text += fmt::format(", about {} with {} at work", duration_text(3600 * left / workers), workers);
  return text;
}

void show(const StudyOptions& options, const StudyPlace& place) {
  const auto database = open_results(place);
  auto entries = read_cases(database);
  std::erase_if(entries, [](const CaseEntry& e) { return !e.in_study; });
  std::vector<Standing> all;
  for (const auto& entry : entries) all.push_back(standing_of(entry, place.directory));
  if (options.form == Form::table) {
    const auto spent = database.query("SELECT coalesce(sum(core_h), 0.0) FROM cost").rows[0][0];
    const auto* hours = std::get_if<double>(&spent);
    const auto scheduler = FileLock::holder(place.directory / "lock");
    fmt::print("{}\n", summary_of(all, place, hours ? *hours : 0));
    fmt::print("{}\n\n", scheduler
                             ? fmt::format("bedload run is at work: pid {} on {}", scheduler->pid, scheduler->host)
                             : "no `bedload run` is at work");
  }
  fmt::print("{}", printed(case_rows(all), options.form));
  const std::string unsteady = options.form == Form::table ? unsteady_holds(database) : "";
  if (!unsteady.empty()) fmt::print("\nwarning: {}\n", unsteady);
  std::fflush(stdout);
}

}   // namespace

int status_command(const StudyOptions& options, bool watch) {
  const auto place = find_study(options.study, options.out);
  const InterruptCounter interrupts;
  show(options, place);
  while (watch && InterruptCounter::count() == 0) {
    std::this_thread::sleep_for(std::chrono::seconds(2));
    if (InterruptCounter::count() > 0) break;
    fmt::print("{}", isatty(1) ? "\033[H\033[2J" : "\n");
    show(options, place);
  }
  return 0;
}

}   // namespace bedload

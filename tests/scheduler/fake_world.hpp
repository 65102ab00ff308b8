// A study whose workers are scripts and whose time is a number: the scheduler cannot tell it from the real one.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "base/durable_file.hpp"
#include "scheduler/interrupts.hpp"
#include "scheduler/request.hpp"
#include "scheduler/scheduler.hpp"
#include "tests/support/temporary_directory.hpp"

namespace bedload {

/// What one attempt does, from its start to its end.
struct Act {
  std::uint64_t gains = 0;   // steps that its last checkpoint lies ahead of where it began
  bool finishes = false;
  std::optional<Cause> says;      // what it writes as the cause; nothing = it dies without a word
  JobEnd end{};                   // as the system sees it
  std::uint64_t dies_after = 0;   // steps from its beginning to its last heartbeat
  double lasts = 10;              // [s]
  bool beats = true;
  bool opens = true;          // false: it dies before it has opened its attempt
  bool until_asked = false;   // works until it is asked to stop

  static Act finish() { return {100, true, Cause::finished}; }
  static Act killed(std::uint64_t gains) { return {gains, false, {}, {0, 0, 9}}; }
  static Act crash(std::uint64_t at) { return {0, false, {}, {0, 0, 11}, at}; }
  static Act error(Cause cause, int code) { return {0, false, cause, {0, code, 0}}; }
  static Act work_until_asked() { return {5, false, Cause::stopped, {0, 75, 0}, 5, 1e9, true, true, true}; }
};

inline Position read_position(const std::filesystem::path& directory) {
  Position p;
  if (!std::filesystem::exists(directory / "checkpoint")) return p;
  const std::string text = read_text(directory / "checkpoint");
  p.finished = text.find("finished") != std::string::npos;
  p.step = std::stoull(text);
  return p;
}

/// Plays scripts: by directory name, one act per attempt, the last one repeated; cases without a script finish at once.
class FakeExecutor : public Executor {
 public:
  JobId start(const Job& job) override {
    const std::string name = job.directory.filename().string();
    auto& script = scripts[name];
    const Act act = script.empty() ? Act::finish() : script.front();
    if (script.size() > 1) script.pop_front();
    Playing p{job.directory, act, now + act.lasts};
    p.from = read_position(job.directory).step;
    if (act.opens) {
      Attempt a = open_attempt(job.directory);
      a.from_step = p.from;
      a.pid = next_;
      write_attempt(job.directory, a);
    }
    playing_[next_] = p;
    started.push_back(name);
    most_at_once = std::max(most_at_once, playing_.size());
    return next_++;
  }

  std::vector<JobEnd> wait(double seconds) override {
    now += seconds;
    if (at_turn) at_turn();
    std::vector<JobEnd> ends;
    for (auto p = playing_.begin(); p != playing_.end();) {
      if (p->second.act.beats && now < p->second.until) beat(p->first, p->second);
      if (now < p->second.until) {
        ++p;
        continue;
      }
      ends.push_back(finish(p->first, p->second));
      p = playing_.erase(p);
    }
    return ends;
  }

  void ask_to_stop(JobId job) override {
    asked.push_back(playing_.at(job).directory.filename().string());
    if (playing_.at(job).act.until_asked) playing_.at(job).until = now + 2;
  }

  void kill(JobId job) override {
    auto& p = playing_.at(job);
    killed.push_back(p.directory.filename().string());
    p.act = Act::killed(0);
    p.act.beats = false;
    p.until = now + 2;
  }

  double now = 1000;
  std::map<std::string, std::deque<Act>> scripts;
  std::function<void()> at_turn;
  std::vector<std::string> started, asked, killed;   // directory names
  std::size_t most_at_once = 0;

 private:
  struct Playing {
    std::filesystem::path directory;
    Act act;
    double until = 0;
    std::uint64_t from = 0, beats = 0;
  };

  void beat(JobId pid, Playing& p) const {
    Heartbeat h;
    h.pid = pid;
    h.step = p.from + ++p.beats;
    h.phase = "ramp";
    h.planned_time = p.act.lasts;   // one second of model time per second
    h.time = now - (p.until - p.act.lasts);
    write_heartbeat(p.directory, h);
  }

  static JobEnd finish(JobId pid, Playing& p) {
    const Act& act = p.act;
    if (act.gains > 0 || act.finishes)
      publish(p.directory / "checkpoint", fmt::format("{}{}", p.from + act.gains, act.finishes ? " finished" : ""));
    if (act.finishes) publish(p.directory / "bed.h5", "a bed");   // a case does not mind
    if (act.opens && act.says) {
      Attempt a = read_attempts(p.directory).back();
      a.step = p.from + act.gains;
      close_attempt(p.directory, a, *act.says);
    } else if (act.beats) {
      p.beats = act.dies_after;
      Heartbeat h;
      h.pid = pid;
      h.step = p.from + act.dies_after;
      write_heartbeat(p.directory, h);
    }
    JobEnd end = act.end;
    end.job = pid;
    return end;
  }

  std::map<JobId, Playing> playing_;
  JobId next_ = 1 << 23;   // above every real process id
};

struct Listener : ProgressSink {
  void event(const std::string& line) override { events.push_back(line); }
  void update(const Progress& p) override { last = p; }
  bool heard(const std::string& part) const {
    return std::ranges::any_of(events, [&](const auto& e) { return e.find(part) != std::string::npos; });
  }
  std::vector<std::string> events;
  Progress last;
};

/// A study directory with its database, and a fresh scheduler for every run.
class FakeStudy {
 public:
  void add_bed(const std::string& id) { add(id, "", true); }
  void add_case(const std::string& id, const std::string& bed = {}) { add(id, bed, false); }

  RunOutcome run() {
    FakeExecutor& x = executor;
    x.started.clear();
    Database database(study / "study.db", Database::Mode::write);
    Ledger ledger(database, study);
    ledger.enrol(entries);
    const SchedulerWorld world{
        read_position,
        [this](Database&, const std::filesystem::path& d) {
          if (no_results) throw Error(ErrorKind::internal, "a bed without a surface");
          harvested.push_back(d.filename().string());
        },
        [this](Database&, const std::filesystem::path& d) { failures.push_back(d.filename().string()); },
        [this](const Database&) { return spares ? spares(harvested) : std::vector<std::string>(); },
        [&x] { return x.now; },
        [this] { return interrupts; }};
    return Scheduler(ledger, x, listener, world, options).run();
  }

  std::filesystem::path directory_of(const std::string& id) const { return study / "cases" / id; }
  std::string state_of(const std::string& id) const {
    for (const auto& e : read_cases(Database(study / "study.db", Database::Mode::query)))
      if (e.id == id) return std::string(word(e.state));
    return "none";
  }

  InMemoryDirectory temporary;
  std::filesystem::path study = temporary.path();
  FakeExecutor executor;
  Listener listener;
  SchedulerOptions options{2, {}, 60};
  std::vector<CaseEntry> entries;
  std::vector<std::string> harvested, failures;   // directories whose results, and whose failure, were recorded
  std::function<std::vector<std::string>(const std::vector<std::string>&)> spares;   // of those harvested so far
  int interrupts = 0;
  bool no_results = false;

 private:
  void add(const std::string& id, const std::string& bed, bool is_bed) {
    CaseEntry e;
    e.id = e.label = id;
    e.is_bed = is_bed;
    e.directory = "cases/" + id;
    e.bed = bed;
    e.parameters = "{}";
    entries.push_back(e);
    std::filesystem::create_directories(directory_of(id));
  }
};

}   // namespace bedload

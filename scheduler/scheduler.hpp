// The scheduler: takes the unfinished cases of a study through workers until all are done, failed, or it is stopped.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/durable_file.hpp"
#include "scheduler/executor.hpp"
#include "scheduler/heartbeat.hpp"
#include "scheduler/judgement.hpp"
#include "scheduler/ledger.hpp"
#include "scheduler/progress.hpp"
#include "scheduler/time_left.hpp"

namespace bedload {

/// The one live scheduler of a study holds this. Take it before the database is opened for writing.
/// Throws Error locked (73) with host, pid and age of the holder.
FileLock lock_study(const std::filesystem::path& study_directory);

struct SchedulerOptions {
  int cores = 1;
  std::vector<std::string> only;   // ids; empty = all. Beds that they need are prepared too.
  double stall_limit = 600;        // a worker whose heartbeat stands still for so long is killed [s]
};

/// What the scheduler is told about the world. Physics and time come in through here.
struct SchedulerWorld {
  /// Newest whole checkpoint of a case or bed directory; {0, false} if there is none. A bed is finished once its
  /// directory holds bed.h5. May throw Error corrupt.
  std::function<Position(const std::filesystem::path& directory)> newest;
  /// Writes the results of a finished case (not of a bed), within the transaction that marks it done.
  std::function<void(Database&, const std::filesystem::path& case_directory)> on_finished;
  /// Writes what is worth knowing of a case (not of a bed) that failed.
  std::function<void(Database&, const std::filesystem::path& case_directory)> on_failed;
  /// Ids of the cases that nobody needs as far as the results go that are stored; others may be needed later. Asked for
  /// whenever a case has finished.
  std::function<std::vector<std::string>(const Database&)> spares;
  std::function<double()> clock;     // monotonic [s]
  std::function<int()> interrupts;   // how often the user has pressed Ctrl-C so far: InterruptCounter::count
};

struct RunOutcome {
  int done = 0, failed = 0, left = 0;   // cases (without beds) that were asked for
  /// 0 all done; 1 some failed; 74 set aside by a disk error; 75 stopped with work left; 130 killed.
  int exit_code = 0;
};

class Scheduler {
 public:
  Scheduler(Ledger&, Executor&, ProgressSink&, SchedulerWorld, SchedulerOptions);

  /// Compares the ledger with the case directories, harvests what finished meanwhile and adopts workers that live on.
  /// `run` begins with it.
  void reconcile();
  RunOutcome run();

 private:
  struct Work {
    CaseEntry entry;
    std::filesystem::path directory;
    bool wanted = false;         // to be worked on in this run
    bool set_aside = false;      // not again in this run
    bool disk_refused = false;   // and that is why
    double not_before = 0;       // on the clock [s]: a pause after an attempt without progress
    double fraction = 0;         // of its planned time, as far as is known
  };
  struct Running {
    std::size_t work = 0;
    bool adopted = false;   // started by an earlier scheduler: its lock is watched
    JobId job = 0;          // if not adopted
    int attempt = 0;        // the number it is expected to have
    std::optional<Heartbeat> heartbeat;
    double changed = 0;   // when the heartbeat last changed, on the clock [s]
    bool alive = false;   // it has changed since this scheduler watches
    std::optional<double> first_fraction;
    double first_seen = 0;   // when that was, on the clock [s]
    bool asked = false, silenced = false;
  };

  void inspect(Work&);
  void adopt(Work&, const LockHolder&);
  void set_spares();
  void want_beds();
  void start_what_can_be();
  bool bed_ready(Work&);
  void start(Work&);
  bool more_to_start() const;
  void heed_interrupts();
  void stop(Running&);
  void kill(const Running&);
  void watch();
  void look_at(Running&);
  void ended(const Running&, const JobEnd*);
  std::vector<Attempt> completed_attempts(const Running&, const JobEnd*);
  void settle(Work&, const std::vector<Attempt>&, bool asked);
  void harvest(Work&, const std::vector<Attempt>&);
  void set_state(Work&, CaseState, const std::string& message = {});
  Work* find(const std::string& id);
  Progress progress();
  UnfinishedCase pace_of(const Running&) const;
  RunningCase line_of(const Running&) const;
  RunOutcome outcome() const;

  Ledger* ledger_;
  Executor* executor_;
  ProgressSink* sink_;
  SchedulerWorld world_;
  SchedulerOptions options_;
  std::vector<Work> works_;   // in order of enrolment
  std::vector<Running> running_;
  TimeLeft time_left_;
  double began_ = 0;
  bool stopping_ = false, killed_ = false;
};

}   // namespace bedload

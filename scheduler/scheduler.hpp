// The scheduler: takes the unfinished cases of a study through workers until all are done, failed, or it is stopped.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "base/durable_file.hpp"
#include "scheduler/executor.hpp"
#include "scheduler/heartbeat.hpp"
#include "scheduler/judgement.hpp"
#include "scheduler/ledger.hpp"
#include "scheduler/progress.hpp"

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
  std::function<double()> clock;     // monotonic [s]
  std::function<int()> interrupts;   // how often the user has pressed Ctrl-C so far
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
    bool wanted = false;          // to be worked on in this run
    bool set_aside = false;
    double not_before = 0;        // on the clock [s]: pause after an attempt without progress
    double first_fraction = 0;    // where this run found it, for the time left
    double first_seen = -1;
  };
  struct Running {
    std::size_t work = 0;
    bool adopted = false;         // of an earlier scheduler: its lock is watched
    JobId job = 0;                // if not adopted
    int attempt = 0;              // expected number
    Heartbeat heartbeat;          // the last
    double changed = 0;           // when it last changed, on the clock [s]
    bool asked = false, silenced = false;
  };

  void start_what_can_be();
  bool start(std::size_t work);
  bool bed_ready(const Work&);
  void want_beds();
  void watch();
  void ask_all_to_stop();
  void kill_all();
  void ended(const Running&, const JobEnd*);
  void settle(Work&, const Judgement&, const std::vector<Attempt>&);
  void harvest(Work&);
  Progress progress() const;

  Ledger* ledger_;
  Executor* executor_;
  ProgressSink* sink_;
  SchedulerWorld world_;
  SchedulerOptions options_;
  std::vector<Work> works_;       // in order of enrolment
  std::vector<Running> running_;
  double began_ = 0;
  bool stopping_ = false;
};

/// Counts SIGINT and SIGTERM instead of dying of them, while it lives. One at a time.
class InterruptCounter {
 public:
  InterruptCounter();
  ~InterruptCounter();
  InterruptCounter(const InterruptCounter&) = delete;
  InterruptCounter& operator=(const InterruptCounter&) = delete;
  static int count();
};

}  // namespace bedload

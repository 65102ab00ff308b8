// Where workers run: the seam between the scheduler and processes, batch systems, or a fake in tests.
#pragma once

#include <filesystem>
#include <vector>

namespace bedload {

/// One attempt at one case.
struct Job {
  std::filesystem::path directory;   // of the case; the worker's output goes to log.<attempt> in it
  int attempt = 1;                   // the number that the worker is expected to take
  int cores = 1;
};

using JobId = int;

/// How a job ended, as the system saw it; the case directory knows better (see judgement.hpp).
struct JobEnd {
  JobId job = 0;
  int exit_code = 0;   // meaningful if signal == 0
  int signal = 0;
};

class Executor {
 public:
  virtual ~Executor() = default;

  /// Starts a worker that outlives this process. Throws Error unavailable if the program cannot be started,
  /// io if its files cannot be written.
  virtual JobId start(const Job&) = 0;
  /// Waits until a job ends, a signal arrives, or `seconds` have passed; all jobs that have ended meanwhile.
  virtual std::vector<JobEnd> wait(double seconds) = 0;
  /// Asks a worker to write a checkpoint and end (exit code 75).
  virtual void ask_to_stop(JobId) = 0;
  /// Ends a worker and all that it started, at once.
  virtual void kill(JobId) = 0;
};

}   // namespace bedload

// Signals that ask to stop in good order: a worker with a checkpoint, the ladder with the rows it has.
#pragma once

namespace bedload {

/// While one lives, SIGUSR1, SIGTERM and SIGINT are noted instead of ending the process.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  static bool arrived();
  /// From now on a signal ends the process again: for who has seen the first and is stopping.
  static void release();
};

}   // namespace bedload

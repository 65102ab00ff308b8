// Signals that ask a worker to write a checkpoint and stop.
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
};

}   // namespace bedload

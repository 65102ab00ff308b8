// Ctrl-C as a number that the scheduler reads, instead of the end of the process.
#pragma once

#include <csignal>

namespace bedload {

/// Counts SIGINT and SIGTERM while it lives; they also end a wait in progress. One at a time.
class InterruptCounter {
 public:
  InterruptCounter();
  ~InterruptCounter();
  InterruptCounter(const InterruptCounter&) = delete;
  InterruptCounter& operator=(const InterruptCounter&) = delete;

  static int count();   // since the last one was made

 private:
  struct sigaction interrupt_before_ {
  }, terminate_before_{};
};

}   // namespace bedload

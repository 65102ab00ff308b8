// What a calculation costs, on a machine that is shared.
#pragma once

#include <ctime>

namespace bedload {

/// CPU time that this thread has used [s]; differences of it are less than the time that passes.
inline double thread_seconds() {
  struct timespec spent {};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &spent);
  return static_cast<double>(spent.tv_sec) + 1e-9 * static_cast<double>(spent.tv_nsec);
}

}   // namespace bedload

// The last heartbeat as the worker's last words.
#include "scheduler/last_words.hpp"

#include "scheduler/heartbeat.hpp"

namespace bedload {

void close_for_the_dead(const std::filesystem::path& directory, Attempt& attempt, Cause cause,
                        const std::string& message) {
  const auto heartbeat = read_heartbeat(directory);
  if (heartbeat && heartbeat->pid == attempt.pid) {   // else it is of an attempt before
    attempt.step = heartbeat->step;
    attempt.core_seconds = heartbeat->core_seconds;
  }
  attempt.cause = cause;
  attempt.message = message;
  attempt.end = utc_now();
  write_attempt(directory, attempt);
}

}   // namespace bedload

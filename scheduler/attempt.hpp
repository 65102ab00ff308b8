// attempt.<n>.json: the record of one attempt at a case, and the fence that lets one attempt publish at a time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"

namespace bedload {

/// Why an attempt ended. `running` = not yet, or it was killed before it could say.
enum class Cause {
  running,
  finished,
  stopped,
  wall_limit,
  crash,
  killed,
  out_of_memory,
  user_error,
  numerical,
  io,
  corrupt,
  fenced
};
std::string_view word(Cause);
/// What a worker that ends by this error writes into its attempt.
Cause cause_of(ErrorKind);

/// One attempt. The worker writes it at its start and at its end; for a worker that died without a word whoever finds
/// the case next, holding its lock or having reaped the process, writes the end.
struct Attempt {
  int number = 0;
  std::string host;
  std::int64_t pid = 0;
  std::string boot_id;      // of the host's kernel: a pid means nothing after a reboot
  std::string start, end;   // UTC, ISO 8601; end is empty while it runs
  Cause cause = Cause::running;
  std::string message;                      // of the error that ended it
  std::optional<std::uint64_t> from_step;   // of the checkpoint it continued or bed it began on; unknown until read
  std::optional<std::uint64_t> step;        // reached; after a crash, that of the last heartbeat
  double core_seconds = 0;                  // CPU time; after a crash, that of the last heartbeat
  std::string version, compiler;            // of the bedload that ran
};

/// Claims the next number, filled in for this process and this moment. The caller holds the case's lock; where network
/// file systems break locks the number still goes to one only. Throws Error fenced if another took it, io.
Attempt open_attempt(const std::filesystem::path& case_directory);

/// Replaces the attempt's file, durably. Throws Error io.
void write_attempt(const std::filesystem::path& case_directory, const Attempt&);
/// write_attempt with the cause, and now as the end.
void close_attempt(const std::filesystem::path& case_directory, Attempt, Cause, const std::string& message = {});

/// All attempts in order of their numbers. Throws Error corrupt for a file that is no attempt.
std::vector<Attempt> read_attempts(const std::filesystem::path& case_directory);

/// 0 = none. A worker publishes only while this is its own number, else it ends with exit code 82.
int highest_attempt(const std::filesystem::path& case_directory);

/// Now, in UTC: 2026-03-04T05:06:07Z.
std::string utc_now();
/// Name of this host.
std::string host_name();
/// Identity of this boot of the host's kernel.
std::string boot_id();

}   // namespace bedload

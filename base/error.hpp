// The one exception of the program: a closed set of kinds, each with its exit code.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace bedload {

/// What went wrong, as a caller can act on it. The value is the exit code of the process.
enum class ErrorKind : int {
  some_failed = 1,      // some cases failed, the rest are complete
  usage = 2,            // command line
  study_invalid = 65,   // the study file (or a file it names) cannot be used
  not_found = 66,       // a named study, case or file does not exist
  unavailable = 69,     // a needed service or feature is missing
  internal = 70,        // a fault of bedload itself
  locked = 73,          // held by a live process
  io = 74,              // disk full, unwritable directory
  stopped = 75,         // stopped with work left: run again
  corrupt = 76,         // a checkpoint is broken and no older one helps, or a newer bedload wrote it
  numerical = 80,       // the physics of a run left its domain
  fenced = 82,          // another attempt owns the case
};

/// Message = fact with values, where, what would be accepted; `hint` = the likely fix (may be empty).
struct Error : std::runtime_error {
  Error(ErrorKind kind_, const std::string& message, std::string hint_ = {})
      : std::runtime_error(message), kind(kind_), hint(std::move(hint_)) {}
  int exit_code() const { return static_cast<int>(kind); }

  ErrorKind kind;
  std::string hint;
};

}   // namespace bedload

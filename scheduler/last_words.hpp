// The end of an attempt whose worker died without writing it.
#pragma once

#include <filesystem>
#include <string>

#include "scheduler/attempt.hpp"

namespace bedload {

/// Completes the attempt, also on disk, from the worker's last heartbeat. Only for the case's owner: whoever reaped the
/// worker, or found its lock free.
void close_for_the_dead(const std::filesystem::path& case_directory, Attempt&, Cause, const std::string& message);

}   // namespace bedload

// The worker: takes one case directory to a newer checkpoint.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace bedload {

struct RunCaseRequest {
  std::filesystem::path directory;
  std::optional<double> until;   // model time of the ramp at which to stop [s]
  std::function<void(const std::string&)>
      report;   // lines for people: the scene, the state, the performance at the end
};

/// Runs the case until it is finished, `until` is reached, or it is asked to stop (SIGUSR1, SIGTERM, SIGINT, a request
/// file): then it writes a checkpoint. Returns the exit code: 0 finished or `until` reached, 75 stopped with work left.
/// Throws Error: locked (another worker runs it), fenced (another took it over), numerical, corrupt, io, not_found,
/// study_invalid; the attempt's file says so too.
int run_case(const RunCaseRequest&);

}   // namespace bedload

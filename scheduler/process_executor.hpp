// Workers as processes of this machine, each in a session of its own.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scheduler/executor.hpp"

namespace bedload {

/// Runs `command` + case directory, e.g. {"/usr/bin/bedload", "case"}. A worker has its own session (the terminal's
/// Ctrl-C and the scheduler's end do not reach it), standard output and error in log.<n>, and a TMPDIR of its own.
class ProcessExecutor : public Executor {
 public:
  explicit ProcessExecutor(std::vector<std::string> command);
  ~ProcessExecutor() override;   // leaves its workers running

  JobId start(const Job&) override;
  std::vector<JobEnd> wait(double seconds) override;
  void ask_to_stop(JobId) override;   // SIGUSR1 to the process
  void kill(JobId) override;          // SIGKILL to its process group

 private:
  struct Child {
    int descriptor = -1;   // pidfd: readable when the process has ended
    std::filesystem::path temporary;
  };
  std::vector<std::string> command_;
  std::map<JobId, Child> children_;   // by process id, which is the job's id
};

}   // namespace bedload

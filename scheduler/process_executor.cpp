// Starting, awaiting and ending worker processes with posix_spawn and pidfds.
#include "scheduler/process_executor.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>

#include "base/digest.hpp"
#include "base/error.hpp"

namespace bedload {
namespace {

namespace fs = std::filesystem;

/// The same directory for every attempt at a case, so that the next one clears away what a killed one left.
fs::path temporary_of(const fs::path& case_directory) {
  const std::string name = Digest().add(std::string_view(fs::absolute(case_directory).native())).hex();
  return fs::temp_directory_path() / fmt::format("bedload-{}-{}", ::getuid(), name.substr(0, 16));
}

void make_empty(const fs::path& directory) {
  std::error_code problem;
  fs::remove_all(directory, problem);
  if (::mkdir(directory.c_str(), 0700) != 0)
    throw Error(ErrorKind::io, fmt::format("cannot create {}: {}", directory.string(), std::strerror(errno)),
                "check TMPDIR, and who owns that directory");
}

std::vector<std::string> environment_with(const fs::path& temporary) {
  std::vector<std::string> variables;
  for (char** v = environ; *v; ++v)
    if (!std::string_view(*v).starts_with("TMPDIR=")) variables.emplace_back(*v);
  variables.push_back("TMPDIR=" + temporary.string());
  return variables;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  result.reserve(texts.size() + 1);
  for (auto& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

/// What the child does between fork and exec: own session, default signals, nothing to read, its output to the log.
struct Preparation {
  explicit Preparation(const fs::path& log)
      : output(::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644)) {
    if (output < 0) throw Error(ErrorKind::io, fmt::format("cannot write {}: {}", log.string(), std::strerror(errno)));
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
    sigset_t signals;
    sigfillset(&signals);
    posix_spawnattr_setsigdefault(&attributes, &signals);
    sigemptyset(&signals);
    posix_spawnattr_setsigmask(&attributes, &signals);
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, output, STDERR_FILENO);
  }
  ~Preparation() {
    ::close(output);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
  }
  Preparation(const Preparation&) = delete;
  Preparation& operator=(const Preparation&) = delete;

  int output;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_t actions;
};

JobEnd end_of(pid_t pid, int status) {
  return WIFSIGNALED(status) ? JobEnd{pid, 0, WTERMSIG(status)} : JobEnd{pid, WEXITSTATUS(status), 0};
}

}   // namespace

ProcessExecutor::ProcessExecutor(std::vector<std::string> command) : command_(std::move(command)) {}

ProcessExecutor::~ProcessExecutor() {
  for (const auto& [pid, child] : children_) ::close(child.descriptor);
}

JobId ProcessExecutor::start(const Job& job) {
  const fs::path temporary = temporary_of(job.directory);
  make_empty(temporary);
  auto command = command_;
  command.push_back(job.directory.string());
  auto environment = environment_with(temporary);
  const Preparation preparation(job.directory / fmt::format("log.{}", job.attempt));
  pid_t pid = 0;
  const int problem = ::posix_spawnp(&pid, command[0].c_str(), &preparation.actions, &preparation.attributes,
                                     pointers(command).data(), pointers(environment).data());
  if (problem != 0)
    throw Error(ErrorKind::unavailable,
                fmt::format("cannot start {} for {}: {}", command[0], job.directory.string(), std::strerror(problem)));
  const auto descriptor =
      static_cast<int>(::syscall(SYS_pidfd_open, pid, 0));   // glibc 2.36 declares it without C linkage
  children_[pid] = {descriptor, temporary};   // without pidfds (-1) `wait` sees the end when its time is up
  return pid;
}

std::vector<JobEnd> ProcessExecutor::wait(double seconds) {
  std::vector<pollfd> watched;
  for (const auto& [pid, child] : children_) watched.push_back({child.descriptor, POLLIN, 0});
  ::poll(watched.data(), watched.size(), static_cast<int>(std::ceil(seconds * 1000)));
  std::vector<JobEnd> ends;
  for (auto child = children_.begin(); child != children_.end();) {
    int status = 0;
    if (::waitpid(child->first, &status, WNOHANG) != child->first) {
      ++child;
      continue;
    }
    ends.push_back(end_of(child->first, status));
    ::close(child->second.descriptor);
    std::error_code ignored;   // cleared away by the next attempt
    fs::remove_all(child->second.temporary, ignored);
    child = children_.erase(child);
  }
  return ends;
}

void ProcessExecutor::ask_to_stop(JobId job) {
  if (children_.contains(job)) ::kill(job, SIGUSR1);
}

void ProcessExecutor::kill(JobId job) {
  if (children_.contains(job)) ::kill(-job, SIGKILL);
}

}   // namespace bedload

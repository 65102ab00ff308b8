// The real binary, run as a user runs it.
#pragma once

#include <sys/wait.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

namespace bedload {

inline std::string contents(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

struct Outcome {
  int code = -1;   // exit code, or 128 + signal
  std::string out, err;
};

/// A running bedload.
class Process {
 public:
  Process(const std::filesystem::path& working_directory, const std::vector<std::string>& arguments)
      : directory_(working_directory), pid_(::fork()) {
    if (pid_ == 0) become(arguments);
  }
  ~Process() {
    if (pid_ > 0) ::kill(pid_, SIGKILL), wait();
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  pid_t pid() const { return pid_; }
  Outcome wait() {
    int status = 0;
    ::waitpid(pid_, &status, 0);
    pid_ = -1;
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), contents(directory_ / ".out"),
            contents(directory_ / ".err")};
  }

 private:
  [[noreturn]] void become(const std::vector<std::string>& arguments) const {
    if (::chdir(directory_.c_str()) != 0) ::_exit(126);
    ::dup2(::open(".out", O_WRONLY | O_CREAT | O_TRUNC, 0644), 1);
    ::dup2(::open(".err", O_WRONLY | O_CREAT | O_TRUNC, 0644), 2);
    std::vector<char*> argv{const_cast<char*>(BEDLOAD_EXECUTABLE)};
    for (const auto& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
    argv.push_back(nullptr);
    ::execv(BEDLOAD_EXECUTABLE, argv.data());
    ::_exit(127);
  }

  std::filesystem::path directory_;
  pid_t pid_;
};

inline Outcome bedload(const std::filesystem::path& working_directory, const std::vector<std::string>& arguments) {
  return Process(working_directory, arguments).wait();
}

}   // namespace bedload

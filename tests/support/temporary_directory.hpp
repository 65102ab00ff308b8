// A directory of a test's own, gone when the test ends.
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace bedload {

class TemporaryDirectory {
 public:
  explicit TemporaryDirectory(const std::filesystem::path& parent = std::filesystem::temp_directory_path()) {
    std::string name = (parent / "bedload-test-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make " + name);
    path_ = name;
  }
  ~TemporaryDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// In memory where it can be: hundreds of fsyncs take seconds on a busy disk.
class InMemoryDirectory : public TemporaryDirectory {
 public:
  InMemoryDirectory()
      : TemporaryDirectory(::access("/dev/shm", W_OK | X_OK) == 0 ? "/dev/shm"
                                                                  : std::filesystem::temp_directory_path()) {}
};

}   // namespace bedload

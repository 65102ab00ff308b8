// A file descriptor that closes itself, and the error that a failed system call becomes.
#pragma once

#include <filesystem>
#include <string_view>
#include <utility>

#include <unistd.h>

namespace bedload {

/// Throws Error io: "cannot <verb> <path>: <what errno means>", with the likely remedy.
[[noreturn]] void throw_io(std::string_view verb, const std::filesystem::path&, int error);

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  int get() const { return fd_; }

 private:
  int fd_;
};

}   // namespace bedload

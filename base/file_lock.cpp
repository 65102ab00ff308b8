// A lock that the kernel keeps for its holder, and the words the holder leaves in the file.
#include <algorithm>
#include <array>
#include <cerrno>
#include <ctime>
#include <sstream>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "base/descriptor.hpp"
#include "base/durable_file.hpp"
#include "base/error.hpp"

namespace bedload {

namespace fs = std::filesystem;

namespace {

struct flock whole_file(short kind) {
  struct flock lock {};
  lock.l_type = kind;
  lock.l_whence = SEEK_SET;
  return lock;
}

void sign(int fd) {
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  const std::string text = fmt::format("{} {} {}\n", host.data(), ::getpid(), std::time(nullptr));
  // The words are for people, the lock is the kernel's: a disk too full for them is no reason to refuse it.
  [[maybe_unused]] const bool signed_ = ::ftruncate(fd, 0) == 0 && ::pwrite(fd, text.data(), text.size(), 0) > 0;
}

LockHolder read_signature(int fd) {
  std::string text(512, '\0');
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(0, ::pread(fd, text.data(), text.size(), 0))));
  LockHolder holder;
  std::istringstream(text) >> holder.host >> holder.pid >> holder.since;
  return holder;
}

std::string duration(std::int64_t seconds) {
  if (seconds < 120) return fmt::format("{} s", seconds);
  if (seconds < 7200) return fmt::format("{} min", seconds / 60);
  return fmt::format("{} h", seconds / 3600);
}

}   // namespace

std::string describe(const LockHolder& h, std::int64_t now) {
  if (h.host.empty()) return "a process that has not given its name";
  return fmt::format("pid {} on host {}, for {}", h.pid, h.host, duration(std::max<std::int64_t>(0, now - h.since)));
}

std::optional<FileLock> FileLock::try_lock(const fs::path& path) {
  Descriptor file(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
  if (file.get() < 0) throw_io("open", path, errno);
  struct flock lock = whole_file(F_WRLCK);
  if (::fcntl(file.get(), F_OFD_SETLK, &lock) != 0) {
    if (errno != EAGAIN && errno != EACCES) throw_io("lock", path, errno);
    return std::nullopt;
  }
  sign(file.get());
  return FileLock(std::move(file));
}

std::optional<LockHolder> FileLock::holder(const fs::path& path) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0 && errno == ENOENT) return std::nullopt;
  struct flock lock = whole_file(F_WRLCK);
  if (file.get() < 0 || ::fcntl(file.get(), F_OFD_GETLK, &lock) != 0) throw_io("ask for the lock on", path, errno);
  if (lock.l_type == F_UNLCK) return std::nullopt;
  return read_signature(file.get());
}

FileLock FileLock::lock_or_refuse(const fs::path& path, const std::string& what) {
  if (auto lock = try_lock(path)) return std::move(*lock);
  const LockHolder other = holder(path).value_or(LockHolder{});
  throw Error(ErrorKind::locked, fmt::format("{} is in use by {}", what, describe(other, std::time(nullptr))),
              "wait for it, or stop it (Ctrl-C, or SIGTERM to that pid) and run again");
}

}   // namespace bedload

// Publishing and reading with plain POSIX calls.
#include "base/durable_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/descriptor.hpp"
#include "base/digest.hpp"
#include "base/error.hpp"

namespace bedload {

namespace fs = std::filesystem;

void throw_io(std::string_view verb, const fs::path& path, int error) {
  const char* hint = "";
  if (error == ENOSPC || error == EDQUOT) hint = "free some space, then run again: nothing that was complete is lost";
  if (error == EACCES || error == EPERM || error == EROFS) hint = "check the permissions, or choose another directory";
  if (error == EMFILE || error == ENFILE) hint = "raise the limit on open files (ulimit -n)";
  throw Error(ErrorKind::io, fmt::format("cannot {} {}: {}", verb, path.string(), std::strerror(error)), hint);
}

namespace {

DiskFault disk_fault;

constexpr std::string_view temporary_ending = ".tmp~";

/// True if the fault point lets the operation pass, else errno is set as the operation would.
bool passes(DiskStep step, const fs::path& path) {
  const int error = disk_fault ? disk_fault(step, path) : 0;
  if (error != 0) errno = error;
  return error == 0;
}

/// A file under a temporary name, removed unless it has been given its final one.
class Temporary {
 public:
  explicit Temporary(const fs::path& target)
      : target_(target), path_(fmt::format("{}.{}{}", target.string(), ::getpid(), temporary_ending)) {}
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  ~Temporary() { ::unlink(path_.c_str()); }

  /// Written anew from the start: after a failed fsync the kernel may have dropped pages, so nothing is ever retried.
  void fill(std::span<const std::byte> bytes, bool sync) const {
    constexpr int flags = O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC;
    const Descriptor file(passes(DiskStep::create, target_) ? ::open(path_.c_str(), flags, 0666) : -1);
    if (file.get() < 0) throw_io("create", path_, errno);
    while (!bytes.empty()) {
      const auto piece = bytes.first(std::min<std::size_t>(bytes.size(), 1 << 20));
      const ssize_t written = passes(DiskStep::write, target_) ? ::write(file.get(), piece.data(), piece.size()) : -1;
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) throw_io("write", target_, errno);
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    if (sync && (!passes(DiskStep::sync, target_) || ::fsync(file.get()) != 0)) throw_io("write", target_, errno);
  }

  void replace_target() const {
    const bool done = passes(DiskStep::rename, target_) && ::rename(path_.c_str(), target_.c_str()) == 0;
    if (!done) throw_io("write", target_, errno);
  }

  bool become_target_if_none() const {
    if (passes(DiskStep::rename, target_) && ::link(path_.c_str(), target_.c_str()) == 0) return true;
    if (errno != EEXIST) throw_io("create", target_, errno);
    // A network file system may do the link, lose its answer, and refuse the repeated call: two names show who has won.
    struct stat info;
    return ::stat(path_.c_str(), &info) == 0 && info.st_nlink == 2;
  }

 private:
  fs::path target_, path_;
};

fs::path directory_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

/// Without this a new name may be lost with the power, though its bytes are safe.
void sync_directory(const fs::path& directory) {
  const Descriptor d(::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (d.get() < 0) throw_io("open", directory, errno);
  if (!passes(DiskStep::sync_directory, directory) || ::fsync(d.get()) != 0) throw_io("write", directory, errno);
}

}   // namespace

void set_disk_fault(DiskFault fault) { disk_fault = std::move(fault); }

void publish(const fs::path& path, std::span<const std::byte> bytes) {
  const Temporary file(path);
  file.fill(bytes, true);
  file.replace_target();
  sync_directory(directory_of(path));
}

void publish(const fs::path& path, std::string_view text) { publish(path, bytes_of(text)); }

bool publish_once(const fs::path& path, std::string_view text) {
  const Temporary file(path);
  file.fill(bytes_of(text), true);
  const bool first = file.become_target_if_none();
  if (first) sync_directory(directory_of(path));
  return first;
}

void publish_unsynced(const fs::path& path, std::string_view text) {
  const Temporary file(path);
  file.fill(bytes_of(text), false);
  file.replace_target();
}

void remove_stray_temporaries(const fs::path& directory) {
  std::vector<fs::path> strays;
  for (const auto& entry : fs::directory_iterator(directory)) {
    if (entry.path().native().ends_with(temporary_ending)) strays.push_back(entry.path());
  }
  for (const auto& stray : strays) ::unlink(stray.c_str());
}

std::vector<std::byte> read_file(const fs::path& path) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0 && (errno == ENOENT || errno == ENOTDIR)) {
    throw Error(ErrorKind::not_found, fmt::format("there is no file {}", path.string()));
  }
  struct stat info;
  if (file.get() < 0 || ::fstat(file.get(), &info) != 0) throw_io("read", path, errno);
  std::vector<std::byte> bytes(static_cast<std::size_t>(info.st_size));
  std::size_t have = 0;
  for (;;) {   // until end of file: some files (pipes, /proc) do not know their size
    if (have == bytes.size()) bytes.resize(have + 4096);
    const ssize_t got = ::read(file.get(), bytes.data() + have, bytes.size() - have);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw_io("read", path, errno);
    if (got == 0) break;
    have += static_cast<std::size_t>(got);
  }
  bytes.resize(have);
  return bytes;
}

std::string read_text(const fs::path& path) {
  const auto bytes = read_file(path);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void make_writable_directory(const fs::path& directory) {
  std::error_code problem;
  fs::create_directories(directory, problem);
  if (problem) throw_io("create", directory, problem.value());
  // A file, not access(2): that knows permissions alone, and of root none.
  auto trial = (directory / fmt::format("writable-XXXXXX{}", temporary_ending)).string();
  const Descriptor file(::mkstemps(trial.data(), static_cast<int>(temporary_ending.size())));
  if (file.get() < 0) throw_io("write to", directory, errno);
  ::unlink(trial.c_str());
}

}   // namespace bedload

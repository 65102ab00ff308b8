// Publishing, sealing and locking with plain POSIX calls.
#include "base/durable_file.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <ctime>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/digest.hpp"
#include "base/error.hpp"

namespace bedload {

namespace fs = std::filesystem;

namespace {

DiskFault disk_fault;

constexpr std::string_view temporary_ending = ".tmp~";

/// Throws what errno says about a path.
[[noreturn]] void fail(std::string_view verb, const fs::path& path, int error) {
  const char* hint = "";
  if (error == ENOSPC || error == EDQUOT) hint = "free some space, then run again: nothing that was complete is lost";
  if (error == EACCES || error == EPERM || error == EROFS) hint = "check the permissions, or choose another directory";
  if (error == EMFILE || error == ENFILE) hint = "raise the limit on open files (ulimit -n)";
  throw Error(ErrorKind::io, fmt::format("cannot {} {}: {}", verb, path.string(), std::strerror(error)), hint);
}

/// True if the fault point lets the operation pass, else errno is set as the operation would.
bool passes(DiskStep step, const fs::path& path) {
  const int error = disk_fault ? disk_fault(step, path) : 0;
  if (error != 0) errno = error;
  return error == 0;
}

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  int get() const { return fd_; }
  int release() { return std::exchange(fd_, -1); }

 private:
  int fd_;
};

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
    if (file.get() < 0) fail("create", path_, errno);
    while (!bytes.empty()) {
      const auto piece = bytes.first(std::min<std::size_t>(bytes.size(), 1 << 20));
      const ssize_t written = passes(DiskStep::write, target_) ? ::write(file.get(), piece.data(), piece.size()) : -1;
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail("write", target_, errno);
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    if (sync && (!passes(DiskStep::sync, target_) || ::fsync(file.get()) != 0)) fail("write", target_, errno);
  }

  void replace_target() const {
    if (!passes(DiskStep::rename, target_) || ::rename(path_.c_str(), target_.c_str()) != 0) fail("write", target_, errno);
  }

  bool become_target_if_none() const {
    if (passes(DiskStep::rename, target_) && ::link(path_.c_str(), target_.c_str()) == 0) return true;
    if (errno != EEXIST) fail("create", target_, errno);
    return false;
  }

 private:
  fs::path target_, path_;
};

fs::path directory_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

/// Without this a new name may be lost with the power, though its bytes are safe.
void sync_directory(const fs::path& directory) {
  const Descriptor d(::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (d.get() < 0) fail("open", directory, errno);
  if (!passes(DiskStep::sync_directory, directory) || ::fsync(d.get()) != 0) fail("write", directory, errno);
}

}  // namespace

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
  if (file.get() < 0 || ::fstat(file.get(), &info) != 0) fail("read", path, errno);
  std::vector<std::byte> bytes(static_cast<std::size_t>(info.st_size));
  std::size_t have = 0;
  for (;;) {   // until end of file: some files (pipes, /proc) do not know their size
    if (have == bytes.size()) bytes.resize(have + 4096);
    const ssize_t got = ::read(file.get(), bytes.data() + have, bytes.size() - have);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail("read", path, errno);
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
  if (problem) fail("create", directory, problem.value());
  if (::access(directory.c_str(), W_OK | X_OK) != 0) fail("write to", directory, errno);
}

// ---- seal ----

namespace {
constexpr std::string_view seal_magic = "bdl-seal";
constexpr std::size_t seal_size = 8 + 8 + 32;
}  // namespace

void append_seal(std::vector<std::byte>& bytes) {
  const std::uint64_t length = bytes.size();
  const auto hash = Digest().add(bytes).bytes();
  const auto append = [&](std::span<const std::byte> part) { bytes.insert(bytes.end(), part.begin(), part.end()); };
  append(bytes_of(seal_magic));
  append(std::as_bytes(std::span(&length, 1)));
  append(hash);
}

std::span<const std::byte> open_seal(std::span<const std::byte> sealed, const std::string& name) {
  const auto refuse = [&](std::string_view why) { throw Error(ErrorKind::corrupt, fmt::format("{} {}", name, why)); };
  if (sealed.size() < seal_size) refuse(fmt::format("is cut short: {} bytes cannot hold a seal", sealed.size()));
  const auto payload = sealed.first(sealed.size() - seal_size);
  const auto seal = sealed.last(seal_size);
  std::uint64_t length;
  std::memcpy(&length, seal.data() + 8, 8);
  if (!std::ranges::equal(seal.first(8), bytes_of(seal_magic))) refuse("does not end in a seal: cut short, or no checkpoint");
  if (length != payload.size()) refuse(fmt::format("was sealed at {} bytes and has {}", length, payload.size()));
  if (!std::ranges::equal(seal.last(32), Digest().add(payload).bytes())) {
    refuse("is damaged: its bytes do not match the SHA-256 of its seal");
  }
  return payload;
}

// ---- lock ----

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
  // The words are for people; the lock itself is the kernel's. A disk too full for them is no reason to refuse it.
  if (::ftruncate(fd, 0) == 0 && ::pwrite(fd, text.data(), text.size(), 0) < 0) errno = 0;
}

LockHolder read_signature(int fd) {
  std::array<char, 512> text{};
  if (::pread(fd, text.data(), text.size() - 1, 0) <= 0) return {};
  LockHolder holder;
  std::string_view rest(text.data());
  const auto word = [&rest] {
    const auto end = std::min(rest.find_first_of(" \n"), rest.size());
    const auto found = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    return found;
  };
  const auto number = [&word](std::int64_t& value) {
    const auto digits = word();
    std::from_chars(digits.data(), digits.data() + digits.size(), value);
  };
  holder.host = word();
  number(holder.pid);
  number(holder.since);
  return holder;
}

std::string duration(std::int64_t seconds) {
  if (seconds < 120) return fmt::format("{} s", seconds);
  if (seconds < 7200) return fmt::format("{} min", seconds / 60);
  return fmt::format("{} h", seconds / 3600);
}

}  // namespace

std::string describe(const LockHolder& h, std::int64_t now) {
  if (h.host.empty()) return "a process that has not given its name";
  return fmt::format("pid {} on host {}, for {}", h.pid, h.host, duration(std::max<std::int64_t>(0, now - h.since)));
}

std::optional<FileLock> FileLock::try_lock(const fs::path& path) {
  Descriptor file(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
  if (file.get() < 0) fail("open", path, errno);
  struct flock lock = whole_file(F_WRLCK);
  if (::fcntl(file.get(), F_OFD_SETLK, &lock) != 0) {
    if (errno != EAGAIN && errno != EACCES) fail("lock", path, errno);
    return std::nullopt;
  }
  sign(file.get());
  return FileLock(file.release());
}

std::optional<LockHolder> FileLock::holder(const fs::path& path) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0 && errno == ENOENT) return std::nullopt;
  struct flock lock = whole_file(F_WRLCK);
  if (file.get() < 0 || ::fcntl(file.get(), F_OFD_GETLK, &lock) != 0) fail("ask for the lock on", path, errno);
  if (lock.l_type == F_UNLCK) return std::nullopt;
  return read_signature(file.get());
}

FileLock FileLock::lock_or_refuse(const fs::path& path, const std::string& what) {
  if (auto lock = try_lock(path)) return std::move(*lock);
  const LockHolder other = holder(path).value_or(LockHolder{});
  throw Error(ErrorKind::locked, fmt::format("{} is in use by {}", what, describe(other, std::time(nullptr))),
              "wait for it, or stop it (Ctrl-C, or SIGTERM to that pid) and run again");
}

FileLock::FileLock(FileLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
FileLock& FileLock::operator=(FileLock&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}
FileLock::~FileLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace bedload

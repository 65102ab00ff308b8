// Files that are whole or not there, whenever the power goes; and the lock that says a live process owns them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/descriptor.hpp"

namespace bedload {

/// Publishes `bytes` under its final name: temporary file in the same directory, write, fsync, rename, fsync directory.
/// A reader sees the old file or the new one, whole. After any failure the temporary file is gone, the old file
/// untouched, and Error io says what the system said.
void publish(const std::filesystem::path&, std::span<const std::byte> bytes);
void publish(const std::filesystem::path&, std::string_view text);

/// As publish, but only if no file of that name exists: true for exactly one of several rivals, on any host (link(2)).
bool publish_once(const std::filesystem::path&, std::string_view text);

/// As publish, without waiting for the disk: for progress files, whose loss costs nothing.
void publish_unsynced(const std::filesystem::path&, std::string_view text);

/// Removes what killed publications left in a directory. Only for the directory's owner.
void remove_stray_temporaries(const std::filesystem::path& directory);

/// The whole file. Error not_found if there is none, io if it cannot be read.
std::vector<std::byte> read_file(const std::filesystem::path&);
std::string read_text(const std::filesystem::path&);

/// Makes a directory and its parents. Error io if that cannot be, or if files cannot be created in it.
void make_writable_directory(const std::filesystem::path&);

/// The seal: magic, length, SHA-256 of all bytes before it. 48 bytes.
void append_seal(std::vector<std::byte>& bytes);
/// The bytes before an intact seal; Error corrupt, with `name` in its message, for anything else.
std::span<const std::byte> open_seal(std::span<const std::byte> sealed, const std::string& name);

/// Fault point for tests: called before each operation on the disk, may return the errno to fail with (0 = go on), or
/// end the process there. Empty in production.
enum class DiskStep { create, write, sync, rename, sync_directory };
using DiskFault = std::function<int(DiskStep, const std::filesystem::path&)>;
void set_disk_fault(DiskFault);

/// Who holds a lock, in its own words.
struct LockHolder {
  std::string host;
  std::int64_t pid = 0;
  std::int64_t since = 0;   // Unix time [s]
};
/// "pid 4242 on host node7, for 3 min", with the age counted to `now` (Unix time [s]).
std::string describe(const LockHolder&, std::int64_t now);

/// An exclusive lock on a file, kept by the kernel: it ends with its holder, so there are no stale locks. An
/// open-file-description lock, not inherited by programs that the holder starts.
class FileLock {
 public:
  /// Takes the lock (making the file if need be); nothing when anyone else has it, also within this process.
  static std::optional<FileLock> try_lock(const std::filesystem::path&);
  /// The live holder, without touching the lock; nothing when it is free. In the instant between another's taking the
  /// lock and its signing the file the words are those of the holder before.
  static std::optional<LockHolder> holder(const std::filesystem::path&);
  /// try_lock, or Error locked that names `what` and the holder.
  static FileLock lock_or_refuse(const std::filesystem::path&, const std::string& what);

 private:
  explicit FileLock(Descriptor file) : file_(std::move(file)) {}
  Descriptor file_;
};

}   // namespace bedload

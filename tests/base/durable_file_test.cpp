// Durable files: whole or not there, sealed against every flipped bit, locked against every other process.
#include "base/durable_file.hpp"

#include <cerrno>
#include <csignal>
#include <fstream>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/digest.hpp"
#include "base/error.hpp"

namespace bedload {
namespace {

namespace fs = std::filesystem;

class Scratch : public testing::Test {
 protected:
  Scratch() {
    std::string name = (fs::temp_directory_path() / "bedload-test-XXXXXX").string();
    directory = ::mkdtemp(name.data());
  }
  ~Scratch() override {
    set_disk_fault({});
    fs::remove_all(directory);
  }
  std::size_t file_count() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(directory), {}));
  }

  fs::path directory;
};

DiskFault failing(DiskStep when, int error) {
  return [=](DiskStep step, const fs::path&) { return step == when ? error : 0; };
}

/// Runs `action` in a child process and returns its wait status.
template <class Action>
int in_child(Action&& action) {
  const pid_t child = ::fork();
  if (child == 0) {
    action();
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return status;
}

// ---- publish ----

using DurableFile = Scratch;

TEST_F(DurableFile, ReadsBackWhatWasPublished) {
  std::vector<std::byte> bytes(3'000'001);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(i * i >> 3);
  publish(directory / "a", bytes);
  EXPECT_EQ(read_file(directory / "a"), bytes);
  publish(directory / "a", "shorter");
  EXPECT_EQ(read_text(directory / "a"), "shorter");
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(DurableFile, LeavesTheOldFileWhenTheDiskIsFull) {
  for (const DiskStep step : {DiskStep::create, DiskStep::write, DiskStep::sync, DiskStep::rename}) {
    publish(directory / "a", "old");
    set_disk_fault(failing(step, ENOSPC));
    try {
      publish(directory / "a", "new");
      FAIL() << "published on a full disk";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind, ErrorKind::io);
      EXPECT_NE(std::string(error.what()).find("No space left on device"), std::string::npos) << error.what();
      EXPECT_FALSE(error.hint.empty());
    }
    set_disk_fault({});
    EXPECT_EQ(read_text(directory / "a"), "old");
    EXPECT_EQ(file_count(), 1u);
  }
}

TEST_F(DurableFile, LeavesTheOldFileWhenTheDiskFillsUpHalfWay) {
  publish(directory / "a", "old");
  set_disk_fault([writes = 0](DiskStep step, const fs::path&) mutable {
    return step == DiskStep::write && ++writes > 2 ? ENOSPC : 0;
  });
  EXPECT_THROW(publish(directory / "a", std::vector<std::byte>(8'000'000)), Error);
  EXPECT_EQ(read_text(directory / "a"), "old");
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(DurableFile, IsOldOrNewWhenKilledAnywhere) {
  for (const DiskStep step :
       {DiskStep::create, DiskStep::write, DiskStep::sync, DiskStep::rename, DiskStep::sync_directory}) {
    publish(directory / "a", "old");
    const int status = in_child([&] {
      set_disk_fault([=](DiskStep now, const fs::path&) { return now == step ? ::raise(SIGKILL) : 0; });
      publish(directory / "a", "new");
    });
    ASSERT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(read_text(directory / "a"), step == DiskStep::sync_directory ? "new" : "old");
    remove_stray_temporaries(directory);
    EXPECT_EQ(file_count(), 1u);
  }
}

TEST_F(DurableFile, IsPublishedOnceAmongRivals) {
  EXPECT_TRUE(publish_once(directory / "a", "first"));
  EXPECT_FALSE(publish_once(directory / "a", "second"));
  EXPECT_EQ(read_text(directory / "a"), "first");
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(DurableFile, SaysWhichFileIsMissing) {
  try {
    read_file(directory / "absent");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind, ErrorKind::not_found);
    EXPECT_NE(std::string(error.what()).find("absent"), std::string::npos);
  }
}

TEST_F(DurableFile, NeedsADirectoryItCanWriteTo) {
  make_writable_directory(directory / "x" / "y");
  EXPECT_TRUE(fs::is_directory(directory / "x" / "y"));
  publish(directory / "file", "");
  EXPECT_THROW(make_writable_directory(directory / "file" / "z"), Error);
  EXPECT_THROW(make_writable_directory("/proc"), Error) << "permissions are not all: nobody can make a file there";
  EXPECT_TRUE(fs::is_empty(directory / "x" / "y"));
}

// ---- seal ----

std::vector<std::byte> sealed(std::string_view text) {
  const auto bytes = bytes_of(text);
  std::vector<std::byte> result(bytes.begin(), bytes.end());
  append_seal(result);
  return result;
}

TEST(Seal, OpensToTheBytesItClosed) {
  for (const std::string_view text : {"", "x", "the whole memory of a run"}) {
    const auto bytes = sealed(text);
    const auto payload = open_seal(bytes, "ck");
    EXPECT_EQ(std::string_view(reinterpret_cast<const char*>(payload.data()), payload.size()), text);
  }
}

TEST(Seal, DetectsEveryFlippedBit) {
  auto bytes = sealed("the whole memory of a run");
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    const auto mask = static_cast<std::byte>(1 << bit % 8);
    bytes[bit / 8] ^= mask;
    EXPECT_THROW(open_seal(bytes, "ck"), Error) << "bit " << bit;
    bytes[bit / 8] ^= mask;
  }
  EXPECT_NO_THROW(open_seal(bytes, "ck"));
}

TEST(Seal, DetectsEveryCut) {
  const auto bytes = sealed("the whole memory of a run");
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    EXPECT_THROW(open_seal(std::span(bytes).first(length), "ck"), Error) << "length " << length;
    EXPECT_THROW(open_seal(std::span(bytes).last(length), "ck"), Error) << "length " << length;
  }
}

TEST(Seal, NamesTheFileThatIsCorrupt) {
  try {
    open_seal({}, "cases/ab/ck-12.h5");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind, ErrorKind::corrupt);
    EXPECT_EQ(std::string(error.what()).find("cases/ab/ck-12.h5"), 0u);
  }
}

// ---- lock ----

using FileLocks = Scratch;

TEST_F(FileLocks, AreHeldAgainstAnotherProcess) {
  const auto lock = FileLock::try_lock(directory / "lock");
  ASSERT_TRUE(lock);
  const int status = in_child([&] { ::_exit(FileLock::try_lock(directory / "lock") ? 1 : 0); });
  EXPECT_EQ(status, 0);
}

TEST_F(FileLocks, AreHeldWithinTheProcessToo) {
  const auto lock = FileLock::try_lock(directory / "lock");
  EXPECT_FALSE(FileLock::try_lock(directory / "lock"));
}

TEST_F(FileLocks, EndWithTheirHolderHoweverItDies) {
  const int status = in_child([&] {
    const auto lock = FileLock::try_lock(directory / "lock");
    ::raise(SIGKILL);
  });
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_FALSE(FileLock::holder(directory / "lock"));
  EXPECT_TRUE(FileLock::try_lock(directory / "lock"));
}

TEST_F(FileLocks, AreNotInheritedByProgramsThatTheHolderStarts) {
  int gate[2];
  ASSERT_EQ(::pipe2(gate, O_CLOEXEC), 0);
  pid_t child = 0;
  {
    const auto lock = FileLock::try_lock(directory / "lock");
    child = ::fork();
    if (child == 0) {
      ::execl("/bin/sleep", "sleep", "60", nullptr);
      ::_exit(1);
    }
    ::close(gate[1]);   // the child's copy closes when it has become `sleep`
    char end;
    ASSERT_EQ(::read(gate[0], &end, 1), 0);
  }
  EXPECT_TRUE(FileLock::try_lock(directory / "lock"));
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  ::close(gate[0]);
}

TEST_F(FileLocks, SayWhoHoldsThemWithoutTouchingThem) {
  EXPECT_FALSE(FileLock::holder(directory / "lock"));
  {
    const auto lock = FileLock::try_lock(directory / "lock");
    const auto holder = FileLock::holder(directory / "lock");
    ASSERT_TRUE(holder);
    EXPECT_EQ(holder->pid, ::getpid());
    EXPECT_EQ(describe(*holder, holder->since + 180),
              "pid " + std::to_string(::getpid()) + " on host " + holder->host + ", for 3 min");
    try {
      FileLock::lock_or_refuse(directory / "lock", "study laminar");
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind, ErrorKind::locked);
      EXPECT_EQ(std::string(error.what()).find("study laminar is in use by pid " + std::to_string(::getpid())), 0u);
    }
  }
  EXPECT_FALSE(FileLock::holder(directory / "lock"));
}

}   // namespace
}   // namespace bedload

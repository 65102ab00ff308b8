// Which checkpoint of a directory counts, and that a bad disk or a broken file never costs the good one.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <set>
#include <vector>

#include "base/durable_file.hpp"
#include "base/error.hpp"
#include "checkpoint/checkpoint.hpp"
#include "checkpoint/checkpoint_series.hpp"
#include "checkpoint/hdf5_file.hpp"
#include "tests/support/random_state.hpp"
#include "tests/support/temporary_directory.hpp"

namespace bedload {
namespace {

namespace fs = std::filesystem;

State state_at(std::uint64_t step) {
  State state = random_state(step);
  state.clock.step = step;
  state.search.phase = Search::holding;
  return state;
}

struct CheckpointSeriesOnDisk : testing::Test {
  std::set<std::string> names() const {
    std::set<std::string> found;
    for (const auto& entry : fs::directory_iterator(dir())) found.insert(entry.path().filename().string());
    return found;
  }
  const fs::path& dir() const { return directory_.path(); }
  void flip_a_byte(const std::string& name) const {
    std::fstream file(dir() / name, std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(5000);
    const char byte = char(file.get() ^ 1);
    file.seekp(5000);
    file.put(byte);
  }
  void publish_steps(std::initializer_list<std::uint64_t> steps) {
    for (const std::uint64_t step : steps) series_.publish(state_at(step));
  }
  ~CheckpointSeriesOnDisk() override { set_disk_fault({}); }

  TemporaryDirectory directory_;
  std::vector<std::string> said_;
  CheckpointSeries series_{dir(), 2, [this](const std::string& what) { said_.push_back(what); }};
};

TEST_F(CheckpointSeriesOnDisk, KeepsTheNewestTwo) {
  publish_steps({5, 90, 100});   // by number: as text, 90 would come after 100
  EXPECT_EQ(names(), (std::set<std::string>{"ck-90.h5", "ck-100.h5"}));
  EXPECT_EQ(state_digest(series_.newest().value()), state_digest(state_at(100)));
  EXPECT_TRUE(said_.empty());
}

TEST_F(CheckpointSeriesOnDisk, HasNothingInAnEmptyOrMissingDirectory) {
  EXPECT_FALSE(series_.newest());
  EXPECT_FALSE(newest_position(dir()));
  EXPECT_FALSE(newest_position(dir() / "nowhere"));
}

TEST_F(CheckpointSeriesOnDisk, PublishesAStepAgainWithTheSameBytes) {
  publish_steps({5});
  const auto before = read_file(dir() / "ck-5.h5");
  publish_steps({5});
  EXPECT_EQ(read_file(dir() / "ck-5.h5"), before);
}

TEST_F(CheckpointSeriesOnDisk, LooksAtNoOtherNames) {
  publish_steps({5});
  for (const char* name : {"ck-.h5", "ck-9", "ck-9.h5.broken", "ck-9x.h5", "ck--9.h5", "bed.h5", "ck-h5", "-9.h5"})
    std::ofstream(dir() / name) << "not a checkpoint";
  EXPECT_EQ(series_.newest()->clock.step, 5u);
  EXPECT_TRUE(said_.empty());
}

TEST_F(CheckpointSeriesOnDisk, FallsBackToTheOlderAndPutsTheBrokenAside) {
  publish_steps({10, 20});
  flip_a_byte("ck-20.h5");
  EXPECT_EQ(state_digest(series_.newest().value()), state_digest(state_at(10)));
  EXPECT_EQ(names(), (std::set<std::string>{"ck-10.h5", "ck-20.h5.broken"}));
  ASSERT_EQ(said_.size(), 2u);
  EXPECT_NE(said_[0].find("ck-20.h5"), std::string::npos) << said_[0];
  EXPECT_NE(said_[0].find("kept as ck-20.h5.broken"), std::string::npos) << said_[0];
  EXPECT_EQ(said_[1], "falling back to ck-10.h5");
}

TEST_F(CheckpointSeriesOnDisk, FallsBackFromATruncatedAndFromAnEmptyFile) {
  publish_steps({10, 20});
  fs::resize_file(dir() / "ck-20.h5", 3000);
  std::ofstream(dir() / "ck-30.h5");
  EXPECT_EQ(series_.newest()->clock.step, 10u);
  EXPECT_EQ(names(), (std::set<std::string>{"ck-10.h5", "ck-20.h5.broken", "ck-30.h5.broken"}));
}

TEST_F(CheckpointSeriesOnDisk, RefusesWhenNoneIsWhole) {
  publish_steps({10, 20});
  flip_a_byte("ck-10.h5");
  flip_a_byte("ck-20.h5");
  try {
    series_.newest();
    FAIL() << "a broken checkpoint was taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 76);
    EXPECT_NE(std::string(error.what()).find("no checkpoint is whole"), std::string::npos);
  }
  EXPECT_FALSE(newest_position(dir()));
}

TEST_F(CheckpointSeriesOnDisk, NeitherSkipsNorPutsAsideWhatANewerBedloadWrote) {
  publish_steps({10});
  Hdf5Writer future;
  future.write_attribute("format", checkpoint_format + 1);
  auto image = future.image();
  append_seal(image);
  publish(dir() / "ck-20.h5", image);
  EXPECT_THROW(series_.newest(), WrittenByNewer);
  EXPECT_THROW(newest_position(dir()), WrittenByNewer);
  EXPECT_EQ(names(), (std::set<std::string>{"ck-10.h5", "ck-20.h5"}));
}

TEST_F(CheckpointSeriesOnDisk, KeepsTheOldOneWhenTheDiskFailsAnywhereOnTheWay) {
  publish_steps({10});
  for (const DiskStep step : {DiskStep::create, DiskStep::write, DiskStep::sync, DiskStep::rename}) {
    set_disk_fault([&](DiskStep at, const fs::path&) { return at == step ? ENOSPC : 0; });
    try {
      publish_steps({20});
      ADD_FAILURE() << "a full disk was not noticed at step " << int(step);
    } catch (const Error& error) {
      EXPECT_EQ(error.exit_code(), 74);
      EXPECT_NE(std::string(error.what()).find("No space left"), std::string::npos) << error.what();
    }
    set_disk_fault({});
    EXPECT_EQ(names(), std::set<std::string>{"ck-10.h5"});
    EXPECT_EQ(series_.newest()->clock.step, 10u);
  }
}

TEST_F(CheckpointSeriesOnDisk, RemovesWhatAKilledPublicationLeft) {
  publish_steps({10});
  if (const pid_t child = ::fork(); child == 0) {
    set_disk_fault([](DiskStep at, const fs::path&) { return at == DiskStep::rename ? (::_exit(9), 0) : 0; });
    publish_steps({20});
  } else {
    ::waitpid(child, nullptr, 0);
  }
  ASSERT_EQ(names().size(), 2u);
  EXPECT_EQ(series_.newest()->clock.step, 10u);
  publish_steps({30});
  EXPECT_EQ(names(), (std::set<std::string>{"ck-10.h5", "ck-30.h5"}));
}

TEST_F(CheckpointSeriesOnDisk, TellsTheNewestPositionAndTouchesNothing) {
  publish_steps({10});
  State finished = state_at(20);
  finished.search.phase = Search::finished;
  series_.publish(finished);
  EXPECT_EQ(newest_position(dir())->step, 20u);
  EXPECT_TRUE(newest_position(dir())->finished);
  flip_a_byte("ck-20.h5");
  EXPECT_EQ(newest_position(dir())->step, 10u);
  EXPECT_FALSE(newest_position(dir())->finished);
  EXPECT_EQ(names(), (std::set<std::string>{"ck-10.h5", "ck-20.h5"}));
}

TEST_F(CheckpointSeriesOnDisk, IsReadByOthersWithoutAChange) {
  publish_steps({10, 20});
  flip_a_byte("ck-20.h5");
  std::vector<std::string> broken;
  const auto say = [&](const std::string& what) { broken.push_back(what); };
  EXPECT_EQ(state_digest(newest_whole(dir(), say).value()), state_digest(state_at(10)));
  ASSERT_EQ(broken.size(), 1u);
  EXPECT_NE(broken[0].find("ck-20.h5"), std::string::npos) << broken[0];
  flip_a_byte("ck-10.h5");
  EXPECT_FALSE(newest_whole(dir(), say));
  EXPECT_EQ(broken.size(), 3u);
  EXPECT_EQ(names(), (std::set<std::string>{"ck-10.h5", "ck-20.h5"}));
}

TEST_F(CheckpointSeriesOnDisk, CanBeReadThoughAListedFileIsGone) {
  publish_steps({10});
  fs::create_symlink("gone", dir() / "ck-20.h5");   // listed, and not there when it is read
  EXPECT_EQ(newest_whole(dir(), {})->clock.step, 10u);
  EXPECT_EQ(newest_position(dir())->step, 10u);
  fs::remove(dir() / "ck-10.h5");
  EXPECT_FALSE(newest_whole(dir(), {}));
  EXPECT_FALSE(newest_position(dir()));
}

TEST_F(CheckpointSeriesOnDisk, IsReadWhileItsWorkerPublishesAndPrunes) {
  publish_steps({1});
  const pid_t worker = ::fork();
  if (worker == 0) {
    CheckpointSeries series(dir(), 1, {});   // each publication removes the one before
    for (std::uint64_t step = 2; step <= 40; ++step) series.publish(state_at(step));
    ::_exit(0);
  }
  std::uint64_t last = 1;
  while (::waitpid(worker, nullptr, WNOHANG) == 0) {
    const auto newest = newest_whole(dir(), [](const std::string& what) { ADD_FAILURE() << what; });
    ASSERT_TRUE(newest) << "nothing was found after step " << last;
    EXPECT_GE(newest->clock.step, last);
    last = newest->clock.step;
  }
  EXPECT_EQ(newest_whole(dir(), {})->clock.step, 40u);
}

}   // namespace
}   // namespace bedload

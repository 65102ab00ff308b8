// A state through a checkpoint and back, whole, or not at all.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <random>

#include "base/durable_file.hpp"
#include "checkpoint/checkpoint.hpp"
#include "checkpoint/hdf5_file.hpp"
#include "solver/plain_numbers.hpp"
#include "tests/support/random_state.hpp"

namespace bedload {
namespace {

using Bytes = std::vector<std::byte>;

/// The bytes of every field, ghosts included, by name: equality that nan does not disturb and no digest takes part in.
std::map<std::string, Bytes> all_bytes(const State& state) {
  std::map<std::string, Bytes> bytes;
  const auto keep = [&](const std::string& name, auto numbers) {
    const auto raw = std::as_bytes(numbers);
    bytes[name].assign(raw.begin(), raw.end());
  };
  State::each_field(state, [&](const std::string& name, const auto& field, const char*) {
    if constexpr (requires { field.cells; }) {
      keep(name + " cells", std::span(field.cells));
      keep(name, std::span(field.values));
    } else if constexpr (requires { field.data(); }) {
      keep(name, std::span(field));
    } else {
      keep(name, std::span(&field, 1));
    }
  });
  return bytes;
}

void expect_round_trip(const State& state) {
  const auto before = all_bytes(state), after = all_bytes(state_from_image(checkpoint_image(state), "ck"));
  for (const auto& [name, bytes] : before) EXPECT_TRUE(after.at(name) == bytes) << name;
}

Error refusal(const Bytes& image) {
  try {
    state_from_image(image, "dir/ck-7.h5");
  } catch (const Error& error) {
    return error;
  }
  return Error(ErrorKind::internal, "nothing was refused");
}

/// A checkpoint with one thing in it that no program of this version writes.
Bytes sealed_oddity(const std::function<void(Hdf5Writer&)>& write_odd, const std::string& instead_of) {
  Hdf5Writer file;
  if (instead_of != "format") file.write_attribute("format", checkpoint_format);
  file.write_attribute("physics_version", physics_version);
  const State state = random_state(1);
  State::each_field(state, [&](const std::string& path, const auto& field, const std::string& unit) {
    if (path != instead_of)
      as_numbers(field, [&](auto numbers, ShapeView shape) { file.write(path, numbers, shape, unit); });
  });
  write_odd(file);
  Bytes image = file.image();
  append_seal(image);
  return image;
}

TEST(Checkpoint, GivesBackEveryBitOfAState) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) expect_round_trip(random_state(seed));
}

TEST(Checkpoint, GivesBackAStateWithoutGrainsContactsRowsOrCells) {
  expect_round_trip(State());
  expect_round_trip(random_state(1, {.grains = 0}));
  expect_round_trip(random_state(2, {.contacts = 0, .rows = 0}));
  expect_round_trip(random_state(3, {.cells = {0, 0, 0}}));
  expect_round_trip(random_state(4, {.grains = 1, .contacts = 1, .rows = 1, .cells = {1, 1, 1}}));
}

TEST(Checkpoint, IsTheSameBytesForTheSameState) {
  const Bytes image = checkpoint_image(random_state(5));
  EXPECT_EQ(image, checkpoint_image(random_state(5)));
  EXPECT_EQ(image, checkpoint_image(state_from_image(image, "ck")));
}

TEST(Checkpoint, DoesNotHoldGhosts) {
  State state = random_state(6);
  const Bytes image = checkpoint_image(state);
  state.fluid.velocity.x[0] = 1;
  EXPECT_EQ(image, checkpoint_image(state));
}

TEST(Checkpoint, DetectsAFlippedBitWhereverItIs) {
  const Bytes image = checkpoint_image(random_state(7));
  std::mt19937_64 random(8);
  std::vector<std::size_t> places(1500);
  for (std::size_t& place : places) place = random() % image.size();
  for (std::size_t n = 0; n < 800; ++n) places.push_back(n);                     // superblock, root group
  for (std::size_t n = 0; n < 48; ++n) places.push_back(image.size() - 1 - n);   // the seal itself
  Bytes flipped = image;
  for (const std::size_t place : places) {
    flipped[place] ^= std::byte(1u << (random() % 8));
    EXPECT_EQ(refusal(flipped).kind, ErrorKind::corrupt) << "byte " << place;
    flipped[place] = image[place];
  }
}

TEST(Checkpoint, DetectsATruncationAtAnyLength) {
  const Bytes image = checkpoint_image(random_state(9));
  std::vector<std::size_t> lengths{0, 1, 8, image.size() - 48, image.size() - 1};
  for (std::size_t length = 0; length < image.size(); length += 97) lengths.push_back(length);
  for (const std::size_t length : lengths)
    EXPECT_EQ(refusal(Bytes(image.begin(), image.begin() + std::ptrdiff_t(length))).kind, ErrorKind::corrupt) << length;
}

TEST(Checkpoint, DetectsBytesAfterItsEnd) {
  Bytes image = checkpoint_image(random_state(10));
  image.push_back(std::byte{0});
  EXPECT_EQ(refusal(image).kind, ErrorKind::corrupt);
}

TEST(Checkpoint, SaysThatItWasWrittenByANewerBedload) {
  const Bytes image =
      sealed_oddity([](Hdf5Writer& file) { file.write_attribute("format", checkpoint_format + 1); }, "format");
  try {
    state_from_image(image, "ck-7.h5");
    FAIL() << "a newer format was read";
  } catch (const WrittenByNewer& error) {
    EXPECT_EQ(error.exit_code(), 76);
    EXPECT_TRUE(std::string(error.what()).starts_with("ck-7.h5: written by a newer bedload")) << error.what();
  }
  EXPECT_THROW(header_from_image(image, "ck-7.h5"), WrittenByNewer);
}

TEST(Checkpoint, NamesTheFieldThatDoesNotFit) {
  const auto complaint = [](const std::string& path, const std::function<void(Hdf5Writer&)>& write_odd) {
    const Error error = refusal(sealed_oddity(write_odd, path));
    EXPECT_EQ(error.kind, ErrorKind::corrupt);
    return std::string(error.what());
  };
  const std::vector<double> numbers(6);
  const auto with = [&](const std::string& path, const Shape& shape, const std::string& unit) {
    return [=](Hdf5Writer& file) { file.write(path, std::span<const double>(numbers), shape, unit); };
  };
  EXPECT_EQ(complaint("fluid/w", [](Hdf5Writer&) {}), "dir/ck-7.h5: there is no fluid/w");
  EXPECT_EQ(complaint("fluid/w", with("fluid/w", {6}, "m/s")),
            "dir/ck-7.h5: fluid/w has shape [6], expected [nx, ny, nz]");
  EXPECT_EQ(complaint("grains/spin", with("grains/spin", {3, 2}, "rad/s")),
            "dir/ck-7.h5: grains/spin has shape [3, 2], expected [n, 3]");
  EXPECT_EQ(complaint("grains/diameter", with("grains/diameter", {6}, "mm")),
            "dir/ck-7.h5: grains/diameter is in mm, expected m");
  EXPECT_EQ(complaint("contacts/lower", with("contacts/lower", {6}, "1")),
            "dir/ck-7.h5: contacts/lower holds numbers of another type");
}

TEST(Checkpoint, TellsStepAndPhaseWithoutLoadingTheRest) {
  State state = random_state(11);
  state.clock.step = 1234;
  state.search.phase = Search::finished;
  const CheckpointHeader header = header_from_image(checkpoint_image(state), "ck");
  EXPECT_EQ(header.format, checkpoint_format);
  EXPECT_EQ(header.physics_version, std::uint64_t(physics_version));
  EXPECT_EQ(header.step, 1234u);
  EXPECT_EQ(header.phase, Search::finished);
}

}   // namespace
}   // namespace bedload

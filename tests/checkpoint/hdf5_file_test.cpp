// HDF5 files in memory: what goes in comes out, and what is broken is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <ctime>
#include <functional>
#include <numeric>

#include "base/error.hpp"
#include "checkpoint/hdf5_file.hpp"

namespace bedload {
namespace {

using Bytes = std::vector<std::byte>;

template <class Number>
void write(Hdf5Writer& file, const std::string& path, const std::vector<Number>& numbers, const Shape& shape) {
  file.write(path, std::span<const Number>(numbers), shape, "m");
}

template <class Number>
void expect_back(const std::vector<Number>& numbers, const Shape& shape) {
  Hdf5Writer writer;
  write(writer, "some/where/deep", numbers, shape);
  const Hdf5Reader reader(writer.image(), "file");
  EXPECT_EQ(reader.shape("some/where/deep"), shape);
  EXPECT_EQ(reader.unit("some/where/deep"), "m");
  std::vector<Number> back(numbers.size());
  reader.read("some/where/deep", std::span<Number>(back));
  EXPECT_EQ(back, numbers);
}

std::string refusal(const std::function<void()>& deed) {
  try {
    deed();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind, ErrorKind::corrupt);
    return error.what();
  }
  return "nothing was refused";
}

TEST(Hdf5File, GivesBackNumbersOfEveryTypeAndShape) {
  expect_back<double>({1.5, -2, 3e300}, {3});
  expect_back<double>({1, 2, 3, 4, 5, 6}, {2, 3});
  expect_back<double>({1, 2, 3, 4, 5, 6, 7, 8}, {2, 2, 2});
  expect_back<double>({42}, {});
  expect_back<std::uint64_t>({~0ull, 0}, {2});
  expect_back<std::uint32_t>({~0u, 7, 0}, {3});
  expect_back<std::uint8_t>({255, 0, 1, 1}, {4});
}

TEST(Hdf5File, GivesBackEmptyArraysWithTheirShape) {
  expect_back<double>({}, {0});
  expect_back<double>({}, {0, 3});
  expect_back<double>({}, {4, 0, 2});
  expect_back<std::uint8_t>({}, {0});
}

TEST(Hdf5File, GivesBackArraysOfSeveralChunks) {
  std::vector<double> numbers(5'000'001);   // 40 MB: three chunks, the last one shorter
  std::iota(numbers.begin(), numbers.end(), 0.25);
  expect_back(numbers, {numbers.size()});
}

Bytes small_image() {
  Hdf5Writer file;
  file.write_attribute("format", 1);
  write<double>(file, "a/x", {1, 2, 3}, {3});
  write<double>(file, "a/y", {}, {0});
  write<std::uint8_t>(file, "b/z", {1}, {});
  return file.image();
}

TEST(Hdf5File, KeepsNothingOfTheMemoryItWasBuiltIn) {
  const auto image_after = [](int litter) {
    std::vector<Bytes> dirt(64, Bytes(100'000, std::byte(litter)));
    dirt.clear();   // what HDF5 is given next may be this
    return small_image();
  };
  EXPECT_EQ(image_after(0xAA), image_after(0x55));
}

TEST(Hdf5File, KeepsNoTime) {
  const Bytes image = small_image();
  const auto now = std::uint32_t(std::time(nullptr));
  for (std::uint32_t second = now - 60; second <= now; ++second)
    EXPECT_TRUE(std::ranges::search(image, std::as_bytes(std::span(&second, 1))).empty()) << second;
}

TEST(Hdf5File, DetectsAFlippedBitInItsNumbersByItself) {
  Hdf5Writer writer;
  std::vector<double> numbers(100);
  std::iota(numbers.begin(), numbers.end(), 1e6);
  write(writer, "x", numbers, {100});
  Bytes image = writer.image();
  const auto stored = std::span(reinterpret_cast<const std::byte*>(numbers.data()), 800);
  const auto place = std::ranges::search(image, stored).begin();
  ASSERT_NE(place, image.end());
  place[400] ^= std::byte{4};
  EXPECT_NE(refusal([&] { Hdf5Reader(image, "bed.h5").read("x", std::span<double>(numbers)); }).find("Fletcher32"),
            std::string::npos);
}

TEST(Hdf5File, NamesFileAndDataSetInEveryRefusal) {
  Hdf5Writer writer;
  write<double>(writer, "a/x", {1, 2}, {2});
  const Bytes image = writer.image();
  const Hdf5Reader reader(image, "bed.h5");
  std::array<double, 3> three{};
  std::array<std::uint64_t, 2> whole{};
  EXPECT_EQ(refusal([&] { reader.shape("a/y"); }), "bed.h5: there is no a/y");
  EXPECT_EQ(refusal([&] { reader.shape("b/y"); }), "bed.h5: there is no b/y");
  EXPECT_EQ(refusal([&] { reader.read("a/x", std::span<double>(three)); }), "bed.h5: a/x holds 2 numbers, not 3");
  EXPECT_EQ(refusal([&] { reader.read("a/x", std::span<std::uint64_t>(whole)); }),
            "bed.h5: a/x holds numbers of another type");
  EXPECT_TRUE(refusal([&] { reader.attribute("format"); }).starts_with("bed.h5: cannot read attribute format"));
  EXPECT_TRUE(refusal([&] { Hdf5Reader(Bytes(100), "bed.h5"); }).starts_with("bed.h5: cannot read it as HDF5"));
  EXPECT_TRUE(refusal([&] { Hdf5Reader(Bytes(), "bed.h5"); }).starts_with("bed.h5: cannot read it as HDF5"));
}

TEST(Hdf5File, OpensSeveralFilesAtATime) {
  Hdf5Writer one, two;
  write<double>(one, "x", {1}, {1});
  write<double>(two, "x", {2}, {1});
  const Hdf5Reader first(one.image(), "one"), second(two.image(), "two");
  std::array<double, 1> x{}, y{};
  first.read("x", std::span<double>(x));
  second.read("x", std::span<double>(y));
  EXPECT_EQ(x[0], 1);
  EXPECT_EQ(y[0], 2);
}

}   // namespace
}   // namespace bedload

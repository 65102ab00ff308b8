// Arrays of numbers with shapes and units as an HDF5 file in memory: the only part of the program that knows HDF5.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace bedload {

/// Extents, slowest first; empty for a single number.
using Shape = std::vector<std::uint64_t>;

/// Builds a file in memory. The same calls give the same bytes: no object times, and HDF5 never touches the disk, where a
/// full one makes it crash. Numbers are double, uint64, int64, uint32 or uint8. Not thread-safe (neither is Debian's HDF5).
class Hdf5Writer {
 public:
  Hdf5Writer();
  ~Hdf5Writer();
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;

  /// A data set at "group/.../name" (groups are made on the way) with an attribute "unit". Arrays are chunked and carry
  /// Fletcher32 checksums; numbers.size() is the product of the shape.
  template <class Number>
  void write(const std::string& path, std::span<const Number> numbers, std::span<const std::uint64_t> shape,
             const std::string& unit);
  /// A number attached to the file as a whole.
  void write_attribute(const std::string& name, std::uint64_t value);
  /// Numbers (double, int64) and a text of fixed length attached to a group, which is made if it is not there.
  template <class Number>
  void write_attribute(const std::string& group, const std::string& name, std::span<const Number> numbers);
  void write_attribute(const std::string& group, const std::string& name, const std::string& text);
  /// The bytes of the file so far.
  std::vector<std::byte> image();

 private:
  std::int64_t file_;
};

/// Reads a file in memory (copied on opening). Whatever does not fit throws Error corrupt, naming file and data set.
class Hdf5Reader {
 public:
  /// `name` appears in messages.
  Hdf5Reader(std::span<const std::byte> image, std::string name);
  ~Hdf5Reader();
  Hdf5Reader(const Hdf5Reader&) = delete;
  Hdf5Reader& operator=(const Hdf5Reader&) = delete;

  Shape shape(const std::string& path) const;
  std::string unit(const std::string& path) const;
  std::uint64_t attribute(const std::string& name) const;
  /// Fills `numbers`, whose type must be the stored one and whose size the product of the shape.
  template <class Number>
  void read(const std::string& path, std::span<Number> numbers) const;

  const std::string& name() const { return name_; }

 private:
  std::string name_;
  std::int64_t file_;
};

}   // namespace bedload

// State to file and back, field by field as State::each_field lists them.
#include "checkpoint/checkpoint.hpp"

#include <fmt/format.h>

#include <limits>

#include "base/durable_file.hpp"
#include "checkpoint/hdf5_file.hpp"
#include "solver/plain_numbers.hpp"

namespace bedload {
namespace {

/// Refuses a format of tomorrow, and one that never was.
void check_format(const Hdf5Reader& file) {
  const std::uint64_t format = file.attribute("format");
  if (format > checkpoint_format)
    throw WrittenByNewer(ErrorKind::corrupt,
                         fmt::format("{}: written by a newer bedload (checkpoint format {}; this one reads up to {})",
                                     file.name(), format, checkpoint_format),
                         "continue with the bedload that wrote it, or a later one");
  if (format < 1) throw Error(ErrorKind::corrupt, fmt::format("{}: checkpoint format 0 does not exist", file.name()));
  if (format < checkpoint_format)
    throw Error(ErrorKind::corrupt,
                fmt::format("{}: written by an older bedload (checkpoint format {}; this one reads {})", file.name(),
                            format, checkpoint_format),
                "`bedload run --recompute` starts its case anew");
}

[[noreturn]] void refuse_shape(const Hdf5Reader& file, const std::string& path, const Shape& shape,
                               const char* wanted) {
  std::string extents;
  for (const std::uint64_t extent : shape) extents += fmt::format("{}{}", extents.empty() ? "" : ", ", extent);
  throw Error(ErrorKind::corrupt,
              fmt::format("{}: {} has shape [{}], expected {}", file.name(), path, extents, wanted));
}

/// Reads one field of any kind that each_field visits.
struct FieldReader {
  const Hdf5Reader& file;

  template <class Number>
  requires std::is_arithmetic_v<Number>
  void operator()(const std::string& path, Number& number) const {
    if (const Shape shape = file.shape(path); !shape.empty()) refuse_shape(file, path, shape, "a single number");
    file.read(path, std::span<Number>(&number, 1));
  }
  template <class Number>
  void operator()(const std::string& path, std::vector<Number>& numbers) const {
    const Shape shape = file.shape(path);
    if (shape.size() != 1) refuse_shape(file, path, shape, "[n]");
    numbers.resize(shape[0]);
    file.read(path, std::span<Number>(numbers));
  }
  void operator()(const std::string& path, std::vector<Vec3>& vectors) const {
    const Shape shape = file.shape(path);
    if (shape.size() != 2 || shape[1] != 3) refuse_shape(file, path, shape, "[n, 3]");
    vectors.resize(shape[0]);
    file.read(path, std::span<double>(reinterpret_cast<double*>(vectors.data()), 3 * vectors.size()));
  }
  template <class Where>
  void operator()(const std::string& path, Field<Where>& field) const {
    const Shape shape = file.shape(path);
    if (shape.size() != 3) refuse_shape(file, path, shape, "[nx, ny, nz]");
    for (const std::uint64_t extent : shape)
      if (extent > std::uint64_t(std::numeric_limits<int>::max())) refuse_shape(file, path, shape, "fewer cells");
    std::vector<double> row(shape[0] * shape[1] * shape[2]);
    file.read(path, std::span<double>(row));
    set_interior(field, {int(shape[0]), int(shape[1]), int(shape[2])}, row);
  }
};

}   // namespace

std::vector<std::byte> checkpoint_image(const State& state) {
  Hdf5Writer file;
  file.write_attribute("format", checkpoint_format);
  file.write_attribute("physics_version", physics_version);
  State::each_field(state, [&](const std::string& path, const auto& field, const std::string& unit) {
    as_numbers(field, [&](auto numbers, ShapeView shape) { file.write(path, numbers, shape, unit); });
  });
  std::vector<std::byte> image = file.image();
  append_seal(image);
  return image;
}

State state_from_image(std::span<const std::byte> image, const std::string& name) {
  const Hdf5Reader file(open_seal(image, name), name);
  check_format(file);
  State state;
  State::each_field(state, [&](const std::string& path, auto& field, const std::string& unit) {
    FieldReader{file}(path, field);
    if (const std::string stored = file.unit(path); stored != unit)
      throw Error(ErrorKind::corrupt, fmt::format("{}: {} is in {}, expected {}", name, path, stored, unit));
  });
  return state;
}

CheckpointHeader header_from_image(std::span<const std::byte> image, const std::string& name) {
  const Hdf5Reader file(open_seal(image, name), name);
  check_format(file);
  CheckpointHeader header{.format = file.attribute("format"), .physics_version = file.attribute("physics_version")};
  const FieldReader read{file};
  read("clock/step", header.step);
  read("search/phase", header.phase);
  return header;
}

State read_checkpoint(const std::filesystem::path& path) { return state_from_image(read_file(path), path.string()); }

void write_checkpoint(const std::filesystem::path& path, const State& state) { publish(path, checkpoint_image(state)); }

}   // namespace bedload

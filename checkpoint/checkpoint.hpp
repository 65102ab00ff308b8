// A checkpoint: one State as a sealed HDF5 file image.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "solver/state.hpp"

namespace bedload {

/// Version of the layout of checkpoint files: which fields, under which names, units and shapes.
inline constexpr std::uint64_t checkpoint_format = 6;

/// A whole checkpoint that this program is too old to read. Not broken: never put aside as if it were.
struct WrittenByNewer : Error {
  using Error::Error;
};

/// What is known of a checkpoint before its fields are loaded.
struct CheckpointHeader {
  std::uint64_t format = 0;
  std::uint64_t physics_version = 0;
  std::uint64_t step = 0;    // of the state's clock
  std::uint64_t phase = 0;   // Search::Phase
};

/// HDF5 image (core driver, no object times, Fletcher32) with the seal at its end: magic, length, SHA-256 of all before it.
/// Equal states give equal bytes.
std::vector<std::byte> checkpoint_image(const State&);

/// Checks the seal before libhdf5 sees a byte. Throws Error corrupt (broken, or of a newer format: WrittenByNewer), with
/// `name` in the message. The ghosts of fields come back as zeros.
State state_from_image(std::span<const std::byte> image, const std::string& name);
/// As state_from_image, but of the fields only what the header needs.
CheckpointHeader header_from_image(std::span<const std::byte> image, const std::string& name);

/// Error not_found, io or as state_from_image.
State read_checkpoint(const std::filesystem::path&);
/// One durable file under its final name: temp, write, fsync, rename, fsync directory. Error io leaves an old one as it was.
void write_checkpoint(const std::filesystem::path&, const State&);

}   // namespace bedload

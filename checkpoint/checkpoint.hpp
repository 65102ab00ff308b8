// A checkpoint: one State as a sealed HDF5 file image.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "solver/state.hpp"

namespace bedload {

/// HDF5 image (core driver, no object times, Fletcher32) with the seal at its end: magic, length, SHA-256 of all before it.
std::vector<std::byte> checkpoint_image(const State&);

/// Checks the seal before libhdf5 sees a byte. Throws Error corrupt (broken, or of a newer format), with `name` in the message.
State state_from_image(std::span<const std::byte> image, const std::string& name);

State read_checkpoint(const std::filesystem::path&);
/// One durable file under its final name: temp, write, fsync, rename, fsync directory.
void write_checkpoint(const std::filesystem::path&, const State&);

}  // namespace bedload

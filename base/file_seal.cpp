// The seal at the end of a file: magic, length, SHA-256.
#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include "base/digest.hpp"
#include "base/durable_file.hpp"
#include "base/error.hpp"

namespace bedload {

namespace {
constexpr std::string_view seal_magic = "bdl-seal";
constexpr std::size_t seal_size = 8 + 8 + 32;
}   // namespace

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
  if (!std::ranges::equal(seal.first(8), bytes_of(seal_magic)))
    refuse("does not end in a seal: cut short, or no checkpoint");
  if (length != payload.size()) refuse(fmt::format("was sealed at {} bytes and has {}", length, payload.size()));
  if (!std::ranges::equal(seal.last(32), Digest().add(payload).bytes())) {
    refuse("is damaged: its bytes do not match the SHA-256 of its seal");
  }
  return payload;
}

}   // namespace bedload

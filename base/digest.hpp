// SHA-256 of whatever identifies a thing: inputs of a case, state of a run, bytes of a file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace bedload {

/// Incremental SHA-256 (libcrypto). Numbers count as 8 little-endian bytes; a string as its length and its bytes, so that
/// {"ab","c"} and {"a","bc"} differ; a span as its bytes alone, so that a file may be added in pieces.
class Digest {
 public:
  Digest();
  ~Digest();
  Digest(Digest&&) noexcept;
  Digest& operator=(Digest&&) noexcept;

  Digest& add(std::span<const std::byte> bytes);
  Digest& add(std::uint64_t number);
  Digest& add(double number);
  Digest& add(std::string_view text);

  /// Of all that was added so far; more may be added afterwards.
  std::array<std::byte, 32> bytes() const;
  std::string hex() const;   // 64 digits

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

/// The bytes of a text, for functions that take bytes.
std::span<const std::byte> bytes_of(std::string_view text);

}   // namespace bedload

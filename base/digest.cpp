// SHA-256 through libcrypto's EVP interface.
#include "base/digest.hpp"

#include <bit>

#include <fmt/format.h>
#include <openssl/evp.h>

#include "base/error.hpp"

namespace bedload {

static_assert(std::endian::native == std::endian::little, "digests and checkpoints are little-endian");

namespace {
void must(int result) {
  if (result != 1) throw Error(ErrorKind::internal, "libcrypto cannot compute a SHA-256");
}
}   // namespace

struct Digest::Context {
  EVP_MD_CTX* evp = EVP_MD_CTX_new();
  ~Context() { EVP_MD_CTX_free(evp); }
};

Digest::Digest() : context_(std::make_unique<Context>()) {
  must(EVP_DigestInit_ex(context_->evp, EVP_sha256(), nullptr));
}
Digest::~Digest() = default;
Digest::Digest(Digest&&) noexcept = default;
Digest& Digest::operator=(Digest&&) noexcept = default;

Digest& Digest::add(std::span<const std::byte> bytes) {
  must(EVP_DigestUpdate(context_->evp, bytes.data(), bytes.size()));
  return *this;
}

Digest& Digest::add(std::uint64_t number) { return add(std::as_bytes(std::span(&number, 1))); }
Digest& Digest::add(double number) { return add(std::bit_cast<std::uint64_t>(number)); }
Digest& Digest::add(std::string_view text) { return add(std::uint64_t{text.size()}).add(bytes_of(text)); }

std::array<std::byte, 32> Digest::bytes() const {
  Context copy;   // finishing ends a context, so a copy is finished
  std::array<std::byte, 32> result;
  must(EVP_MD_CTX_copy_ex(copy.evp, context_->evp));
  must(EVP_DigestFinal_ex(copy.evp, reinterpret_cast<unsigned char*>(result.data()), nullptr));
  return result;
}

std::string Digest::hex() const {
  std::string digits;
  for (const std::byte b : bytes()) digits += fmt::format("{:02x}", std::to_integer<unsigned>(b));
  return digits;
}

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

}   // namespace bedload

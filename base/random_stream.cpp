// Philox rounds, and normal deviates by comparing uniform ones.
#include "base/random_stream.hpp"

namespace bedload {

std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> c, std::array<std::uint32_t, 2> key) noexcept {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t p0 = std::uint64_t{0xD2511F53} * c[0];
    const std::uint64_t p1 = std::uint64_t{0xCD9E8D57} * c[2];
    c = {static_cast<std::uint32_t>(p1 >> 32) ^ c[1] ^ key[0], static_cast<std::uint32_t>(p1),
         static_cast<std::uint32_t>(p0 >> 32) ^ c[3] ^ key[1], static_cast<std::uint32_t>(p0)};
    key[0] += 0x9E3779B9;   // golden ratio
    key[1] += 0xBB67AE85;   // sqrt(3) - 1
  }
  return c;
}

// Counter: 24 bits of block number under 8 bits of stream, then id, then step.
RandomStream::RandomStream(std::uint64_t seed, Stream stream, std::uint32_t id, std::uint64_t step) noexcept
    : counter_{static_cast<std::uint32_t>(stream) << 24, id, static_cast<std::uint32_t>(step),
               static_cast<std::uint32_t>(step >> 32)},
      key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)} {}

std::uint64_t RandomStream::bits() noexcept {
  if (half_used_) {
    half_used_ = false;
    return std::uint64_t{block_[3]} << 32 | block_[2];
  }
  block_ = philox4x32(counter_, key_);
  ++counter_[0];
  half_used_ = true;
  return std::uint64_t{block_[1]} << 32 | block_[0];
}

double RandomStream::uniform() noexcept { return (static_cast<double>(bits() >> 12) + 0.5) * 0x1p-52; }

namespace {

/// True with probability exp(-x p), 0 <= x, p <= 1, by von Neumann's falling sequences: x > u1 > u2 > ..., each further
/// step also subject to a chance p; the length of such a run is even with just that probability.
bool happens(RandomStream& random, double x, double p) noexcept {
  bool even = true;
  for (;; even = !even) {
    const double u = random.uniform();
    if (u >= x || random.uniform() >= p) return even;
    x = u;
  }
}

bool happens_times(RandomStream& random, int times, double x, double p) noexcept {
  for (int n = 0; n < times; ++n) {
    if (!happens(random, x, p)) return false;
  }
  return true;
}

}   // namespace

// Karney, "Sampling exactly from the normal distribution", ACM TOMS 42 (2016) 3, algorithm N: exact, and no logarithm or
// exponential whose last bit depends on the processor's variant of libm. |z| = k + x has the density
// exp(-k/2) exp(-k(k-1)/2) exp(-x(2k + x)/2) = exp(-(k + x)^2/2).
double RandomStream::normal() noexcept {
  for (;;) {
    int k = 0;
    while (happens(*this, 0.5, 1.0)) ++k;
    if (!happens_times(*this, k * (k - 1), 0.5, 1.0)) continue;
    const double x = uniform();
    if (!happens_times(*this, k + 1, x, (2 * k + x) / (2 * k + 2))) continue;
    return bits() >> 63 ? k + x : -(k + x);
  }
}

}   // namespace bedload

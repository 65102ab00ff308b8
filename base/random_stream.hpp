// Random numbers as functions of (seed, stream, id, step): there is no generator state to save or to share.
#pragma once

#include <array>
#include <cstdint>

namespace bedload {

/// Every use of chance in the program has a stream of its own, so that adding one changes no other.
enum class Stream : std::uint8_t {
  grain_diameter = 1,
  grain_place = 2,
  resampling = 3,    // of the seeds of a threshold: studies/threshold_fit
  onset_level = 4,   // where a search begins: solver/bed/onset_search
};

/// Philox4x32-10, a counter-based generator: Salmon, Moraes, Dror, Shaw, "Parallel random numbers: as easy as 1, 2, 3", SC11.
std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                        std::array<std::uint32_t, 2> key) noexcept;

/// The sequence of draws that belongs to one (seed, stream, id, step). Same bits on every machine: integers, comparisons
/// and one division, no libm. At most 2^25 draws of 64 bits.
class RandomStream {
 public:
  explicit RandomStream(std::uint64_t seed, Stream stream, std::uint32_t id = 0, std::uint64_t step = 0) noexcept;

  std::uint64_t bits() noexcept;
  double uniform() noexcept;   // in (0, 1): odd multiples of 2^-53, so neither end occurs
  double normal() noexcept;    // mean 0, standard deviation 1

 private:
  std::array<std::uint32_t, 4> counter_;
  std::array<std::uint32_t, 2> key_;
  std::array<std::uint32_t, 4> block_{};
  bool half_used_ = false;
};

}   // namespace bedload

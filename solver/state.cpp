// The digest of a state: two runs are the same run exactly when these agree.
#include "solver/state.hpp"

#include <bit>

#include "base/digest.hpp"
#include "solver/plain_numbers.hpp"

namespace bedload {

static_assert(std::endian::native == std::endian::little, "digests are over little-endian bytes");

std::string state_digest(const State& state) {
  Digest digest;
  State::each_field(state, [&](std::string_view name, const auto& field, std::string_view unit) {
    digest.add(name).add(unit);
    as_numbers(field, [&](auto numbers, ShapeView shape) {
      digest.add(std::uint64_t(shape.size()));
      for (const std::uint64_t extent : shape) digest.add(extent);
      digest.add(std::as_bytes(numbers));
    });
  });
  return digest.hex();
}

}   // namespace bedload

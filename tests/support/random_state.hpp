// A state full of varied numbers, for tests that carry it somewhere and back. It means nothing as physics.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string_view>
#include <vector>

#include "solver/state.hpp"

namespace bedload {

struct StateSize {
  std::size_t grains = 17, contacts = 23, rows = 5;   // rows of each column of the record
  std::array<int, 3> cells{5, 4, 3};
};

/// Finite numbers of many magnitudes, and every eighth one of those that lose something on a careless way: nan, both
/// infinities, minus zero, the smallest and the largest. Ghosts are zero.
class RandomState {
 public:
  explicit RandomState(std::uint64_t seed, StateSize size = {}) : bits_(seed), size_(size) {}

  State make() {
    State state;
    State::each_field(state, [&](std::string_view name, auto& field, const char*) { fill(field, length_of(name)); });
    return state;
  }

 private:
  std::size_t length_of(std::string_view name) const {
    return name.starts_with("grains/") ? size_.grains : name.starts_with("contacts/") ? size_.contacts : size_.rows;
  }
  double any_double() {
    using Limits = std::numeric_limits<double>;
    constexpr std::array special{Limits::quiet_NaN(),  Limits::infinity(), -Limits::infinity(), -0.0,
                                 Limits::denorm_min(), Limits::max(),      Limits::lowest(),    Limits::epsilon()};
    if (bits_() % 8 == 0) return special[bits_() % special.size()];
    return std::ldexp(double(std::int64_t(bits_())), int(bits_() % 120) - 120);
  }
  void fill(double& number, std::size_t) { number = any_double(); }
  void fill(std::uint64_t& number, std::size_t) { number = bits_(); }
  void fill(Vec3& vector, std::size_t) { vector = {any_double(), any_double(), any_double()}; }
  void fill(std::uint32_t& number, std::size_t) { number = std::uint32_t(bits_()); }
  void fill(std::uint8_t& number, std::size_t) { number = std::uint8_t(bits_()); }
  template <class Element>
  void fill(std::vector<Element>& elements, std::size_t length) {
    elements.resize(length);
    for (Element& element : elements) fill(element, 0);
  }
  template <class Where>
  void fill(Field<Where>& field, std::size_t) {
    const StaggeredGrid grid{.cells = size_.cells};
    if (grid.cell_count() > 0) field = Field<Where>(grid);
    for (int i = 0; i < grid.cells[0]; ++i)
      for (int j = 0; j < grid.cells[1]; ++j)
        for (int k = 0; k < grid.cells[2]; ++k) field[grid.index(i, j, k)] = any_double();
  }

  std::mt19937_64 bits_;
  StateSize size_;
};

inline State random_state(std::uint64_t seed, StateSize size = {}) { return RandomState(seed, size).make(); }

}   // namespace bedload

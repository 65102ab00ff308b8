// Vectors of floats for loops that compilers do not vectorise by themselves. The same bits whatever the machine's width.
#pragma once

#include <cstring>

namespace bedload {

typedef float FourFloats __attribute__((vector_size(16)));
typedef float EightFloats __attribute__((vector_size(32)));
typedef double FourDoubles __attribute__((vector_size(32)));

template <class Vector>
inline Vector load(const float* from) noexcept {
  Vector v;
  std::memcpy(&v, from, sizeof v);
  return v;
}
template <class Vector>
inline void store(float* to, Vector v) noexcept {
  std::memcpy(to, &v, sizeof v);
}

/// body(vector of zeros, m) for m = 0, 8, ... and perhaps one last vector of four; `count` is a multiple of four.
template <class Body>
inline __attribute__((always_inline)) void for_each_vector(int count, Body&& body) noexcept {
  int m = 0;
  for (; m + 8 <= count; m += 8) body(EightFloats{}, m);
  if (m < count) body(FourFloats{}, m);
}

/// Sum of products of floats, in double precision and eight lanes by position.
class DotProduct {
 public:
  /// `count` is a multiple of four.
  void add(int count, const float* a, const float* b) noexcept {
    int m = 0;
    for (; m + 8 <= count; m += 8) {
      low_ += wide(a + m) * wide(b + m);
      high_ += wide(a + m + 4) * wide(b + m + 4);
    }
    if (m < count) low_ += wide(a + m) * wide(b + m);
  }
  double value() const noexcept {
    const FourDoubles s = low_ + high_;
    return (s[0] + s[1]) + (s[2] + s[3]);
  }

 private:
  static FourDoubles wide(const float* p) noexcept { return __builtin_convertvector(load<FourFloats>(p), FourDoubles); }
  FourDoubles low_{}, high_{};
};

}   // namespace bedload

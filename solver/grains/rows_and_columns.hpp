// Registers full of pairs: the rows in which grains lie in memory, turned into columns of one quantity each and back.
#pragma once

#include <immintrin.h>

#include <cstddef>

#include "solver/grains/lanes.hpp"

namespace bedload {

using Row2 = double __attribute__((vector_size(16)));
using Row4 = double __attribute__((vector_size(32)));
using Row8 = float __attribute__((vector_size(32)));

#if defined(__AVX512F__)
constexpr int lanes = 16;
constexpr __mmask8 every = 0xFF;   // the forms without a mask warn of a value that is not set
using Floats = float __attribute__((vector_size(64)));
using Doubles = double __attribute__((vector_size(64)));   // half as many
#else
constexpr int lanes = 8;
using Floats = Row8;
using Doubles = Row4;
#endif

template <class Register>
constexpr std::size_t alignment_of = sizeof(Register) < 64 ? sizeof(Register) : 64;

/// Not through a cast: rows are structs of named numbers.
template <class Register, std::size_t alignment = alignment_of<Register>, class Number>
BEDLOAD_INLINE Register load(const Number* at) {
  Register r;
  __builtin_memcpy(&r, __builtin_assume_aligned(at, alignment), sizeof(Register));
  return r;
}
template <class Register, std::size_t alignment = alignment_of<Register>, class Number>
BEDLOAD_INLINE void store(Number* at, Register r) {
  __builtin_memcpy(__builtin_assume_aligned(at, alignment), &r, sizeof(Register));
}

// By name: the compiler converts rows of four two by two.

/// Two rows of four numbers in double.
struct TwoRows {
#if defined(__AVX512F__)
  Doubles both{};
  BEDLOAD_INLINE void add_in_double(const float* at) {
    both += Doubles(_mm512_maskz_cvtps_pd(every, _mm256_load_ps(at)));
  }
  BEDLOAD_INLINE Row4 first() const { return __builtin_shufflevector(both, both, 0, 1, 2, 3); }
  BEDLOAD_INLINE Row4 second() const { return __builtin_shufflevector(both, both, 4, 5, 6, 7); }
#else
  Row4 rows[2]{};
  BEDLOAD_INLINE void add_in_double(const float* at) {
    rows[0] += Row4(_mm256_cvtps_pd(_mm_load_ps(at)));
    rows[1] += Row4(_mm256_cvtps_pd(_mm_load_ps(at + 4)));
  }
  BEDLOAD_INLINE Row4 first() const { return rows[0]; }
  BEDLOAD_INLINE Row4 second() const { return rows[1]; }
#endif
};
BEDLOAD_INLINE void store_in_float(float* at, Row4 row) { _mm_store_ps(at, _mm256_cvtpd_ps(__m256d(row))); }

BEDLOAD_INLINE Floats join(Doubles low, Doubles high) {
#if defined(__AVX512F__)
  const Row8 a = Row8(_mm512_maskz_cvtpd_ps(every, __m512d(low))),
             b = Row8(_mm512_maskz_cvtpd_ps(every, __m512d(high)));
  return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
#else
  return Floats(_mm256_set_m128(_mm256_cvtpd_ps(__m256d(high)), _mm256_cvtpd_ps(__m256d(low))));
#endif
}

/// The first three columns of rows of four, one row for each lane.
BEDLOAD_INLINE void turn_rows(const Row4 (&row)[lanes / 2], Doubles& x, Doubles& y, Doubles& z) {
#if defined(__AVX512F__)
  Doubles r[4];   // rows k and k + 4
  for (int k = 0; k < 4; ++k) r[k] = __builtin_shufflevector(row[k], row[k + 4], 0, 1, 2, 3, 4, 5, 6, 7);
  const Doubles xz01 = __builtin_shufflevector(r[0], r[1], 0, 8, 2, 10, 4, 12, 6, 14);
  const Doubles xz23 = __builtin_shufflevector(r[2], r[3], 0, 8, 2, 10, 4, 12, 6, 14);
  const Doubles y01 = __builtin_shufflevector(r[0], r[1], 1, 9, 3, 11, 5, 13, 7, 15);
  const Doubles y23 = __builtin_shufflevector(r[2], r[3], 1, 9, 3, 11, 5, 13, 7, 15);
  x = __builtin_shufflevector(xz01, xz23, 0, 1, 8, 9, 4, 5, 12, 13);
  z = __builtin_shufflevector(xz01, xz23, 2, 3, 10, 11, 6, 7, 14, 15);
  y = __builtin_shufflevector(y01, y23, 0, 1, 8, 9, 4, 5, 12, 13);
#else
  const Doubles xz01 = __builtin_shufflevector(row[0], row[1], 0, 4, 2, 6);
  const Doubles xz23 = __builtin_shufflevector(row[2], row[3], 0, 4, 2, 6);
  const Doubles y01 = __builtin_shufflevector(row[0], row[1], 1, 5, 3, 7);
  const Doubles y23 = __builtin_shufflevector(row[2], row[3], 1, 5, 3, 7);
  x = __builtin_shufflevector(xz01, xz23, 0, 1, 4, 5);
  z = __builtin_shufflevector(xz01, xz23, 2, 3, 6, 7);
  y = __builtin_shufflevector(y01, y23, 0, 1, 4, 5);
#endif
}

/// Eight columns of eight rows; with 16 lanes, twice at once: register k then holds rows k and k + 8. Its own inverse.
BEDLOAD_INLINE void turn_eight(Floats (&r)[8]) {
#if defined(__AVX512F__)
#define BEDLOAD_LOW(a, b) __builtin_shufflevector(a, b, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29)
#define BEDLOAD_HIGH(a, b) __builtin_shufflevector(a, b, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31)
#define BEDLOAD_EVEN(a, b) __builtin_shufflevector(a, b, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29)
#define BEDLOAD_ODD(a, b) __builtin_shufflevector(a, b, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31)
#define BEDLOAD_FIRST(a, b) __builtin_shufflevector(a, b, 0, 1, 2, 3, 16, 17, 18, 19, 8, 9, 10, 11, 24, 25, 26, 27)
#define BEDLOAD_SECOND(a, b) __builtin_shufflevector(a, b, 4, 5, 6, 7, 20, 21, 22, 23, 12, 13, 14, 15, 28, 29, 30, 31)
#else
#define BEDLOAD_LOW(a, b) __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13)
#define BEDLOAD_HIGH(a, b) __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15)
#define BEDLOAD_EVEN(a, b) __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13)
#define BEDLOAD_ODD(a, b) __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15)
#define BEDLOAD_FIRST(a, b) __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11)
#define BEDLOAD_SECOND(a, b) __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15)
#endif
  Floats pair[8];   // columns two by two, of rows two by two
  for (int k = 0; k < 4; ++k) {
    pair[2 * k] = BEDLOAD_LOW(r[2 * k], r[2 * k + 1]);
    pair[2 * k + 1] = BEDLOAD_HIGH(r[2 * k], r[2 * k + 1]);
  }
  Floats four[8];   // of rows four by four
  for (int k = 0; k < 2; ++k)
    for (int half = 0; half < 2; ++half) {
      four[4 * k + 2 * half] = BEDLOAD_EVEN(pair[4 * k + half], pair[4 * k + 2 + half]);
      four[4 * k + 2 * half + 1] = BEDLOAD_ODD(pair[4 * k + half], pair[4 * k + 2 + half]);
    }
  for (int k = 0; k < 4; ++k) {
    r[k] = BEDLOAD_FIRST(four[k], four[4 + k]);
    r[4 + k] = BEDLOAD_SECOND(four[k], four[4 + k]);
  }
#undef BEDLOAD_LOW
#undef BEDLOAD_HIGH
#undef BEDLOAD_EVEN
#undef BEDLOAD_ODD
#undef BEDLOAD_FIRST
#undef BEDLOAD_SECOND
}

/// Two registers that go through the law together: each waits for its roots and quotients while the other is worked on.
struct Wide {
  Floats part[2];
};
struct WideMask {
  decltype(Floats{} > Floats{}) part[2];
};
BEDLOAD_INLINE Wide operator+(Wide a, Wide b) { return {{a.part[0] + b.part[0], a.part[1] + b.part[1]}}; }
BEDLOAD_INLINE Wide operator-(Wide a, Wide b) { return {{a.part[0] - b.part[0], a.part[1] - b.part[1]}}; }
BEDLOAD_INLINE Wide operator*(Wide a, Wide b) { return {{a.part[0] * b.part[0], a.part[1] * b.part[1]}}; }
BEDLOAD_INLINE Wide operator/(Wide a, Wide b) { return {{a.part[0] / b.part[0], a.part[1] / b.part[1]}}; }
BEDLOAD_INLINE Wide operator-(Wide a) { return {{-a.part[0], -a.part[1]}}; }
BEDLOAD_INLINE Wide operator*(float s, Wide a) { return {{s * a.part[0], s * a.part[1]}}; }
BEDLOAD_INLINE Wide operator*(Wide a, float s) { return {{a.part[0] * s, a.part[1] * s}}; }
BEDLOAD_INLINE Wide operator+(Wide a, float s) { return {{a.part[0] + s, a.part[1] + s}}; }
BEDLOAD_INLINE WideMask operator>(Wide a, Wide b) { return {{a.part[0] > b.part[0], a.part[1] > b.part[1]}}; }
BEDLOAD_INLINE WideMask operator<(Wide a, Wide b) { return b > a; }
BEDLOAD_INLINE Wide choose(WideMask first, Wide a, Wide b) {
  return {{first.part[0] ? a.part[0] : b.part[0], first.part[1] ? a.part[1] : b.part[1]}};
}
BEDLOAD_INLINE Floats root(Floats x) {
  Floats r;
  for (int k = 0; k < lanes; ++k) r[k] = __builtin_sqrtf(x[k]);   // one instruction
  return r;
}
BEDLOAD_INLINE Wide root(Wide x) { return {{root(x.part[0]), root(x.part[1])}}; }

}   // namespace bedload

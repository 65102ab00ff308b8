// Four doubles that go through the same arithmetic.
#pragma once

#include <cmath>

#include "base/vec3.hpp"

namespace bedload {

/// Values that belong to one cell: on its lower faces normal to x, y and z, and in it; or on its lower edges along x, y and z.
/// Or one value each of four grains.
using Quad = double __attribute__((vector_size(32)));
using QuadMask = long long __attribute__((vector_size(32)));   // all bits of an entry, or none

inline Quad quad(double each) noexcept { return Quad{each, each, each, each}; }
/// The entry of the cell has no meaning.
inline Quad quad(Vec3 v) noexcept { return Quad{v.x, v.y, v.z, v.z}; }
inline Vec3 on_faces(Quad q) noexcept { return {q[0], q[1], q[2]}; }
inline double in_cell(Quad q) noexcept { return q[3]; }

/// a b + c with one rounding, asked for by name: the same bits whatever the compiler would contract.
inline Quad fused(Quad a, Quad b, Quad c) noexcept {
#ifdef __FMA__
  return __builtin_ia32_vfmaddpd256(a, b, c);
#else
  for (int t = 0; t < 4; ++t) c[t] = std::fma(a[t], b[t], c[t]);
  return c;
#endif
}

/// Rounded down.
inline Quad floor_of(Quad x) noexcept {
#ifdef __AVX__
  return __builtin_ia32_roundpd256(x, 0x09);   // towards minus infinity, without a flag
#else
  for (int t = 0; t < 4; ++t) x[t] = std::floor(x[t]);
  return x;
#endif
}

}   // namespace bedload

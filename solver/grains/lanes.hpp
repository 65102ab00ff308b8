// Numbers side by side: what a law needs to be written once, for one contact or for as many as a register holds.
#pragma once

// Inlined by force: an object built for newer processors must not leave behind a function that others are linked with.
#define BEDLOAD_INLINE [[gnu::always_inline]] inline

namespace bedload {

BEDLOAD_INLINE double root(double x) { return __builtin_sqrt(x); }
BEDLOAD_INLINE float root(float x) { return __builtin_sqrtf(x); }
BEDLOAD_INLINE double choose(bool first, double a, double b) { return first ? a : b; }
BEDLOAD_INLINE float choose(bool first, float a, float b) { return first ? a : b; }

/// A vector in space whose components are numbers side by side.
template <class Real>
struct Vector {
  Real x, y, z;
};
template <class Real>
BEDLOAD_INLINE Vector<Real> operator+(Vector<Real> a, Vector<Real> b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class Real>
BEDLOAD_INLINE Vector<Real> operator-(Vector<Real> a, Vector<Real> b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Real>
BEDLOAD_INLINE Vector<Real> operator-(Vector<Real> a) {
  return {-a.x, -a.y, -a.z};
}
template <class Real>
BEDLOAD_INLINE Vector<Real> operator*(Real s, Vector<Real> a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class Real>
BEDLOAD_INLINE Real dot(Vector<Real> a, Vector<Real> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Real>
BEDLOAD_INLINE Vector<Real> cross(Vector<Real> a, Vector<Real> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}   // namespace bedload

// A vector in space: three doubles with the arithmetic of the equations.
#pragma once

#include <cmath>

namespace bedload {

/// Cartesian vector; x along the flow, y across, z away from the bottom wall.
struct Vec3 {
  double x = 0, y = 0, z = 0;

  constexpr double& operator[](int c) { return c == 0 ? x : c == 1 ? y : z; }
  constexpr double operator[](int c) const { return c == 0 ? x : c == 1 ? y : z; }
  constexpr Vec3& operator+=(Vec3 b) { return x += b.x, y += b.y, z += b.z, *this; }
  constexpr Vec3& operator-=(Vec3 b) { return x -= b.x, y -= b.y, z -= b.z, *this; }
  constexpr Vec3& operator*=(double s) { return x *= s, y *= s, z *= s, *this; }
  constexpr bool operator==(const Vec3&) const = default;
};

constexpr Vec3 operator+(Vec3 a, Vec3 b) { return a += b; }
constexpr Vec3 operator-(Vec3 a, Vec3 b) { return a -= b; }
constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
constexpr Vec3 operator*(double s, Vec3 a) { return a *= s; }
constexpr Vec3 operator*(Vec3 a, double s) { return a *= s; }
constexpr Vec3 operator/(Vec3 a, double s) { return {a.x / s, a.y / s, a.z / s}; }
/// Axis by axis: the action of a diagonal tensor.
constexpr Vec3 scaled(Vec3 a, Vec3 by) { return {a.x * by.x, a.y * by.y, a.z * by.z}; }
constexpr double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vec3 cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
constexpr double norm2(Vec3 a) { return dot(a, a); }
inline double norm(Vec3 a) { return std::sqrt(norm2(a)); }

}   // namespace bedload

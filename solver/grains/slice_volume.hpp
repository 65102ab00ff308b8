// How much of a sphere lies between two planes.
#pragma once

#include <algorithm>
#include <numbers>

namespace bedload {

/// Volume of a sphere of radius R about the origin between the planes z = a and z = b (a <= b), [m3]:
/// pi [R^2 (b - a) + (a^3 - b^3)/3] with a, b cut to [-R, R].
inline double slice_volume(double radius, double a, double b) noexcept {
  a = std::clamp(a, -radius, radius);
  b = std::clamp(b, -radius, radius);
  return std::numbers::pi * (b - a) * (radius * radius - (a * a + a * b + b * b) / 3);
}

}   // namespace bedload

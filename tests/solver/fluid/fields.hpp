// Fields filled from functions of position, and norms, for tests of the fluid.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>

#include "solver/fluid/face_loops.hpp"

namespace bedload::test {

inline constexpr Side periodic = Side::periodic;
inline constexpr Side wall = Side::wall;

inline Vec3 centre_position(const StaggeredGrid& g, int i, int j, int k) {
  return {(i + 0.5) * g.h.x, (j + 0.5) * g.h.y, (k + 0.5) * g.h.z};
}
inline Vec3 face_position(const StaggeredGrid& g, int c, int i, int j, int k) {
  Vec3 x = centre_position(g, i, j, k);
  x[c] -= 0.5 * g.h[c];
  return x;
}

/// Calls visit(i, j, k) for every stored point, ghosts included.
template <class Visit>
void for_each_stored(const StaggeredGrid& g, Visit&& visit) {
  for (int i = -2; i < g.cells[0] + 2; ++i)
    for (int j = -2; j < g.cells[1] + 2; ++j)
      for (int k = -2; k < g.cells[2] + 2; ++k) visit(i, j, k);
}

/// The function at every stored centre or face, ghosts included.
template <class Function>
Field<Centre> on_centres(const StaggeredGrid& g, Function&& value) {
  Field<Centre> f(g);
  for_each_stored(g, [&](int i, int j, int k) { f[g.index(i, j, k)] = value(centre_position(g, i, j, k)); });
  return f;
}
template <class Function>
FaceFields on_faces(const StaggeredGrid& g, Function&& vector) {
  FaceFields f(g);
  for (int c = 0; c < 3; ++c)
    for_each_stored(
        g, [&](int i, int j, int k) { f.component(c)[g.index(i, j, k)] = vector(face_position(g, c, i, j, k))[c]; });
  return f;
}

/// Uniform random numbers in [low, high) on every stored point.
inline Field<Centre> random_centres(const StaggeredGrid& g, unsigned seed, double low, double high) {
  Field<Centre> f(g);
  std::mt19937 random(seed);
  for (double& x : f.values) x = low + (high - low) * (random() / 4294967296.0);
  return f;
}
inline FaceFields random_faces(const StaggeredGrid& g, unsigned seed, double low, double high) {
  FaceFields f(g);
  for (int c = 0; c < 3; ++c) {
    const Field<Centre> values = random_centres(g, seed + 1000 * c, low, high);
    std::copy(values.values.begin(), values.values.end(), f.component(c));
  }
  return f;
}

}   // namespace bedload::test

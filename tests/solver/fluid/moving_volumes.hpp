// Point volumes that move through a box, and the void fractions and volume flux that belong to them: cells by quadratic
// B-splines in all directions, faces by a hat along their normal and quadratic B-splines across, folded at walls.
#pragma once

#include <vector>

#include "fields.hpp"
#include "solver/fluid/boundaries.hpp"

namespace bedload::test {

inline double hat(double x) { return std::max(0.0, 1 - std::abs(x)); }
inline double spline(double x) {
  x = std::abs(x);
  return x < 0.5 ? 0.75 - x * x : x < 1.5 ? 0.5 * (1.5 - x) * (1.5 - x) : 0;
}

/// Weights of a volume at coordinate x [cell edges] on the n cells (or n + 1 faces) along one direction.
template <class Shape>
std::vector<double> weights(double x, int n, Side side, bool faces, Shape shape) {
  std::vector<double> w(n + 1, 0.0);
  for (int i = -n - 3; i < 2 * n + 4; ++i) {
    const double value = shape(x - i - (faces ? 0 : 0.5));
    if (value == 0) continue;
    if (side == Side::periodic) w[((i % n) + n) % n] += value;
    else if (faces) w[i] += value;   // a hat inside the box never reaches beyond its walls
    else w[i < 0 ? -1 - i : i >= n ? 2 * n - 1 - i : i] += value;
  }
  return w;
}

struct MovingVolumes {
  std::vector<Vec3> position;   // in cell edges
  double share = 0.02;          // volume of each per cell volume

  Field<Centre> void_on_centres(const StaggeredGrid& g) const {
    Field<Centre> eps(g, 1);
    deposit(g, 3, eps.data(), -share);
    return eps;
  }
  FaceFields void_on_faces(const StaggeredGrid& g) const {
    FaceFields eps(g, 1);
    for (int c = 0; c < 3; ++c) deposit(g, c, eps.component(c), -share);
    return eps;
  }
  /// Adds amount x weight on the faces normal to c (c = 3: on cells).
  void deposit(const StaggeredGrid& g, int c, double* field, double amount) const {
    for (const Vec3& x : position) {
      std::vector<double> w[3];
      for (int d = 0; d < 3; ++d)
        w[d] = d == c ? weights(x[d], g.cells[d], g.sides[d], true, hat)
                      : weights(x[d], g.cells[d], g.sides[d], false, spline);
      for (int i = 0; i <= g.cells[0]; ++i)
        for (int j = 0; j <= g.cells[1]; ++j)
          for (int k = 0; k <= g.cells[2]; ++k) field[g.index(i, j, k)] += amount * w[0][i] * w[1][j] * w[2][k];
    }
  }
  /// Moves volume p by `travel` (below one cell) along c; adds to `flux` the mean flux that this carries in dt, so that
  /// d(phi)/dt + div flux = 0 on every cell exactly.
  void move(const StaggeredGrid& g, std::size_t p, int c, double travel, double dt, FaceFields& flux) {
    const int n = g.cells[c], d = (c + 1) % 3, e = (c + 2) % 3;
    Vec3& x = position[p];
    const int lowest = static_cast<int>(std::floor(x[c])) - 3;
    const auto across = [&](int m) { return weights(x[m], g.cells[m], g.sides[m], false, spline); };
    const std::vector<double> wd = across(d), we = across(e);
    double swept = 0;
    for (int i = lowest; i < lowest + 7;
         ++i) {   // through the upper face of cell i passes what the cells up to i have lost
      swept += spline(x[c] - i - 0.5) - spline(x[c] + travel - i - 0.5);
      if (!g.periodic(c) && (i + 1 <= 0 || i + 1 >= n)) continue;   // the folded spline sends nothing through walls
      const int face = g.periodic(c) ? (((i + 1) % n) + n) % n : i + 1;
      double folded = swept;
      if (!g.periodic(c)) folded = swept_with_images(x[c], travel, i, n);
      for (int a = 0; a < g.cells[d]; ++a)
        for (int b = 0; b < g.cells[e]; ++b) {
          int m[3];
          m[c] = face, m[d] = a, m[e] = b;
          flux.component(c)[g.index(m[0], m[1], m[2])] += share * g.h[c] / dt * folded * wd[a] * we[b];
        }
    }
    x[c] += travel;
    if (g.periodic(c)) x[c] -= n * std::floor(x[c] / n);
  }

 private:
  /// What the cells 0..i lose, each with its mirror image beyond the walls.
  static double swept_with_images(double x, double travel, int i, int n) {
    const std::vector<double> before = weights(x, n, Side::wall, false, spline);
    const std::vector<double> after = weights(x + travel, n, Side::wall, false, spline);
    double lost = 0;
    for (int m = 0; m <= i; ++m) lost += before[m] - after[m];
    return lost;
  }
};

}   // namespace bedload::test

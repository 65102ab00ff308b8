// Momentum carried through the sides of each face's control volume, by a flux that closes on that volume.
#include "solver/fluid/momentum.hpp"

#include <algorithm>

#include "solver/fluid/boundaries.hpp"
#include "solver/fluid/flux_closure.hpp"
#include "solver/fluid/operators.hpp"
#include "solver/fluid/rows.hpp"

namespace bedload {
namespace {

/// Value at the side between `low` and `high`, seen from upwind, with van Leer's limiter (J. Comput. Phys. 14, 1974):
/// half of the harmonic mean of the slopes on both sides of the upwind value.
inline double upwind_value(double flux, double below, double low, double high, double above) noexcept {
  const bool forward = flux > 0;
  const double upwind = forward ? low : high, near = high - low;
  const double ahead = forward ? near : -near, behind = forward ? low - below : high - above;
  const double product = ahead * behind;
  return upwind + (product > 0 ? product / (ahead + behind) : 0.0);
}

/// Momentum flux through a row of sides along t, of the control volumes of component c; side k lies below face `upper +
/// k`.
void row_of_sides(const StaggeredGrid& g, int c, int t, std::size_t upper, int length, const double* flux,
                  const double* correction, const double* velocity, double* out) noexcept {
  const std::ptrdiff_t s = g.stride(t);
  const double* __restrict first = flux + upper - g.stride(c);
  const double* __restrict second = flux + upper;
  const double* __restrict u = velocity + upper;
  double* __restrict side = out;
  if (c == t) {
    const double* __restrict d = correction + upper - s;
    for (int k = 0; k < length; ++k) {
      const double f = 0.5 * (first[k] + second[k]) + d[k];
      side[k] = f * upwind_value(f, u[k - 2 * s], u[k - s], u[k], u[k + s]);
    }
  } else {
    for (int k = 0; k < length; ++k) {
      const double f = 0.5 * (first[k] + second[k]);
      side[k] = f * upwind_value(f, u[k - 2 * s], u[k - s], u[k], u[k + s]);
    }
  }
}

void subtract_difference(const double* __restrict low, const double* __restrict high, double factor, int length,
                         double* __restrict momentum) noexcept {
  for (int k = 0; k < length; ++k) momentum[k] -= factor * (high[k] - low[k]);
}

/// Takes from `momentum` of component c what leaves through the sides along t in dt.
void carry_along(const StaggeredGrid& g, int c, int t, const double* flux, const double* correction,
                 const double* velocity, double dt, double* momentum, std::vector<double>& rows) noexcept {
  double* low = rows.data();
  double* high = low + rows.size() / 2;
  const double factor = dt / g.h[t];
  const int k0 = c == 2 ? g.first_face(2) : 0, length = g.cells[2] - k0;
  if (t == 2) {
    for_each_face_row(g, c, [&](std::size_t row, int faces) {
      row_of_sides(g, c, t, row, faces + 1, flux, correction, velocity, low);
      subtract_difference(low, low + 1, factor, faces, momentum + row);
    });
    return;
  }
  const int other = 1 - t;
  for (int m = c == other ? g.first_face(c) : 0; m < g.cells[other]; ++m) {
    const int first = c == t ? g.first_face(c) : 0;
    std::size_t row = g.index(0, 0, k0) + m * g.stride(other) + first * g.stride(t);
    row_of_sides(g, c, t, row, length, flux, correction, velocity, low);
    for (int i = first; i < g.cells[t]; ++i, row += g.stride(t), std::swap(low, high)) {
      row_of_sides(g, c, t, row + g.stride(t), length, flux, correction, velocity, high);
      subtract_difference(low, high, factor, length, momentum + row);
    }
  }
}

/// div F with the ghosts that close_flux() reads.
void find_divergence(const StaggeredGrid& g, const FaceFields& flux, Field<Centre>& out) {
  divergence(g, flux, out);
  fill_centre_ghosts(g, out);
  for (int c = 0; c < 3; ++c) {
    if (g.periodic(c)) continue;
    const int a = c == 0 ? 1 : 0, b = c == 2 ? 1 : 2;
    double* low = out.data() + g.index(0, 0, 0) - g.stride(c);
    for (int m = 0; m < g.cells[a]; ++m)
      for (int n = 0; n < g.cells[b]; ++n) {
        double* outside = low + m * g.stride(a) + n * g.stride(b);
        outside[0] = outside[(g.cells[c] + 1) * g.stride(c)] = 0;
      }
  }
}

void prepare(const StaggeredGrid& g, TransportScratch& scratch) {
  if (scratch.correction.cells == g.cells) return;
  scratch.divergence = scratch.correction = scratch.momentum = Field<Centre>(g);
  scratch.rows.assign(2 * (g.cells[2] + 2 * StaggeredGrid::ghosts), 0.0);
}

}   // namespace

void transport(const StaggeredGrid& g, const FaceFields& flux, const FaceFields& void_before,
               const FaceFields& void_after, double dt, const FaceFields& carried, FaceFields& velocity,
               TransportScratch& scratch) {
  prepare(g, scratch);
  find_divergence(g, flux, scratch.divergence);
  double *momentum = scratch.momentum.data(), *correction = scratch.correction.data();
  for (int c = 0; c < 3; ++c) {
    const double *before = void_before.component(c), *after = void_after.component(c);
    double* u = velocity.component(c);
    close_flux(g, c, scratch.divergence, before, after, dt, correction, scratch.sums);
    for_each_face_row(g, c, [&](std::size_t row, int length) {
      for (std::size_t n = row; n < row + length; ++n) momentum[n] = before[n] * u[n];
    });
    for (int t = 0; t < 3; ++t)
      carry_along(g, c, t, flux.component(t), correction, carried.component(c), dt, momentum, scratch.rows);
    for_each_face_row(g, c, [&](std::size_t row, int length) {
      for (std::size_t n = row; n < row + length; ++n) u[n] = momentum[n] / after[n];
    });
  }
}

}   // namespace bedload

// Momentum carried through the sides of each face's control volume, by a flux that closes on that volume.
#include "solver/fluid/momentum.hpp"

#include <algorithm>

#include "solver/fluid/boundaries.hpp"
#include "solver/fluid/operators.hpp"
#include "solver/fluid/rows.hpp"

namespace bedload {
namespace {

/// Neighbouring lines along one direction, worked on together: the entries of one position are `lanes` contiguous numbers.
struct Bundle {
  std::size_t first;     // index at position 0, lane 0
  std::ptrdiff_t step;   // from one position to the next
  int lanes;
};

template <class Body>
void for_each_bundle(const StaggeredGrid& g, int c, Body&& body) {
  if (c == 2) {
    for_each_cell_row(g, [&](std::size_t row, int) { body(Bundle{row, 1, 1}); });
    return;
  }
  const int other = 1 - c;
  for (int m = 0; m < g.cells[other]; ++m)
    body(Bundle{g.index(0, 0, 0) + m * g.stride(other), g.stride(c), g.cells[2]});
}

/// What the averaged flux lacks on the control volume of each face of a bundle: S = (eps' - eps)/dt + half the sum of the two
/// cells' divergence (cells outside a wall count zero). `mean` receives the mean of S over each line.
void line_sources(Bundle b, int faces, bool periodic, const double* divergence, const double* before,
                  const double* after, double dt, double* source, double* mean) noexcept {
  std::fill_n(mean, b.lanes, 0.0);
  for (int i = 0; i < faces; ++i) {
    const std::size_t at = b.first + i * b.step;
    const double low = periodic || i > 0 ? 0.5 : 0, high = periodic || i < faces - 1 ? 0.5 : 0;
    for (int l = 0; l < b.lanes; ++l) {
      const std::size_t n = at + l;
      source[n] = (after[n] - before[n]) / dt + low * divergence[n - b.step] + high * divergence[n];
      mean[l] += source[n];
    }
  }
  for (int l = 0; l < b.lanes; ++l) mean[l] /= faces;
}

/// Turns the sources into the correction D at the cell centre after each face: D_right = D_left - h (S - mean S).
/// Between walls D is zero outside; in a periodic line its mean is zero.
void integrate_sources(Bundle b, int cells, bool periodic, double h, double* correction, double* mean,
                       double* running) noexcept {
  std::fill_n(running, b.lanes, 0.0);
  for (int i = 0; i < cells; ++i)
    for (int l = 0; l < b.lanes; ++l) {
      double& d = correction[b.first + i * b.step + l];
      d = running[l] -= h * (d - mean[l]);
    }
  if (!periodic) return;
  std::fill_n(mean, b.lanes, 0.0);
  for (int i = 0; i < cells; ++i)
    for (int l = 0; l < b.lanes; ++l) mean[l] += correction[b.first + i * b.step + l] / cells;
  for (int i = 0; i < cells; ++i)
    for (int l = 0; l < b.lanes; ++l) correction[b.first + i * b.step + l] -= mean[l];
  std::copy_n(correction + b.first + (cells - 1) * b.step, b.lanes, correction + b.first - b.step);
}

/// The correction of component c's own flux, at cell centres (centre i stands at the index of face i).
void close_flux(const StaggeredGrid& g, int c, const double* before, const double* after, double dt,
                TransportScratch& scratch) {
  const bool periodic = g.periodic(c);
  const int cells = g.cells[c], faces = periodic ? cells : cells + 1;
  double* correction = scratch.face_source.component(c);
  double* mean = scratch.rows.data();
  double* running = mean + scratch.rows.size() / 2;
  for_each_bundle(g, c, [&](Bundle b) {
    line_sources(b, faces, periodic, scratch.divergence.data(), before, after, dt, correction, mean);
    integrate_sources(b, cells, periodic, g.h[c], correction, mean, running);
  });
}

/// Value at the side between `low` and `high`, seen from upwind, with van Leer's limiter (J. Comput. Phys. 14, 1974):
/// half of the harmonic mean of the slopes on both sides of the upwind value.
inline double upwind_value(double flux, double below, double low, double high, double above) noexcept {
  const bool forward = flux > 0;
  const double upwind = forward ? low : high, near = high - low;
  const double ahead = forward ? near : -near, behind = forward ? low - below : high - above;
  const double product = ahead * behind;
  return upwind + (product > 0 ? product / (ahead + behind) : 0.0);
}

/// Momentum flux through a row of sides along t, of the control volumes of component c; side k lies below face `upper + k`.
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

void prepare(const StaggeredGrid& g, TransportScratch& scratch) {
  if (scratch.divergence.values.size() == g.padded_size() && scratch.divergence.cells == g.cells) return;
  scratch.divergence = Field<Centre>(g);
  scratch.face_source = scratch.result = FaceFields(g);
  scratch.rows.assign(2 * (g.cells[2] + 2 * StaggeredGrid::ghosts), 0.0);
}

}   // namespace

void transport(const StaggeredGrid& g, const FaceFields& flux, const FaceFields& void_before,
               const FaceFields& void_after, double dt, FaceFields& velocity, TransportScratch& scratch) {
  prepare(g, scratch);
  divergence(g, flux, scratch.divergence);
  fill_centre_ghosts(g, scratch.divergence);
  for (int c = 0; c < 3; ++c) {
    const double* before = void_before.component(c);
    const double* after = void_after.component(c);
    double* u = velocity.component(c);
    double* momentum = scratch.result.component(c);
    close_flux(g, c, before, after, dt, scratch);
    for_each_face_row(g, c, [&](std::size_t row, int length) {
      for (std::size_t n = row; n < row + length; ++n) momentum[n] = before[n] * u[n];
    });
    for (int t = 0; t < 3; ++t)
      carry_along(g, c, t, flux.component(t), scratch.face_source.component(c), u, dt, momentum, scratch.rows);
    for_each_face_row(g, c, [&](std::size_t row, int length) {
      for (std::size_t n = row; n < row + length; ++n) u[n] = momentum[n] / after[n];
    });
  }
}

}   // namespace bedload

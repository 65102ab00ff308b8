// Momentum carried through the sides of each face's control volume, by a flux that closes on that volume.
#include "solver/fluid/momentum.hpp"

#include <algorithm>

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

/// The sides of a row of control volumes along x, y and z; the upper side along z is the next one's lower side.
struct Sides {
  double* __restrict x_low;   // becomes x_high, for the next plane
  const double *x_high, *y_low, *y_high, *z;
};

/// u = [eps u - dt sum over sides of (out - in)/h]/eps' on a row of faces; without `porous` eps is 1.
template <bool porous>
void advance_row(const Sides& side, Vec3 dt_per_h, const double* __restrict before, const double* __restrict after,
                 int length, double* __restrict u) noexcept {
  double* __restrict x_low = side.x_low;
  const double* __restrict x_high = side.x_high;
  for (int k = 0; k < length; ++k) {
    double momentum = porous ? before[k] * u[k] : u[k];
    momentum -= dt_per_h.x * (x_high[k] - x_low[k]);
    momentum -= dt_per_h.y * (side.y_high[k] - side.y_low[k]);
    momentum -= dt_per_h.z * (side.z[k + 1] - side.z[k]);
    u[k] = porous ? momentum / after[k] : momentum;
    x_low[k] = x_high[k];
  }
}

/// Carries component c in one pass: each side is found once and kept until both of its volumes have met it, along x for a
/// plane, along y for a row. Lines along y and z lie in one plane, which is closed when its turn comes; those along x do not.
template <class Close>
void carry(const StaggeredGrid& g, int c, const FaceFields& flux, const double* correction, const double* before,
           const double* after, const double* carried, double dt, double* velocity, std::vector<double>& sides,
           Close&& close) {
  const int i0 = c == 0 ? g.first_face(0) : 0, j0 = c == 1 ? g.first_face(1) : 0, k0 = c == 2 ? g.first_face(2) : 0;
  const int length = g.cells[2] - k0;
  const std::size_t width = g.cells[2] + 1;
  double* const x_low = sides.data();
  double *x_high = x_low + width * g.cells[1], *y_low = x_high + width, *y_high = y_low + width, *z = y_high + width;
  const auto find = [&](int t, std::size_t upper, int count, double* out) {
    row_of_sides(g, c, t, upper, count, flux.component(t), correction, carried, out);
  };
  for (int j = 0; c == 0 && j < g.cells[1]; ++j) close(j);
  for (int j = j0; j < g.cells[1]; ++j) find(0, g.index(i0, j, k0), length, x_low + j * width);
  for (int i = i0; i < g.cells[0]; ++i) {
    if (c != 0) close(i);
    find(1, g.index(i, j0, k0), length, y_low);
    for (int j = j0; j < g.cells[1]; ++j) {
      const std::size_t row = g.index(i, j, k0);
      find(0, row + g.stride(0), length, x_high);
      find(1, row + g.stride(1), length, y_high);
      find(2, row, length + 1, z);
      const Sides side{x_low + j * width, x_high, y_low, y_high, z};
      const Vec3 dt_per_h{dt / g.h.x, dt / g.h.y, dt / g.h.z};
      if (before) advance_row<true>(side, dt_per_h, before + row, after + row, length, velocity + row);
      else advance_row<false>(side, dt_per_h, nullptr, nullptr, length, velocity + row);
      std::swap(y_low, y_high);
    }
  }
}

/// div F with the ghosts that close_flux() reads: one layer, zero beyond walls.
void find_divergence(const StaggeredGrid& g, const FaceFields& flux, Field<Centre>& out) {
  divergence(g, flux, out);
  for (int c = 0; c < 3; ++c) {
    const int a = c == 0 ? 1 : 0, b = c == 2 ? 1 : 2;
    const std::ptrdiff_t beyond = g.cells[c] * g.stride(c);
    const bool periodic = g.periodic(c);
    for (int m = 0; m < g.cells[a]; ++m)
      for (int n = 0; n < g.cells[b]; ++n) {
        double* const first = out.data() + g.index(0, 0, 0) + m * g.stride(a) + n * g.stride(b);
        first[-g.stride(c)] = periodic ? first[beyond - g.stride(c)] : 0;
        first[beyond] = periodic ? first[0] : 0;
      }
  }
}

void prepare(const StaggeredGrid& g, TransportScratch& scratch) {
  if (scratch.correction.cells == g.cells) return;
  scratch.divergence = scratch.correction = Field<Centre>(g);
  scratch.sides.assign((g.cells[2] + 1) * (g.cells[1] + 4), 0.0);
}

/// Without void fractions, eps = 1.
void transport(const StaggeredGrid& g, const FaceFields& flux, const FaceFields* void_before,
               const FaceFields* void_after, double dt, const FaceFields& carried, FaceFields& velocity,
               TransportScratch& scratch) {
  prepare(g, scratch);
  find_divergence(g, flux, scratch.divergence);
  double* correction = scratch.correction.data();
  for (int c = 0; c < 3; ++c) {
    const double *before = void_before ? void_before->component(c) : nullptr,
                 *after = void_after ? void_after->component(c) : nullptr;
    carry(g, c, flux, correction, before, after, carried.component(c), dt, velocity.component(c), scratch.sides,
          [&](int plane) { close_flux(g, c, plane, scratch.divergence, before, after, dt, correction, scratch.sums); });
  }
}

}   // namespace

void transport(const StaggeredGrid& g, const FaceFields& flux, const FaceFields& void_before,
               const FaceFields& void_after, double dt, const FaceFields& carried, FaceFields& velocity,
               TransportScratch& scratch) {
  transport(g, flux, &void_before, &void_after, dt, carried, velocity, scratch);
}

void transport(const StaggeredGrid& g, const FaceFields& flux, double dt, const FaceFields& carried,
               FaceFields& velocity, TransportScratch& scratch) {
  transport(g, flux, nullptr, nullptr, dt, carried, velocity, scratch);
}

}   // namespace bedload

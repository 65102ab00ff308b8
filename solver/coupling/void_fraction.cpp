#include "solver/coupling/void_fraction.hpp"

#include "solver/fluid/face_loops.hpp"

namespace bedload {
namespace {

/// The spline of one direction before a move and after, on the four cells that a move of less than one cell can touch.
struct MovedSpline {
  double before[4] = {}, change[4] = {}, passed[4] = {};   // passed: what goes through the lower face of each cell
  int first;                                               // number of the first of the four cells
  int count;   // how many of them are touched: 3, or 4 if the grain changed its cell

  MovedSpline(double s, double moved, int n) noexcept {
    const int cell = cell_of(s, n);
    const int shift = std::clamp(static_cast<int>(std::floor(s + moved)) - cell, -1, 1);
    const int start = shift < 0 ? 1 : 0, end = shift > 0 ? 1 : 0;
    first = cell - 1 - start, count = 3 + start + end;
    const auto b = quadratic_spline(s - cell - 0.5);
    const auto a = quadratic_spline(s + moved - cell - shift - 0.5);
    for (int m = 0; m < 3; ++m) before[start + m] = b[m], change[start + m] -= b[m];
    for (int m = 0; m < 3; ++m) change[end + m] += a[m];
    for (int m = 1; m < count; ++m) passed[m] = passed[m - 1] - change[m - 1];
  }
};

/// Adds the flux that one grain sweeps: through each face what passes along the face's normal, times the mean over the move of
/// the product of the two splines b across it, b_1 b_2 + (d_1 b_2 + b_1 d_2)/2 + d_1 d_2/3 with the changes d; written as
/// b_1 (b_2 + d_2/2) + d_1 (b_2/2 + d_2/3), two products of one factor per direction.
void sweep(const MovedSpline (&s)[3], Strides stride, Quad amount, Quad* corner) noexcept {
  const auto halfway = [](const MovedSpline& m, int i) { return m.before[i] + 0.5 * m.change[i]; };
  const auto rest = [](const MovedSpline& m, int i) { return 0.5 * m.before[i] + m.change[i] / 3; };
  Quad y1[4], y2[4], z1[4], z2[4];
  for (int m = 0; m < 4; ++m) {
    y1[m] = Quad{s[1].before[m], s[1].passed[m], halfway(s[1], m), 0};
    y2[m] = Quad{s[1].change[m], s[1].passed[m], rest(s[1], m), 0};
    z1[m] = Quad{halfway(s[2], m), halfway(s[2], m), s[2].passed[m], 0};
    z2[m] = Quad{rest(s[2], m), rest(s[2], m), s[2].passed[m], 0};
  }
  for (int a = 0; a < s[0].count; ++a) {
    const Quad x1 = amount * Quad{s[0].passed[a], s[0].before[a], s[0].before[a], 0},
               x2 = amount * Quad{s[0].passed[a], s[0].change[a], s[0].change[a], 0};
    for (int b = 0; b < s[1].count; ++b) {
      const Quad line1 = x1 * y1[b], line2 = x2 * y2[b];
      Quad* cell = corner + a * stride.x + b * stride.y;
      for (int c = 0; c < s[2].count; ++c) cell[c] += line1 * z1[c] + line2 * z2[c];
    }
  }
}

void settle_flux(const StaggeredGrid& grid, SolidFlux& flux, const KernelSmoothing& smoothing) {
  flux.woven.settle(flux);
  clear_walls(grid, flux);
  smoothing.spread_flux(flux);
}

}   // namespace

void find_stencils(const StaggeredGrid& grid, const Grains& grains, Stencils& stencils) {
  stencils.of.resize(grains.size());
  stencils.reach = {};
  if (grains.size() == 0) return;
  std::array<int, 3> low = grid.cells, high{}, cell;
  for (std::size_t p = 0; p < grains.size(); ++p) {
    stencils.of[p] = Stencil(grid, grains.position[p], cell);
    for (int c = 0; c < 3; ++c) low[c] = std::min(low[c], cell[c]), high[c] = std::max(high[c], cell[c] + 1);
  }
  stencils.reach = widened(grid, {low, high}, 1);
}

void deposit_void_fraction(const StaggeredGrid& grid, const Grains& grains, const Stencils& stencils, VoidFraction& eps,
                           const KernelSmoothing& smoothing) {
  eps.woven.clear(stencils.reach);
  const double per_cell = 1 / grid.cell_volume();
  const Strides stride(grid);
  for (std::size_t p = 0; p < grains.size(); ++p)
    deposit(Weights(stencils[p]), stride, quad(sphere_volume(grains.diameter[p]) * per_cell),
            eps.woven.at(stencils[p]));
  for_each_row(grid, eps.solid.reach, [&](std::size_t row, int length) {
    std::fill_n(eps.centre.data() + row, length, 1.0);
    for (int c = 0; c < 3; ++c) std::fill_n(eps.face.component(c) + row, length, 1.0);
  });
  eps.woven.settle(eps.solid, &eps.solid_centre);
  smoothing.spread(eps.solid_centre), smoothing.spread(eps.solid);
  for_each_row(grid, eps.solid.reach, [&](std::size_t row, int length) {
    for (std::size_t n = row; n < row + length; ++n) eps.centre[n] = 1 - eps.solid_centre[n];
    for (int c = 0; c < 3; ++c)
      for (std::size_t n = row; n < row + length; ++n) eps.face.component(c)[n] = 1 - eps.solid.component(c)[n];
  });
  eps.overfilled.clear();
  for (int c = 0; c < 3; ++c)
    for_each_face_within(grid, c, eps.solid.reach, [&, e = eps.face.component(c)](std::size_t n) {
      if (e[n] >= least_face_void) return;
      eps.overfilled.push_back({c, n, (1 - least_face_void) / (1 - e[n])});
      e[n] = least_face_void;
    });
}

void deposit_solid_flux(const StaggeredGrid& grid, const Grains& grains, const Stencils& stencils, SolidFlux& flux,
                        const KernelSmoothing& smoothing) {
  flux.woven.clear(stencils.reach);
  const double per_cell = 1 / grid.cell_volume();
  const Strides stride(grid);
  for (std::size_t p = 0; p < grains.size(); ++p)
    if (!grains.fixed[p])
      deposit(Weights(stencils[p]), stride, quad(sphere_volume(grains.diameter[p]) * per_cell * grains.velocity[p]),
              flux.woven.at(stencils[p]));
  settle_flux(grid, flux, smoothing);
}

void deposit_swept_flux(const StaggeredGrid& grid, const Grains& grains, std::span<const Vec3> before,
                        std::span<const Vec3> moved, const Reach& reach, double dt, SolidFlux& flux,
                        const KernelSmoothing& smoothing) {
  flux.woven.clear(reach);
  const double per_step = 1 / (grid.cell_volume() * dt);
  const Strides stride(grid);
  for (std::size_t p = 0; p < grains.size(); ++p) {
    if (grains.fixed[p]) continue;
    const MovedSpline s[3] = {{before[p].x / grid.h.x, moved[p].x / grid.h.x, grid.cells[0]},
                              {before[p].y / grid.h.y, moved[p].y / grid.h.y, grid.cells[1]},
                              {before[p].z / grid.h.z, moved[p].z / grid.h.z, grid.cells[2]}};
    sweep(s, stride, quad(sphere_volume(grains.diameter[p]) * per_step * grid.h),
          flux.woven.data() + grid.index(s[0].first, s[1].first, s[2].first));
  }
  settle_flux(grid, flux, smoothing);
}

}   // namespace bedload

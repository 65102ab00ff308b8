#include "solver/coupling/void_fraction.hpp"

#include "solver/fluid/face_loops.hpp"

namespace bedload {
namespace {

/// The splines of all directions before a move and their change, on the four cells of each that a move of less than one cell
/// can touch.
struct MovedSplines {
  Quad before[4], change[4], passed[4];   // by cell, the fourth only where !stays; passed: through its lower face
  std::ptrdiff_t corner;                  // padded index of the first of the four cells
  bool stays;                             // in its cell, and touches three of them in each direction

  MovedSplines(const CellFinder& cells, Strides stride, Vec3 start, Vec3 moved) noexcept {
    const Quad s = cells.scaled(start), end = s + cells.scaled(moved), cell = cells.cell_of(s), none{}, one = none + 1;
    Quad shift = floor_of(end) - cell;
    shift = shift < -one ? -one : shift > one ? one : shift;
    const auto b = quadratic_spline(s - cell - 0.5), a = quadratic_spline(end - cell - shift - 0.5);   // of the offsets
    for (int m = 0; m < 3; ++m) before[m] = b[m], change[m] = a[m] - b[m];
    corner = cells.corner_of(cell);
    stays = shift[0] == 0 && shift[1] == 0 && shift[2] == 0;
    if (!stays) {
      before[3] = change[3] = none;
      const std::ptrdiff_t strides[] = {stride.x, stride.y, 1};
      for (int c = 0; c < 3; ++c) {
        if (shift[c] != 0) apart(c, static_cast<int>(shift[c]), b, a);
        if (shift[c] < 0) corner -= strides[c];
      }
    }
    passed[0] = none;
    for (int m = 1; m < (stays ? 3 : 4); ++m) passed[m] = passed[m - 1] - change[m - 1];
    if (stays) return;
    for (int c = 0; c < 3; ++c)
      if (shift[c] == 0) passed[3][c] = 0;
  }

 private:
  /// One direction again, where start and end lie on cells of their own.
  void apart(int c, int shift, const std::array<Quad, 3>& b, const std::array<Quad, 3>& a) noexcept {
    const int start = shift < 0 ? 1 : 0, end = 1 - start;
    for (int m = 0; m < 4; ++m) {
      before[m][c] = m >= start && m < start + 3 ? b[m - start][c] : 0;
      change[m][c] = (m >= end && m < end + 3 ? a[m - end][c] : 0) - before[m][c];
    }
  }
};

/// Adds the flux that one grain sweeps: through each face what passes along the face's normal, times the mean over the move of
/// the product of the two splines b across it, b_1 b_2 + (d_1 b_2 + b_1 d_2)/2 + d_1 d_2/3 with the changes d; written as
/// b_1 (b_2 + d_2/2) + d_1 (b_2/2 + d_2/3), two products of one factor per direction.
template <int cells>
void sweep(const MovedSplines& s, Strides stride, Quad amount, Quad* corner) noexcept {
  Quad y1[cells], y2[cells], z1[cells], z2[cells];
  for (int m = 0; m < cells; ++m) {
    const Quad halfway = s.before[m] + 0.5 * s.change[m], rest = 0.5 * s.before[m] + s.change[m] / 3;
    y1[m] = quad({s.before[m][1], s.passed[m][1], halfway[1]});
    y2[m] = quad({s.change[m][1], s.passed[m][1], rest[1]});
    z1[m] = quad({halfway[2], halfway[2], s.passed[m][2]});
    z2[m] = quad({rest[2], rest[2], s.passed[m][2]});
  }
  for (int a = 0; a < cells; ++a) {
    const double passed = s.passed[a][0], before = s.before[a][0], change = s.change[a][0];
    const Quad x1 = amount * quad({passed, before, before}), x2 = amount * quad({passed, change, change});
    for (int b = 0; b < cells; ++b) {
      const Quad line1 = x1 * y1[b], line2 = x2 * y2[b];
      Quad* cell = corner + a * stride.x + b * stride.y;
      for (int c = 0; c < cells; ++c) cell[c] = fused(line2, z2[c], fused(line1, z1[c], cell[c]));
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
  for_each_row_beyond(grid, eps.solid.reach, home_of(grid, stencils.reach), [&](std::size_t row, int length) {
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
  flux.woven.clear(across_seams(grid, reach));
  const double per_step = 1 / (grid.cell_volume() * dt);
  const Strides stride(grid);
  const CellFinder cells(grid);
  for (std::size_t p = 0; p < grains.size(); ++p) {
    if (grains.fixed[p]) continue;
    const MovedSplines s(cells, stride, before[p], moved[p]);
    const Quad amount = sphere_volume(grains.diameter[p]) * per_step * cells.edges();
    Quad* const corner = flux.woven.data() + s.corner;
    s.stays ? sweep<3>(s, stride, amount, corner) : sweep<4>(s, stride, amount, corner);
  }
  settle_flux(grid, flux, smoothing);
}

}   // namespace bedload

#include "solver/coupling/void_fraction.hpp"

namespace bedload {
namespace {

void clear(Field<Centre>& f, double value) { std::fill(f.values.begin(), f.values.end(), value); }
void clear(FaceFields& f, double value) {
  for (int c = 0; c < 3; ++c) std::fill_n(f.component(c), f.x.values.size(), value);
}

/// Splines of one direction before and after a move, on the five cells around the first position.
struct MovedSpline {
  double before[5] = {}, change[5] = {};
  int first, last;   // cells in which either is not zero
  int cell;          // number of the middle one

  MovedSpline(double s, double moved, int n) noexcept {
    cell = std::clamp(static_cast<int>(std::floor(s)), 0, n - 1);
    const int shift = std::clamp(static_cast<int>(std::floor(s + moved)) - cell, -1, 1);
    const auto b = quadratic_spline(s - cell - 0.5);
    const auto a = quadratic_spline(s + moved - cell - shift - 0.5);
    for (int m = 0; m < 3; ++m) before[1 + m] = b[m], change[1 + m] -= b[m];
    for (int m = 0; m < 3; ++m) change[1 + shift + m] += a[m];
    first = 1 + std::min(shift, 0), last = 3 + std::max(shift, 0);
  }
};

template <int C>
void sweep(const StaggeredGrid& g, const MovedSpline (&spline)[3], double amount, double* flux) noexcept {
  constexpr int D = C == 0 ? 1 : 0, E = C == 2 ? 1 : 2;
  const MovedSpline &along = spline[C], &d = spline[D], &e = spline[E];
  std::int32_t d_at[5], e_at[5];
  for (int m = d.first; m <= d.last; ++m) d_at[m] = Stencil::place_cell(g, D, d.cell + m - 2) * static_cast<std::int32_t>(g.stride(D));
  for (int m = e.first; m <= e.last; ++m) e_at[m] = Stencil::place_cell(g, E, e.cell + m - 2) * static_cast<std::int32_t>(g.stride(E));
  double gone = 0;
  for (int m = along.first; m < along.last; ++m) {
    gone -= along.change[m];
    const int face = along.cell + m - 1;   // right of cell (along.cell + m - 2)
    if (!g.periodic(C) && (face <= 0 || face >= g.cells[C])) continue;
    const std::int32_t at = Stencil::place_face(g, C, face) * static_cast<std::int32_t>(g.stride(C));
    for (int p = d.first; p <= d.last; ++p)
      for (int q = e.first; q <= e.last; ++q) {
        const double across = d.before[p] * e.before[q] + 0.5 * (d.change[p] * e.before[q] + d.before[p] * e.change[q]) +
                              d.change[p] * e.change[q] / 3;
        flux[at + d_at[p] + e_at[q]] += amount * gone * across;
      }
  }
}

}  // namespace

void find_stencils(const StaggeredGrid& grid, const Grains& grains, std::vector<Stencil>& stencils) {
  stencils.resize(grains.size());
  for (std::size_t p = 0; p < grains.size(); ++p) stencils[p] = Stencil(grid, grains.position[p]);
}

void deposit_void_fraction(const StaggeredGrid& grid, const Grains& grains, std::span<const Stencil> stencils, VoidFraction& eps) {
  clear(eps.centre, 1);
  clear(eps.face, 1);
  const double per_cell = 1 / grid.cell_volume();
  for (std::size_t p = 0; p < grains.size(); ++p) {
    const double share = -sphere_volume(grains.diameter[p]) * per_cell;
    for_each_cell(stencils[p], [&](std::int32_t n, double w) { eps.centre[n] += w * share; });
    deposit(stencils[p], {share, share, share}, eps.face);
  }
}

void deposit_solid_flux(const StaggeredGrid& grid, const Grains& grains, std::span<const Stencil> stencils, FaceFields& flux) {
  clear(flux, 0);
  const double per_cell = 1 / grid.cell_volume();
  for (std::size_t p = 0; p < grains.size(); ++p)
    if (!grains.fixed[p]) deposit(stencils[p], sphere_volume(grains.diameter[p]) * per_cell * grains.velocity[p], flux);
}

void deposit_swept_flux(const StaggeredGrid& grid, const Grains& grains, std::span<const Vec3> before, std::span<const Vec3> moved,
                        double dt, FaceFields& flux) {
  clear(flux, 0);
  const double per_step = 1 / (grid.cell_volume() * dt);
  for (std::size_t p = 0; p < grains.size(); ++p) {
    if (grains.fixed[p]) continue;
    const MovedSpline spline[3] = {{before[p].x / grid.h.x, moved[p].x / grid.h.x, grid.cells[0]},
                                   {before[p].y / grid.h.y, moved[p].y / grid.h.y, grid.cells[1]},
                                   {before[p].z / grid.h.z, moved[p].z / grid.h.z, grid.cells[2]}};
    const double amount = sphere_volume(grains.diameter[p]) * per_step;
    sweep<0>(grid, spline, amount * grid.h.x, flux.component(0));
    sweep<1>(grid, spline, amount * grid.h.y, flux.component(1));
    sweep<2>(grid, spline, amount * grid.h.z, flux.component(2));
  }
}

}  // namespace bedload

#include "solver/coupling/void_fraction.hpp"

#include "solver/fluid/face_loops.hpp"

namespace bedload {
namespace {

/// The spline of one direction before a move and its change, on the four cells that a move of less than one cell can touch.
struct MovedSpline {
  double before[4] = {}, change[4] = {};
  int first;   // number of the first of the four cells
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
  }

  /// What passes the lower face of each of the four cells.
  void passed(double (&out)[4]) const noexcept {
    out[0] = 0;
    for (int m = 1; m < 4; ++m) out[m] = m < count ? out[m - 1] - change[m - 1] : 0;
  }
};

inline Row row(const double (&v)[4]) noexcept { return Row{v[0], v[1], v[2], v[3]}; }

/// Mean over the move of the product of two splines.
inline double mean_product(double a, double da, double b, double db) noexcept {
  return a * b + 0.5 * (da * b + a * db) + da * db / 3;
}

/// Flux through faces normal to x or y: `along` in that direction, `across` in the other, z in rows.
void sweep_horizontal(const MovedSpline& along, std::ptrdiff_t along_stride, const MovedSpline& across,
                      std::ptrdiff_t across_stride, const MovedSpline& z, double amount, double* corner) noexcept {
  double passed[4];
  along.passed(passed);
  const Row zb = row(z.before), zd = row(z.change);
  for (int p = 0; p < across.count; ++p) {
    const double b = across.before[p], d = across.change[p];
    const Row mean = amount * (b * zb + 0.5 * (d * zb + b * zd) + d * zd / 3);
    for (int m = 1; m < along.count; ++m) add_row(corner + m * along_stride + p * across_stride, passed[m] * mean);
  }
}

void sweep_vertical(const MovedSpline (&s)[3], Strides stride, double amount, double* corner) noexcept {
  double passed[4];
  s[2].passed(passed);
  const Row through = amount * row(passed);
  for (int a = 0; a < s[0].count; ++a)
    for (int b = 0; b < s[1].count; ++b)
      add_row(corner + a * stride.x + b * stride.y,
              mean_product(s[0].before[a], s[0].change[a], s[1].before[b], s[1].change[b]) * through);
}

}   // namespace

void find_stencils(const StaggeredGrid& grid, const Grains& grains, std::vector<Stencil>& stencils) {
  stencils.resize(grains.size());
  for (std::size_t p = 0; p < grains.size(); ++p) stencils[p] = Stencil(grid, grains.position[p]);
}

void deposit_void_fraction(const StaggeredGrid& grid, const Grains& grains, std::span<const Stencil> stencils,
                           VoidFraction& eps, const KernelSmoothing& smoothing) {
  clear(eps.centre), clear(eps.face);
  const double per_cell = 1 / grid.cell_volume();
  const Strides stride(grid);
  for (std::size_t p = 0; p < grains.size(); ++p) {
    const double share = -sphere_volume(grains.diameter[p]) * per_cell;
    deposit<on_cells>(stencils[p], stride, share, eps.centre.data());
    deposit(stencils[p], stride, {share, share, share}, eps.face);
  }
  if (grains.size() > 0) fold_deposits(grid, eps.centre), fold_deposits(grid, eps.face);
  smoothing.spread(eps.centre), smoothing.spread(eps.face);
  for (double& e : eps.centre.values) e += 1;
  for (int c = 0; c < 3; ++c)
    for (double *e = eps.face.component(c), *end = e + grid.padded_size(); e != end; ++e) *e += 1;
  eps.overfilled.clear();
  for (int c = 0; c < 3; ++c)
    for_each_unknown_face(grid, c, [&, e = eps.face.component(c)](std::size_t n) {
      if (e[n] >= least_face_void) return;
      eps.overfilled.push_back({c, n, (1 - least_face_void) / (1 - e[n])});
      e[n] = least_face_void;
    });
}

void deposit_solid_flux(const StaggeredGrid& grid, const Grains& grains, std::span<const Stencil> stencils,
                        FaceFields& flux, const KernelSmoothing& smoothing) {
  clear(flux);
  const double per_cell = 1 / grid.cell_volume();
  const Strides stride(grid);
  for (std::size_t p = 0; p < grains.size(); ++p)
    if (!grains.fixed[p])
      deposit(stencils[p], stride, sphere_volume(grains.diameter[p]) * per_cell * grains.velocity[p], flux);
  if (grains.size() > 0) fold_deposits(grid, flux);
  clear_walls(grid, flux);
  smoothing.spread_flux(flux);
}

void deposit_swept_flux(const StaggeredGrid& grid, const Grains& grains, std::span<const Vec3> before,
                        std::span<const Vec3> moved, double dt, FaceFields& flux, const KernelSmoothing& smoothing) {
  clear(flux);
  const double per_step = 1 / (grid.cell_volume() * dt);
  const Strides stride(grid);
  for (std::size_t p = 0; p < grains.size(); ++p) {
    if (grains.fixed[p]) continue;
    const MovedSpline s[3] = {{before[p].x / grid.h.x, moved[p].x / grid.h.x, grid.cells[0]},
                              {before[p].y / grid.h.y, moved[p].y / grid.h.y, grid.cells[1]},
                              {before[p].z / grid.h.z, moved[p].z / grid.h.z, grid.cells[2]}};
    const std::size_t corner = grid.index(s[0].first, s[1].first, s[2].first);
    const double amount = sphere_volume(grains.diameter[p]) * per_step;
    sweep_horizontal(s[0], stride.x, s[1], stride.y, s[2], amount * grid.h.x, flux.component(0) + corner);
    sweep_horizontal(s[1], stride.y, s[0], stride.x, s[2], amount * grid.h.y, flux.component(1) + corner);
    sweep_vertical(s, stride, amount * grid.h.z, flux.component(2) + corner);
  }
  if (grains.size() > 0) fold_deposits(grid, flux);
  clear_walls(grid, flux);
  smoothing.spread_flux(flux);
}

}   // namespace bedload

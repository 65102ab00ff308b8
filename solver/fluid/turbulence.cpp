// Strain, then viscosity, then the wall laws; and the stress that they make.
#include "solver/fluid/turbulence.hpp"

#include <algorithm>
#include <cmath>

#include "solver/fluid/boundaries.hpp"
#include "solver/fluid/face_loops.hpp"
#include "solver/fluid/wall_law.hpp"

namespace bedload {
namespace {

/// The two directions across an edge along t: its shear is du_a/dx_b + du_b/dx_a.
struct Across {
  int a, b;
};
constexpr Across across(int t) { return {(t + 1) % 3, (t + 2) % 3}; }

double mean_of_four(const double* f, std::ptrdiff_t a, std::ptrdiff_t b) noexcept {
  return 0.25 * ((f[0] + f[a]) + (f[b] + f[a + b]));
}

/// Root of the mean square of the speed, relative to `moving` along x, in a layer of cells across direction c.
double layer_speed(const StaggeredGrid& g, const FaceFields& u, int c, int layer, double moving) {
  double sum = 0;
  for (int m = 0; m < 3; ++m) {
    if (m == c) continue;
    const double shift = m == 0 ? moving : 0;
    const int a = c == 0 ? 1 : 0, b = c == 2 ? 1 : 2;
    for (int i = 0; i < g.cells[a]; ++i)
      for (int j = 0; j < g.cells[b]; ++j) {
        const std::size_t n = g.index(0, 0, 0) + i * g.stride(a) + j * g.stride(b) + layer * g.stride(c);
        const double slip = u.component(m)[n] - shift;
        sum += slip * slip;
      }
  }
  return std::sqrt(sum * g.cells[c] / double(g.cell_count()));
}

}   // namespace

Turbulence::Turbulence(const StaggeredGrid& g, double viscosity)
    : grid_(g),
      viscosity_(viscosity),
      filter_term_(filter_term(g)),
      centre_(g),
      edge_(g),
      rest_{Field<Centre>(g), Field<Centre>(g), Field<Centre>(g)} {}

void Turbulence::find(const FaceFields& velocity, double lid_speed, double surface_height, double sand_roughness) {
  find_surface_terms_of(velocity, lid_speed, surface_height, sand_roughness);
  find_strain(velocity);
  find_viscosity();
  for (int c = 0; c < 3; ++c) {
    if (grid_.periodic(c)) continue;
    apply_wall_law(velocity, c, false, 0, c == 2 ? surface_height : 0, c == 2 ? sand_roughness : 0);
    apply_wall_law(velocity, c, true, c == 2 ? lid_speed : 0, 0, 0);
  }
  fill_face_ghosts(grid_, edge_);
}

/// Walls and bed as the mixing length sees them, with the u* that the flow half a cell or more away from each means.
void Turbulence::find_surface_terms_of(const FaceFields& velocity, double lid_speed, double surface_height,
                                       double roughness) {
  for (int c = 0; c < 3; ++c) {
    std::vector<TurbulentSurface> surfaces;
    const int n = grid_.cells[c];
    const double h = grid_.h[c], length = n * h;
    const auto add = [&](double position, bool above, double k_s, int layer, double moving) {
      const double distance = std::abs((layer + 0.5) * h - position);
      const double stress = wall_stress(layer_speed(grid_, velocity, c, layer, moving), distance, viscosity_, k_s);
      surfaces.push_back({position, above, k_s, std::sqrt(stress)});
    };
    if (!grid_.periodic(c)) {
      const double low = c == 2 ? surface_height : 0;
      const int first = std::min(n - 1, static_cast<int>(std::ceil(low / h - 1e-9)));
      add(low, true, c == 2 ? roughness : 0, first, 0);
      if (!(c == 2 && grid_.top == Top::free_slip)) add(length, false, 0, n - 1, c == 2 ? lid_speed : 0);
    }
    find_surface_terms(n, h, viscosity_, surfaces, terms_[c]);
  }
}

/// edge_ = (du_a/dx_b + du_b/dx_a)^2, which is 4 S_ab^2; centre_ = |S|^2 = 2 S_ij S_ij, edges averaged to the centre.
void Turbulence::find_strain(const FaceFields& velocity) {
  const StaggeredGrid& g = grid_;
  for (int t = 0; t < 3; ++t) {
    const auto [a, b] = across(t);
    const std::ptrdiff_t sa = g.stride(a), sb = g.stride(b);
    const double per_a = 1 / g.h[a], per_b = 1 / g.h[b];
    for_each_edge_row(g, t, [&](std::size_t row, int length, int, int) {
      const double *ua = velocity.component(a) + row, *ub = velocity.component(b) + row;
      double* out = edge_.component(t) + row;
      for (int k = 0; k < length; ++k) {
        const double shear = (ua[k] - ua[k - sb]) * per_b + (ub[k] - ub[k - sa]) * per_a;
        out[k] = shear * shear;
      }
    });
  }
  fill_face_ghosts(g, edge_);
  for_each_cell_row(g, [&](std::size_t row, int length) {
    for (int k = 0; k < length; ++k) {
      const std::size_t n = row + k;
      double normal = 0, shear[3];
      for (int c = 0; c < 3; ++c) {
        const double* u = velocity.component(c) + n;
        const double slope = (u[g.stride(c)] - u[0]) / g.h[c];
        normal += 2 * slope * slope;
        shear[c] = mean_of_four(edge_.component(c) + n, g.stride(across(c).a), g.stride(across(c).b));
      }
      for (int c = 0; c < 3; ++c) rest_[c][n] = normal + (shear[across(c).a] + shear[across(c).b]);
      centre_[n] = rest_[0][n] + shear[0];
    }
  });
  for (Field<Centre>& rest : rest_) fill_centre_ghosts(g, rest);
}

/// nu_t = l^2 |S| at centres and edges; on an edge with the edge's own shear, so that a log law stays one.
void Turbulence::find_viscosity() {
  const StaggeredGrid& g = grid_;
  largest_ = 0;
  for (int i = 0; i < g.cells[0]; ++i)
    for (int j = 0; j < g.cells[1]; ++j)
      for (int k = 0; k < g.cells[2]; ++k) {
        double& nu = centre_[g.index(i, j, k)];
        nu = std::sqrt(nu) / (filter_term_ + (terms_[0].centres[i] + terms_[1].centres[j] + terms_[2].centres[k]));
        largest_ = std::max(largest_, nu);
      }
  fill_centre_ghosts(g, centre_);
  for (int t = 0; t < 3; ++t) {
    const auto [a, b] = across(t);
    const auto& x = t == 0 ? terms_[0].centres : terms_[0].faces;
    const auto& y = t == 1 ? terms_[1].centres : terms_[1].faces;
    const auto& z = t == 2 ? terms_[2].centres : terms_[2].faces;
    for_each_edge_row(g, t, [&](std::size_t row, int length, int i, int j) {
      const double* rest = rest_[t].data() + row;
      double* nu = edge_.component(t) + row;
      for (int k = 0; k < length; ++k) {
        const double square = nu[k] + mean_of_four(rest + k, -g.stride(a), -g.stride(b));
        nu[k] = std::sqrt(square) / (filter_term_ + (x[i] + y[j] + z[k]));
        largest_ = std::max(largest_, nu[k]);
      }
    });
  }
}

/// On a wall across `direction`: nu_t such that (nu + nu_t) times the slip over half a cell is the stress of the wall law.
void Turbulence::apply_wall_law(const FaceFields& velocity, int direction, bool high, double lid_speed,
                                double surface_height, double roughness) {
  const StaggeredGrid& g = grid_;
  const double half = 0.5 * g.h[direction], distance = half - surface_height;
  const bool wall = !(high && direction == 2 && g.top == Top::free_slip) && distance > 0;   // else a bed covers it
  for (const int c : {(direction + 1) % 3, (direction + 2) % 3}) {                          // component along the wall
    const int t = 3 - direction - c;                                                        // its edges run along t
    const double *u = velocity.component(c), *v = velocity.component(t);
    const double u_wall = c == 0 ? lid_speed : 0, v_wall = t == 0 ? lid_speed : 0;
    double* nu = edge_.component(t);
    const std::size_t edge = g.index(0, 0, 0) + (high ? g.cells[direction] * g.stride(direction) : 0);
    for (int m = 0; m < g.cells[c] + (g.periodic(c) ? 0 : 1); ++m)
      for (int n = 0; n < g.cells[t]; ++n) {
        const std::size_t at = edge + m * g.stride(c) + n * g.stride(t);
        const std::size_t face = high ? at - g.stride(direction) : at;
        const double slip = u[face] - u_wall, across_slip = mean_of_four(v + face, -g.stride(c), g.stride(t)) - v_wall;
        const double speed = std::hypot(slip, across_slip);
        nu[at] = 0;
        if (!wall || speed == 0) continue;
        const double stress = wall_stress(speed, distance, viscosity_, roughness);
        if (stress <= viscosity_ * speed / distance) continue;   // the sublayer is resolved
        nu[at] = std::max(0.0, stress * half / speed - viscosity_);
        largest_ = std::max(largest_, nu[at]);
      }
  }
}

void Turbulence::add_force(const FaceFields& velocity, double factor, FaceFields& out) const {
  const StaggeredGrid& g = grid_;
  for (int c = 0; c < 3; ++c) {
    const double* u = velocity.component(c);
    const std::ptrdiff_t sc = g.stride(c);
    for (int t = 0; t < 3; ++t) {   // the stress that passes along t
      const std::ptrdiff_t st = g.stride(t);
      const double *v = velocity.component(t), *nu = t == c ? centre_.data() : edge_.component(3 - c - t);
      const double per_t = 1 / g.h[t], per_c = 1 / g.h[c], scale = factor * per_t;
      const auto shear = [=](std::size_t n) {
        return nu[n] * ((u[n] - u[n - st]) * per_t + (v[n] - v[n - sc]) * per_c);
      };
      const auto normal = [=](std::size_t n) { return nu[n] * (2 * (u[n + sc] - u[n]) * per_c); };
      double* sum = out.component(c);
      if (t == c) for_each_unknown_face(g, c, [=](std::size_t n) { sum[n] += scale * (normal(n) - normal(n - sc)); });
      else for_each_unknown_face(g, c, [=](std::size_t n) { sum[n] += scale * (shear(n + st) - shear(n)); });
    }
  }
}

void Turbulence::add_diagonal(double factor, FaceFields& out) const {
  const StaggeredGrid& g = grid_;
  for (int c = 0; c < 3; ++c)
    for (int t = 0; t < 3; ++t) {
      const double *nu = t == c ? centre_.data() : edge_.component(3 - c - t), scale = factor / (g.h[t] * g.h[t]);
      const std::ptrdiff_t s = g.stride(t);
      double* sum = out.component(c);
      if (t == c) for_each_unknown_face(g, c, [=](std::size_t n) { sum[n] += scale * 2 * (nu[n] + nu[n - s]); });
      else for_each_unknown_face(g, c, [=](std::size_t n) { sum[n] += scale * (nu[n] + nu[n + s]); });
    }
}

WallShear Turbulence::wall_shear(const FaceFields& velocity) const {
  return bedload::wall_shear(grid_, velocity, edge_);
}

}   // namespace bedload

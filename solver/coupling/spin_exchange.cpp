#include "solver/coupling/spin_exchange.hpp"

#include "solver/fluid/boundaries.hpp"
#include "solver/fluid/face_loops.hpp"

namespace bedload {
namespace {

/// Writes weight(t, row)[k] curl u on the edges of the lowest `planes` planes along z.
template <class Weight>
void weigh_vorticity(const StaggeredGrid& g, const FaceFields& velocity, int planes, Weight&& weight,
                     FaceFields& on_edges) {
  for (int t = 0; t < 3; ++t) {
    const int a = (t + 1) % 3, b = (t + 2) % 3;
    const std::ptrdiff_t sa = g.stride(a), sb = g.stride(b);
    const double ka = 1 / g.h[a], kb = 1 / g.h[b];
    for_each_edge_row(g, t, [&](std::size_t row, int whole, int, int) {
      const int length = std::min(whole, planes);
      const auto w = weight(t, row);
      const double* __restrict ua = velocity.component(a) + row;
      const double* __restrict ub = velocity.component(b) + row;
      double* __restrict e = on_edges.component(t) + row;
      for (int k = 0; k < length; ++k) e[k] = w[k] * (ka * (ub[k] - ub[k - sa]) - kb * (ua[k] - ua[k - sb]));
    });
  }
}

/// Adds factor curl^T e: on faces normal to c, de_{c+2}/dx_{c+1} - de_{c+1}/dx_{c+2} of an edge field, up to the plane `reach`
/// along z from which on e is zero.
void add_curl_transposed(const StaggeredGrid& g, const FaceFields& e, int reach, double factor, FaceFields& out) {
  for (int c = 0; c < 3; ++c) {
    const int a = (c + 1) % 3, b = (c + 2) % 3;
    const std::ptrdiff_t sa = g.stride(a), sb = g.stride(b);
    const double ka = factor / g.h[a], kb = factor / g.h[b];
    const int below = reach - (c == 2 ? g.first_face(2) : 0);
    for_each_face_row(g, c, [&](std::size_t row, int whole) {
      const int length = std::min(whole, below);
      const double* __restrict ea = e.component(a) + row;
      const double* __restrict eb = e.component(b) + row;
      double* __restrict y = out.component(c) + row;
      for (int k = 0; k < length; ++k) y[k] += ka * (eb[k + sa] - eb[k]) - kb * (ea[k + sb] - ea[k]);
    });
  }
}

}   // namespace

void find_vorticity(const StaggeredGrid& g, const FaceFields& velocity, FaceFields& on_edges) {
  struct One {
    double operator[](int) const { return 1; }
  };
  weigh_vorticity(
      g, velocity, g.cells[2] + 1, [](int, std::size_t) { return One{}; }, on_edges);
}

SpinExchange::SpinExchange(const StaggeredGrid& g)
    : grid_(g), strength_(g), target_(g), turn_(g), woven_(g, On::edges), woven_too_(g, On::edges) {}

/// An edge on a no-slip wall turns with the wall's velocity held, and the ghost's is its mirror image: transposed, that counts
/// twice. On a free surface there is no vorticity to resist.
void SpinExchange::weigh_walls(FaceFields& f) const {
  for (int c = 0; c < 3; ++c) {
    if (grid_.periodic(c)) continue;
    for (int t = 0; t < 3; ++t) {
      if (t == c) continue;
      const int other = 3 - c - t;
      for (int m = 0; m < grid_.cells[t]; ++m)
        for (int n = 0; n <= grid_.cells[other]; ++n) {
          double* const low = f.component(t) + grid_.index(0, 0, 0) + m * grid_.stride(t) + n * grid_.stride(other);
          low[0] *= 2;
          low[grid_.cells[c] * grid_.stride(c)] *= c == 2 && grid_.top == Top::free_slip ? 0 : 2;
        }
    }
  }
}

void SpinExchange::prepare(const Stencils& stencils, std::span<const Vec3> strength, std::span<const Vec3> target,
                           const KernelSmoothing& smoothing) {
  woven_.clear(stencils.reach), woven_too_.clear(stencils.reach);
  const Strides stride(grid_);
  for (std::size_t p = 0; p < stencils.size(); ++p) {
    const Vec3 c = strength[p] / grid_.cell_volume();
    const Weights<On::edges> weights(stencils[p]);
    deposit(weights, stride, quad(c), woven_.at(stencils[p]));
    deposit(weights, stride, quad(scaled(c, target[p])), woven_too_.at(stencils[p]));
  }
  woven_.settle(strength_), woven_too_.settle(target_);
  for (Deposited* f : {&strength_, &target_}) {
    smoothing.spread_on_edges(*f);
    weigh_walls(*f);
    fill_face_ghosts(grid_, *f, GhostLayers::inner);
  }
  reach_ = planes_reached();
}

/// Planes of edges along z from the bottom up to the last that any grain reaches: most of a channel is clear of them.
int SpinExchange::planes_reached() const {
  int reach = 0;
  for (int t = 0; t < 3; ++t)
    for_each_edge_row(grid_, t, [&](std::size_t row, int length, int, int) {
      const double* c = strength_.component(t) + row;
      while (length > reach && c[length - 1] == 0) --length;
      reach = std::max(reach, length);
    });
  return reach;
}

void SpinExchange::add_impulse(const FaceFields& vorticity, FaceFields& impulse) {
  for (int t = 0; t < 3; ++t)
    for_each_edge_row(grid_, t, [&](std::size_t row, int length, int, int) {
      const double* __restrict c = strength_.component(t) + row;
      const double* __restrict s = target_.component(t) + row;
      const double* __restrict w = vorticity.component(t) + row;
      double* __restrict couple = turn_.component(t) + row;
      for (int k = 0; k < length; ++k) couple[k] = 0.5 * c[k] * w[k] - s[k];
    });
  add_curl_transposed(grid_, turn_, grid_.cells[2], -0.5, impulse);
}

// Faces of the last plane reached read the edges of the next one, too.
void SpinExchange::add_image(const FaceFields& x, FaceFields& out) {
  weigh_vorticity(
      grid_, x, reach_ + 1, [&](int t, std::size_t row) { return strength_.component(t) + row; }, turn_);
  add_curl_transposed(grid_, turn_, reach_, 0.25, out);
}

void SpinExchange::add_diagonal(FaceFields& out) const {
  for (int c = 0; c < 3; ++c) {
    const int a = (c + 1) % 3, b = (c + 2) % 3;
    const std::ptrdiff_t sa = grid_.stride(a), sb = grid_.stride(b);
    const double ka = 0.25 / (grid_.h[a] * grid_.h[a]), kb = 0.25 / (grid_.h[b] * grid_.h[b]);
    const double *ea = strength_.component(a), *eb = strength_.component(b);
    for_each_unknown_face(grid_, c, [&, y = out.component(c)](std::size_t n) {
      y[n] += ka * (eb[n + sa] + eb[n]) + kb * (ea[n + sb] + ea[n]);
    });
  }
}

SpinExchange::WallImpulse SpinExchange::on_walls(const FaceFields& vorticity) const {
  WallImpulse sum;
  if (grid_.periodic(2)) return sum;
  for (int c = 0; c < 2; ++c) {
    const int t = 1 - c;   // along whose edges the walls bear forces along c
    const double* strength = strength_.component(t);
    const double *target = target_.component(t), *turn = vorticity.component(t);
    const auto couple = [=](std::size_t n) { return 0.5 * strength[n] * turn[n] - target[n]; };
    const double scale = (c == 0 ? 0.5 : -0.5) * grid_.cell_volume() / grid_.h.z;
    for (int i = c == 0 ? grid_.first_face(0) : 0; i < grid_.cells[0]; ++i)
      for (int j = c == 1 ? grid_.first_face(1) : 0; j < grid_.cells[1]; ++j) {
        sum.bottom[c] += scale * couple(grid_.index(i, j, 0));
        sum.top[c] -= scale * couple(grid_.index(i, j, grid_.cells[2]));
      }
  }
  return sum;
}

}   // namespace bedload

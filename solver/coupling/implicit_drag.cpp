#include "solver/coupling/implicit_drag.hpp"

#include <array>
#include <limits>

#include "solver/fluid/boundaries.hpp"
#include "solver/fluid/face_loops.hpp"
#include "solver/fluid/operators.hpp"

namespace bedload {
namespace {

/// Sums over the unknown faces of a box: one partial sum per x-plane, added in plane order. along(c) is
/// what adds to each of several sums at padded index n of a face normal to c; side by side, no sum waits for another.
template <std::size_t count, class Along>
std::array<double, count> sums_within(const StaggeredGrid& g, const Reach& box, Along&& along) {
  std::array<double, count> totals{};
  for (int c = 0; c < 3; ++c) {
    const auto add = along(c);
    for (Reach plane = box; plane.first[0] < box.last[0]; ++plane.first[0]) {
      plane.last[0] = plane.first[0] + 1;
      std::array<double, count> sums{};
      for_each_face_within(g, c, plane, [&](std::size_t n) { add(n, sums); });
      for (std::size_t s = 0; s < count; ++s) totals[s] += sums[s];
    }
  }
  return totals;
}

}   // namespace

ImplicitDrag::ImplicitDrag(const StaggeredGrid& g)
    : exchange_(g),
      residual_(g),
      image_(g),
      direction_(g),
      change_(g),
      diagonal_(g),
      laplacian_(g),
      woven_(g),
      woven_too_(g) {}

/// Fills B, the diagonal and the first residual (that of u* = u^n); returns the stiffness b_max.
double ImplicitDrag::start(const StaggeredGrid& g, const DragProblem& problem, const FaceFields& void_fraction,
                           const FaceFields& impulse, const FaceFields& velocity) {
  const Stencils& stencils = problem.stencils;
  const Strides stride(g);
  woven_.clear(stencils.reach), woven_too_.clear(stencils.reach);
  read_.resize(stencils.size()), share_.resize(stencils.size());
  for (std::size_t p = 0; p < stencils.size(); ++p) {
    const Vec3 k = problem.exchange[p], a = problem.relaxation[p];
    const Vec3 held{k.x / (1 + a.x), k.y / (1 + a.y), k.z / (1 + a.z)};
    share_[p] = scaled(held, a);
    const Weights weights(stencils[p]);
    deposit(weights, stride, quad(k), woven_.at(stencils[p]));
    deposit(weights, stride, quad(scaled(share_[p], problem.flow_velocity[p]) + scaled(held, problem.ballistic[p])),
            woven_too_.at(stencils[p]));
  }
  woven_.settle(exchange_), woven_too_.settle(residual_);
  problem.smoothing.spread(exchange_), problem.smoothing.spread(residual_);
  change_.clear(g), direction_.clear(g);
  // A couple reads and moves the faces round its edges, which lie one plane farther.
  coupled_ = problem.implicit_viscosity > 0 ? whole(g)
             : problem.spin                 ? home_of(g, widened(g, exchange_.reach, 1))
                                            : exchange_.reach;
  residual_.reach = change_.reach = direction_.reach = coupled_;
  const Vec3 h = g.h;
  const double viscous = problem.implicit_viscosity * 2 * (1 / (h.x * h.x) + 1 / (h.y * h.y) + 1 / (h.z * h.z));
  double b_max = 0;
  for (int c = 0; c < 3; ++c) {
    double *d = diagonal_.component(c), *r = residual_.component(c);
    const double *b = exchange_.component(c), *eps = void_fraction.component(c), *t = impulse.component(c),
                 *u = velocity.component(c);
    for_each_face_within(g, c, coupled_, [&](std::size_t n) {
      d[n] = eps[n] + b[n] + viscous;
      r[n] += t[n] - b[n] * u[n];
      b_max = std::max(b_max, (b[n] + viscous) / eps[n]);   // what is left of r is stiff in either
    });
  }
  if (!problem.turbulence && !problem.spin) return b_max;
  if (problem.turbulence) problem.turbulence->add_diagonal(problem.step, diagonal_);
  if (problem.spin) problem.spin->add_diagonal(diagonal_);
  for (int c = 0; c < 3; ++c) {
    const double *d = diagonal_.component(c), *eps = void_fraction.component(c);
    for_each_face_within(g, c, coupled_, [&](std::size_t n) { b_max = std::max(b_max, d[n] / eps[n] - 1); });
  }
  return b_max;
}

/// Where nothing couples the faces, u* = u^n + T b_f/eps. Returns the square of what their residual was before.
double ImplicitDrag::move_free_fluid(const StaggeredGrid& g, const FaceFields& void_fraction, const FaceFields& impulse,
                                     FaceFields& velocity) {
  double total = 0;
  for (int c = 0; c < 3; ++c) {
    double* const u = velocity.component(c);
    const double *t = impulse.component(c), *eps = void_fraction.component(c);
    const auto within = [&](int direction, int m) {
      return m >= coupled_.first[direction] && m < coupled_.last[direction];
    };
    for (int i = c == 0 ? g.first_face(0) : 0; i < g.cells[0]; ++i) {
      LaneSum plane;
      for (int j = c == 1 ? g.first_face(1) : 0; j < g.cells[1]; ++j) {
        const auto move = [&](int first, int last) {
          const std::size_t row = g.index(i, j, first);
          plane.add_row(std::max(last - first, 0), [&](int k) {
            const std::size_t n = row + k;
            u[n] += t[n] / eps[n];
            return t[n] * t[n];
          });
        };
        const int lowest = c == 2 ? g.first_face(2) : 0;
        if (!within(0, i) || !within(1, j)) move(lowest, g.cells[2]);
        else move(lowest, coupled_.first[2]), move(std::max(lowest, coupled_.last[2]), g.cells[2]);
      }
      total += plane.value();
    }
  }
  return total;
}

/// image = A direction. Returns direction . image.
double ImplicitDrag::apply(const StaggeredGrid& g, const DragProblem& problem, const FaceFields& void_fraction) {
  const Stencils& stencils = problem.stencils;
  const Strides stride(g);
  if (!stencils.empty()) woven_.read(stencils.reach, problem.smoothing.seen<FaceFields>(direction_, seen_));
  woven_too_.clear(stencils.reach);
  for (std::size_t p = 0; p < stencils.size(); ++p) {
    const Weights weights(stencils[p]);
    read_[p] = on_faces(sample(weights, stride, woven_.at(stencils[p])));
    if (share_[p] != Vec3{}) deposit(weights, stride, quad(-scaled(share_[p], read_[p])), woven_too_.at(stencils[p]));
  }
  woven_too_.settle(image_);
  problem.smoothing.spread(image_);
  image_.reach = coupled_;
  if (problem.implicit_viscosity > 0 || problem.spin) fill_velocity_ghosts(g, direction_, 0, GhostLayers::inner);
  if (problem.spin) problem.spin->add_image(direction_, image_);
  if (problem.implicit_viscosity > 0) {
    laplacian(g, direction_, laplacian_);
    if (problem.turbulence) problem.turbulence->add_force(direction_, -problem.step, image_);
  }
  const auto finish = [&](int c) {
    return [y = image_.component(c), eps = void_fraction.component(c), b = exchange_.component(c),
            v = direction_.component(c), l = laplacian_.component(c),
            viscosity = problem.implicit_viscosity](std::size_t n, auto& sum) {
      y[n] += (eps[n] + b[n]) * v[n] - viscosity * l[n];
      sum[0] += v[n] * y[n];
    };
  };
  return sums_within<1>(g, coupled_, finish)[0];
}

int ImplicitDrag::solve(const StaggeredGrid& g, const DragProblem& problem, const FaceFields& void_fraction,
                        const FaceFields& impulse, FaceFields& velocity, std::span<Vec3> flow_velocity) {
  const double b_max = start(g, problem, void_fraction, impulse, velocity);
  std::copy(problem.flow_velocity.begin(), problem.flow_velocity.end(), flow_velocity.begin());
  auto [left, weighted] = sums_within<2>(g, coupled_, [&](int c) {
    return [r = residual_.component(c), d = diagonal_.component(c)](std::size_t n, auto& sums) {
      sums[0] += r[n] * r[n], sums[1] += r[n] * r[n] / d[n];
    };
  });
  const double first = left + move_free_fluid(g, void_fraction, impulse, velocity);
  const double goal = std::max(first * (0.01 / (1 + b_max)) * (0.01 / (1 + b_max)), std::numeric_limits<double>::min());
  double beta = 0;
  int iterations = 0;
  while (left > goal && iterations < ImplicitDrag::most_iterations) {
    for (int c = 0; c < 3; ++c)
      for_each_face_within(g, c, coupled_,
                           [=, v = direction_.component(c), r = residual_.component(c),
                            d = diagonal_.component(c)](std::size_t n) { v[n] = r[n] / d[n] + beta * v[n]; });
    const double step = weighted / apply(g, problem, void_fraction);
    const auto next = sums_within<2>(g, coupled_, [&](int c) {
      return [=, x = change_.component(c), r = residual_.component(c), v = direction_.component(c),
              y = image_.component(c), d = diagonal_.component(c)](std::size_t n, auto& sums) {
        x[n] += step * v[n];
        r[n] -= step * y[n];
        sums[0] += r[n] * r[n], sums[1] += r[n] * r[n] / d[n];
      };
    });
    for (std::size_t p = 0; p < read_.size(); ++p) flow_velocity[p] += step * read_[p];
    beta = next[1] / weighted, left = next[0], weighted = next[1];
    ++iterations;
  }
  for (int c = 0; c < 3; ++c)
    for_each_face_within(g, c, coupled_,
                         [u = velocity.component(c), x = change_.component(c), r = residual_.component(c),
                          eps = void_fraction.component(c)](std::size_t n) { u[n] += x[n] + r[n] / eps[n]; });
  if (problem.implicit_viscosity > 0 || problem.spin) fill_velocity_ghosts(g, change_, 0, GhostLayers::inner);
  return iterations;
}

}   // namespace bedload

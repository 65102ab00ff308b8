#include "solver/coupling/implicit_drag.hpp"

#include <limits>

#include "solver/fluid/boundaries.hpp"
#include "solver/fluid/face_loops.hpp"
#include "solver/fluid/operators.hpp"

namespace bedload {
namespace {

double inner(const StaggeredGrid& g, const FaceFields& a, const FaceFields& b) {
  double total = 0;
  for (int c = 0; c < 3; ++c)
    total += sum_over_faces(g, c, [x = a.component(c), y = b.component(c)](std::size_t n) { return x[n] * y[n]; });
  return total;
}

double inner_scaled(const StaggeredGrid& g, const FaceFields& a, const FaceFields& scale) {
  double total = 0;
  for (int c = 0; c < 3; ++c)
    total += sum_over_faces(g, c,
                            [x = a.component(c), d = scale.component(c)](std::size_t n) { return x[n] * x[n] / d[n]; });
  return total;
}

}   // namespace

ImplicitDrag::ImplicitDrag(const StaggeredGrid& g)
    : exchange_(g), diagonal_(g), residual_(g), direction_(g), image_(g), change_(g), laplacian_(g) {}

/// Fills B, the diagonal and the first residual (that of u* = u^n); returns the stiffness b_max.
double ImplicitDrag::start(const StaggeredGrid& g, const DragProblem& problem, const FaceFields& void_fraction,
                           const FaceFields& impulse, const FaceFields& velocity) {
  clear(exchange_), clear(residual_);
  const Strides stride(g);
  for (std::size_t p = 0; p < problem.stencils.size(); ++p) {
    const Vec3 k = problem.exchange[p], a = problem.relaxation[p];
    deposit(problem.stencils[p], stride, k, exchange_);
    const Vec3 followed = scaled(a, problem.flow_velocity[p]) + problem.ballistic[p];
    deposit(problem.stencils[p], stride,
            {k.x / (1 + a.x) * followed.x, k.y / (1 + a.y) * followed.y, k.z / (1 + a.z) * followed.z}, residual_);
  }
  if (!problem.stencils.empty()) fold_deposits(g, exchange_), fold_deposits(g, residual_);
  problem.smoothing.spread(exchange_), problem.smoothing.spread(residual_);
  const Vec3 h = g.h;
  const double viscous = problem.implicit_viscosity * 2 * (1 / (h.x * h.x) + 1 / (h.y * h.y) + 1 / (h.z * h.z));
  double b_max = 0;
  for (int c = 0; c < 3; ++c) {
    double *d = diagonal_.component(c), *r = residual_.component(c);
    const double *b = exchange_.component(c), *eps = void_fraction.component(c), *t = impulse.component(c),
                 *u = velocity.component(c);
    for_each_unknown_face(g, c, [&](std::size_t n) {
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
    for_each_unknown_face(g, c, [&](std::size_t n) { b_max = std::max(b_max, d[n] / eps[n] - 1); });
  }
  return b_max;
}

void ImplicitDrag::apply(const StaggeredGrid& g, const DragProblem& problem, const FaceFields& void_fraction,
                         FaceFields& x, FaceFields& out) {
  clear(out);
  const bool any_grain = !problem.stencils.empty();
  const FaceFields& seen = any_grain ? problem.smoothing.seen(g, x, seen_) : x;
  const Strides stride(g);
  for (std::size_t p = 0; p < problem.stencils.size(); ++p) {
    const Vec3 a = problem.relaxation[p], k = problem.exchange[p];
    if (a == Vec3{}) continue;
    const Stencil& s = problem.stencils[p];
    const Vec3 share{-k.x * a.x / (1 + a.x), -k.y * a.y / (1 + a.y), -k.z * a.z / (1 + a.z)};
    deposit(s, stride, scaled(share, sample(s, stride, seen)), out);
  }
  if (any_grain) fold_deposits(g, out), problem.smoothing.spread(out);
  if (problem.implicit_viscosity > 0 || problem.spin) fill_velocity_ghosts(g, x, 0);
  if (problem.spin) problem.spin->add_image(x, out);
  if (problem.implicit_viscosity > 0) {
    laplacian(g, x, laplacian_);
    if (problem.turbulence) problem.turbulence->add_force(x, -problem.step, out);
  }
  for (int c = 0; c < 3; ++c) {
    double* y = out.component(c);
    const double *eps = void_fraction.component(c), *b = exchange_.component(c), *v = x.component(c),
                 *l = laplacian_.component(c);
    for_each_unknown_face(g, c,
                          [&](std::size_t n) { y[n] += (eps[n] + b[n]) * v[n] - problem.implicit_viscosity * l[n]; });
  }
}

int ImplicitDrag::solve(const StaggeredGrid& g, const DragProblem& problem, const FaceFields& void_fraction,
                        const FaceFields& impulse, FaceFields& velocity, std::span<Vec3> flow_velocity) {
  const double b_max = start(g, problem, void_fraction, impulse, velocity);
  const auto each = [&](auto&& visit) {
    for (int c = 0; c < 3; ++c) for_each_unknown_face(g, c, [&](std::size_t n) { visit(c, n); });
  };
  clear(change_), clear(direction_), clear(laplacian_);
  const double first = inner(g, residual_, residual_);
  const double goal = std::max(first * (0.01 / (1 + b_max)) * (0.01 / (1 + b_max)), std::numeric_limits<double>::min());
  double weighted = inner_scaled(g, residual_, diagonal_), left = first, beta = 0;
  int iterations = 0;
  while (left > goal && iterations < ImplicitDrag::most_iterations) {
    each([&](int c, std::size_t n) {
      double& d = direction_.component(c)[n];
      d = residual_.component(c)[n] / diagonal_.component(c)[n] + beta * d;
    });
    apply(g, problem, void_fraction, direction_, image_);
    const double step = weighted / inner(g, direction_, image_);
    each([&](int c, std::size_t n) {
      change_.component(c)[n] += step * direction_.component(c)[n];
      residual_.component(c)[n] -= step * image_.component(c)[n];
    });
    const double next = inner_scaled(g, residual_, diagonal_);
    beta = next / weighted, weighted = next;
    left = inner(g, residual_, residual_);
    ++iterations;
  }
  each([&](int c, std::size_t n) { velocity.component(c)[n] += change_.component(c)[n]; });
  const FaceFields& seen = problem.stencils.empty() ? velocity : problem.smoothing.seen(g, velocity, seen_);
  for (std::size_t p = 0; p < problem.stencils.size(); ++p)
    flow_velocity[p] = sample(problem.stencils[p], Strides(g), seen);
  each([&](int c, std::size_t n) {
    velocity.component(c)[n] += residual_.component(c)[n] / void_fraction.component(c)[n];
  });
  if (problem.implicit_viscosity > 0 || problem.spin) fill_velocity_ghosts(g, change_, 0);
  return iterations;
}

}   // namespace bedload

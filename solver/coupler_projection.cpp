// Fluid and mobile grains give way to the pressure together.
#include "solver/coupler_parts.hpp"

#include "solver/fluid/boundaries.hpp"
#include "solver/fluid/face_loops.hpp"
#include "solver/fluid/operators.hpp"
#include "solver/fluid/rows.hpp"

namespace bedload {
namespace {

// Of the divergence that the projection starts with. Momentum does not depend on it, and the kick leaves more than this
// around grains that move; where none does, only the next limit counts, so that volume is kept whatever happens.
constexpr double pressure_tolerance = 1e-4;
constexpr double least_divergence = 1e-9;   // volume change per step that is not worth an iteration

bool all_finite(const State& state) {
  LaneSum nothing;   // no number, if one is not finite
  const auto add = [&](const std::vector<double>& all) {
    nothing.add_row(int(all.size()), [&](int n) { return 0 * all[n]; });
  };
  add(state.fluid.velocity.x.values), add(state.fluid.velocity.y.values), add(state.fluid.velocity.z.values);
  add(state.fluid.pressure.values);
  bool finite = nothing.value() == 0;
  const Grains& g = state.grains;
  for (const auto* each : {&g.velocity, &g.spin, &g.mean_contact_force, &g.mean_contact_torque})
    for (const Vec3& v : *each) finite &= std::isfinite(norm2(v));
  return finite;
}

}   // namespace

/// Makes div(eps u + J) vanish at the new instant: fluid and mobile grains give way to the pressure together.
void Coupler::Parts::project(State& state, double dt) {
  Stopwatch watch(times.pressure);
  if (failed()) return;
  for (int c = 0; c < 3; ++c) {
    double* f = flux.component(c);
    const double *eps = before.face.component(c), *u = state.fluid.velocity.component(c), *j = solid_flux.component(c);
    for_each_unknown_face(grid, c, [&](std::size_t n) { f[n] = (j[n] + eps[n] * u[n]) / dt; });
  }
  fill_face_ghosts(grid, flux);
  fill_face_ghosts(grid, response.coefficient);
  divergence(grid, flux, rhs);
  std::fill(correction.values.begin(), correction.values.end(), 0.0);
  const PressureSolve solve =
      pressure.solve(response.coefficient, rhs, correction, any_mobile(state.grains) ? pressure_tolerance : 0,
                     least_divergence / (dt * dt));
  health.pressure_iterations = solve.iterations;
  health.converged &= solve.converged;
  health.divergence = solve.residual;
  gradient(grid, correction, kick);
  hold_net_flux(state, dt);
  kick_mixture(state, dt);
  for (std::size_t n = 0; n < correction.values.size(); ++n) state.fluid.pressure[n] += correction[n];
  health.finite = all_finite(state);
  health.cfl_after = dt * courant_rate(state.fluid.velocity);
}

/// In a box without bottom or top, weight is borne by a uniform gradient: the one that lets just the volume pass that is
/// asked for, or none.
void Coupler::Parts::hold_net_flux(State& state, double dt) {
  if (!grid.periodic(2) || (scene.bed.gravity.z == 0 && scene.drive.kind != FlowRamp::Kind::through_flow)) return;
  double* const gradient_z = kick.component(2);
  const double *f = flux.component(2), *both = response.coefficient.component(2);
  const double asked = state.search.through_flow / dt;
  const double net = sum_over_faces(grid, 2, [=](std::size_t n) { return f[n] - both[n] * gradient_z[n] - asked; });
  const double uniform = net / sum_over_faces(grid, 2, [=](std::size_t n) { return both[n]; });
  for_each_unknown_face(grid, 2, [=](std::size_t n) { gradient_z[n] += uniform; });
  state.fluid.column_gradient -= uniform;
}

/// u_f -= T cf (grad dq)_f; v_p -= T sum w cp grad dq for every grain that is not fixed.
void Coupler::Parts::kick_mixture(State& state, double dt) {
  const double rho = scene.bed.fluid.density;
  Vec3 on_fixed;
  for (int c = 0; c < 3; ++c) {
    double *k = kick.component(c), *u = state.fluid.velocity.component(c);
    const double *cf = response.fluid.component(c), *cp = response.grains.component(c),
                 *locked = response.locked_exchange.component(c), *eps = before.face.component(c),
                 *phi = response.mobile_fraction.component(c);
    if (state.grains.size() > 0)
      on_fixed[c] = sum_over_faces(grid, c, [=, b = model_b()](std::size_t n) {
        return -k[n] * (locked[n] * cf[n] + (b ? 0 : 1 - eps[n] - phi[n]));
      });
    for_each_unknown_face(grid, c, [=](std::size_t n) {
      u[n] -= dt * cf[n] * k[n];
      k[n] *= cp[n];
    });
  }
  books.on_grains += rho * grid.cell_volume() * on_fixed;
  if (health.substeps == 0) return;
  woven.read(stencils.reach, smoothing.seen(kick, seen));
  const Strides stride(grid);
  for (std::size_t p = 0; p < state.grains.size(); ++p) {
    if (state.grains.fixed[p]) continue;
    const Vec3 change = -on_faces(sample(Weights(stencils[p]), stride, woven.at(stencils[p])));
    state.grains.velocity[p] += dt * change;
    books.on_grains += rho * specific_mass(state.grains, p) * change;
  }
}

}   // namespace bedload

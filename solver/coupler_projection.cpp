// Fluid and mobile grains give way to the pressure together.
#include "solver/coupler_parts.hpp"

#include "solver/fluid/boundaries.hpp"
#include "solver/fluid/courant.hpp"
#include "solver/fluid/face_loops.hpp"
#include "solver/fluid/operators.hpp"
#include "solver/fluid/rows.hpp"

namespace bedload {
namespace {

// Of the divergence that the projection starts with. Momentum does not depend on it, and the kick leaves more than this
// around grains that move; where none does, only the next limit counts, so that volume is kept whatever happens.
constexpr double pressure_tolerance = 1e-4;
constexpr double least_divergence = 1e-9;   // volume change per step that is not worth an iteration

bool all_finite(const Grains& g) {
  bool finite = true;
  for (const auto* each : {&g.velocity, &g.spin, &g.mean_contact_force, &g.mean_contact_torque})
    for (const Vec3& v : *each) finite &= std::isfinite(norm2(v));
  return finite;
}

/// Is told a row of numbers at a time; sums what is no number if one of them is not finite.
class Finite {
 public:
  void add_row(const double* values, int length) noexcept {
    nothing_.add_row(length, [=](int k) { return 0 * values[k]; });
  }
  explicit operator bool() const noexcept { return nothing_.value() == 0; }

 private:
  LaneSum nothing_;
};

}   // namespace

/// div(eps u + J)/T of the new instant. Its flux per T is kept where there are grains; without them it is u/T.
void Coupler::Parts::find_divergence_to_undo(State& state, double dt) {
  const double per_dt = 1 / dt;
  if (fluid_alone()) {
    close_faces(grid, state.fluid.velocity);
    return divergence(grid, state.fluid.velocity, rhs, per_dt);
  }
  for (int c = 0; c < 3; ++c) {
    double* const whole = flux.component(c);
    const double *eps = before.face.component(c), *u = state.fluid.velocity.component(c);
    for_each_face_row(grid, c, [=](std::size_t row, int length) {
      double* __restrict f = whole + row;
      for (int k = 0; k < length; ++k) f[k] = eps[row + k] * u[row + k] * per_dt;
    });
    for_each_face_within(grid, c, solid_flux.reach,
                         [=, j = solid_flux.component(c)](std::size_t n) { whole[n] += j[n] * per_dt; });
  }
  close_faces(grid, flux);
  divergence(grid, flux, rhs);
}

/// Makes div(eps u + J) vanish at the new instant: fluid and mobile grains give way to the pressure together.
void Coupler::Parts::project(State& state, double dt) {
  Stopwatch watch(times.pressure);
  if (failed()) return;
  find_divergence_to_undo(state, dt);
  const double relative = any_mobile(state.grains) ? pressure_tolerance : 0, absolute = least_divergence / (dt * dt);
  const PressureSolve solve = responds_alone && fluid_alone()
                                  ? pressure.solve_again(rhs, correction, relative, absolute)
                                  : pressure.solve(response.coefficient, rhs, correction, relative, absolute);
  responds_alone = fluid_alone();
  health.pressure_iterations = solve.iterations;
  health.converged &= solve.converged;
  health.divergence = solve.residual;
  kick_mixture(state, dt, uniform_gradient(state, dt));
  health.finite &= all_finite(state.grains);
}

/// In a box without bottom or top, weight is borne by a uniform gradient: the one that lets just the volume pass that is
/// asked for, or none. What has to be added to the kick along z.
double Coupler::Parts::uniform_gradient(State& state, double dt) {
  if (!grid.periodic(2) || (scene.bed.gravity.z == 0 && scene.drive.kind != FlowRamp::Kind::through_flow)) return 0;
  const double *f = fluid_alone() ? state.fluid.velocity.component(2) : flux.component(2),
               *both = response.coefficient.component(2), *dq = correction.data();
  const double asked = state.search.through_flow / dt, per_h = 1 / grid.h.z, per_dt = fluid_alone() ? 1 / dt : 1;
  const double net = sum_over_faces(
      grid, 2, [=](std::size_t n) { return per_dt * f[n] - both[n] * ((dq[n] - dq[n - 1]) * per_h) - asked; });
  const double uniform = net / sum_over_faces(grid, 2, [=](std::size_t n) { return both[n]; });
  state.fluid.column_gradient -= uniform;
  return uniform;
}

/// q += dq; u_f -= T cf (grad dq)_f; v_p -= T sum w cp grad dq for every grain that is not fixed. `uniform` comes on top of the
/// gradient along z.
void Coupler::Parts::kick_mixture(State& state, double dt, double uniform) {
  const double rho = scene.bed.fluid.density;
  const bool grains = state.grains.size() > 0, mobile = health.substeps > 0;
  const double pressed = model_b() ? 0 : 1;   // solid that pressure acts on
  Vec3 on_fixed;
  Courant courant;
  Finite finite;
  std::vector<double> one_row(grid.cells[2]);   // of the kick; the whole of it only for grains that read it
  const auto kick_faces = [&](int i, int c) {
    const std::ptrdiff_t s = grid.stride(c);
    const double per_h = 1 / grid.h[c], added = c == 2 ? uniform : 0;
    for_each_face_row_of_plane(grid, c, i, [&](std::size_t row, int length) {
      double* __restrict k = mobile ? kick.component(c) + row : one_row.data();
      double* __restrict u = state.fluid.velocity.component(c) + row;
      const double *dq = &correction[row], *cf = response.fluid.component(c) + row;
      const auto slope = [=](int m) { return (dq[m] - dq[m - s]) * per_h + added; };
      if (!grains) {
        for (int m = 0; m < length; ++m) u[m] -= dt * slope(m);
      } else {
        for (int m = 0; m < length; ++m) k[m] = slope(m);
        for (int m = 0; m < length; ++m) u[m] -= dt * cf[m] * k[m];
      }
      courant.add_row(c, u, length);
      finite.add_row(u, length);
      if (!grains) return;
      LaneSum sum;
      const double *locked = response.locked_exchange.component(c) + row, *eps = before.face.component(c) + row,
                   *phi = response.mobile_fraction.component(c) + row;
      sum.add_row(length, [=](int m) { return -k[m] * (locked[m] * cf[m] + pressed * (1 - eps[m] - phi[m])); });
      on_fixed[c] += sum.value();
      if (!mobile) return;
      const double* cp = response.grains.component(c) + row;
      for (int m = 0; m < length; ++m) k[m] *= cp[m];
    });
  };
  for (int i = 0; i < grid.cells[0]; ++i) {   // all that reads a plane of dq
    for (int c = 0; c < 3; ++c) kick_faces(i, c);
    for_each_cell_row_of_plane(grid, i, [&](std::size_t row, int length) {
      double* __restrict q = &state.fluid.pressure[row];
      const double* __restrict dq = &correction[row];
      for (int k = 0; k < length; ++k) q[k] += dq[k];
      finite.add_row(q, length);
    });
  }
  health.cfl_after = dt * courant.rate(grid.h);
  health.finite = bool(finite);
  books.on_grains += rho * grid.cell_volume() * on_fixed;
  if (!mobile) return;
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

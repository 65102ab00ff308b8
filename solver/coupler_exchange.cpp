// What fluid and grains exchange over the step: drag, added mass, torque, explicit forces; one implicit solve.
#include "solver/coupler_parts.hpp"

#include <algorithm>
#include <numbers>

#include "solver/coupling/added_mass.hpp"
#include "solver/fluid/face_loops.hpp"
#include "solver/fluid/operators.hpp"

namespace bedload {
namespace {

constexpr double explicit_viscosity_limit = 1.0 / 12;

}   // namespace

Vec3 Coupler::Rung::weight(double density) const {
  return scene.terms.buoyancy ? (1 - scene.bed.fluid.density / density) * scene.bed.gravity : scene.bed.gravity;
}

/// Ballistic velocities, and what drag and added mass exchange over the step: added mass resists increments of velocity as
/// drag resists velocity, so that E = beta T + m_a stands where beta T stood.
void Coupler::Rung::predict_grains(const State& state, double dt) {
  const Grains& grains = state.grains;
  const double rho = scene.bed.fluid.density;
  const std::size_t count = grains.size();
  exchange.resize(count), relaxation.resize(count), ballistic.resize(count), flow_velocity.resize(count),
      push.resize(count), drag_force.resize(count);
  if (scene.terms.added_mass) find_added_mass(grains, flow.void_fraction, flow.packing, model_b(), added_volume);
  for (std::size_t p = 0; p < count; ++p) {
    Vec3 impulse_per_slip = flow.drag[p] * dt;
    if (scene.terms.added_mass) impulse_per_slip += added_volume[p] * Vec3{1, 1, 1};
    exchange[p] = impulse_per_slip / grid.cell_volume();
    relaxation[p] = ballistic[p] = push[p] = {};
    if (grains.fixed[p]) continue;
    const double mass = specific_mass(grains, p);
    relaxation[p] = impulse_per_slip / mass;
    push[p] = weight(grains.density[p]);
    push[p].x += state.search.push * norm(push[p]);
    if (!model_b()) push[p] += rho / grains.density[p] * flow.acceleration[p];
    if (explicit_forces()) push[p] += flow.force[p] / mass;
    ballistic[p] = grains.velocity[p] + dt * (push[p] + grains.mean_contact_force[p] / (rho * mass));
    if (scene.terms.added_mass) ballistic[p] -= added_volume[p] / mass * (flow.velocity[p] - grains.velocity[p]);
  }
}

/// Viscous torque c (curl u*/2 - omega') with the spin omega' at the end of the step, as if the contact torques of the last
/// step went on: c' (curl u*/2 - omega_t), c' = c/(1 + lambda T), lambda = c rho_f/I. Near a wall c (s curl u*/2 - r omega'),
/// so c' = c s/(1 + r lambda T) and (r/s) omega_t.
void Coupler::Rung::predict_spins(const State& state, double dt) {
  const Grains& grains = state.grains;
  const double rho = scene.bed.fluid.density, nu = scene.bed.fluid.viscosity;
  const std::size_t count = grains.size();
  spin_strength.resize(count), spin_target.resize(count), spin_start.resize(count), spin_push.assign(count, {}),
      torque.resize(count);
  for (std::size_t p = 0; p < count; ++p) {
    const double d = grains.diameter[p];
    const Vec3 spin = grains.fixed[p] ? Vec3{} : grains.spin[p];
    const double re = d * d * norm(0.5 * flow.vorticity[p] - spin) / nu;
    const double c = std::numbers::pi * nu * d * d * d * torque_factor(re);
    WallTorque wall;
    if (scene.terms.wall_forces) wall = wall_torque(grid, grains.position[p], d, flow.packing.loneness(p));
    spin_strength[p] = dt * c * wall.shear, spin_target[p] = spin_start[p] = {};
    if (grains.fixed[p]) continue;
    const double inertia = sphere_inertia(grains.density[p] * sphere_volume(d), d);
    spin_start[p] = spin + dt / inertia * grains.mean_contact_torque[p];
    for (int t = 0; t < 3; ++t) {
      spin_strength[p][t] /= 1 + dt * c * wall.spin[t] * rho / inertia;
      spin_target[p][t] = wall.spin[t] / wall.shear[t] * spin_start[p][t];
    }
  }
}

/// Whether viscous stress joins the drag solve.
bool Coupler::Parts::implicit_viscosity(double dt) const {
  const double shortest_edge = std::min({grid.h.x, grid.h.y, grid.h.z});
  const double largest = scene.bed.fluid.viscosity + (turbulence ? turbulence->largest() : 0);
  return largest * dt > explicit_viscosity_limit * shortest_edge * shortest_edge;
}

/// u* = u^n + T a: without grains and with explicit viscosity no face knows of another.
void Coupler::Parts::move_fluid_alone(State& state, double dt) {
  if (!turbulence)
    return accelerated(grid, state.fluid.pressure, carried, scene.bed.fluid.viscosity, drive(state), dt,
                       state.fluid.velocity);
  find_acceleration(state);
  for (int c = 0; c < 3; ++c)
    for_each_face_row(grid, c, [&](std::size_t row, int length) {
      double* __restrict u = state.fluid.velocity.component(c) + row;
      const double *old = carried.component(c) + row, *a = acceleration.component(c) + row;
      for (int k = 0; k < length; ++k) u[k] = old[k] + dt * a[k];
    });
}

/// What changes the fluid besides drag: T eps a, and the reaction of explicit forces and of added mass.
void Coupler::Parts::find_impulse(const State& state, double dt) {
  for (int c = 0; c < 3; ++c) {
    double* b = impulse.component(c);
    const double *a = acceleration.component(c), *eps = before.face.component(c);
    for_each_unknown_face(grid, c, [&](std::size_t n) { b[n] = dt * a[n] * (model_b() ? 1 : eps[n]); });
  }
  if (scene.terms.added_mass || explicit_forces()) react_on_fluid(state, dt);
  if (spin_exchange) spin_exchange->add_impulse(vorticity, impulse);
}

/// - sum w T f/V_c of explicit forces; A u^n - sum w (m_a/V_c) v, which leaves to the drag solve the increments of u and v
/// that added mass answers to. A = sum w m_a/V_c is lumped as the drag is: at rest relative to each other, fluid and
/// grains must not smooth the flow.
void Coupler::Parts::react_on_fluid(const State& state, double dt) {
  const Strides stride(grid);
  const double per_cell = 1 / grid.cell_volume();
  const bool added_mass = scene.terms.added_mass;
  woven.clear(stencils.reach), woven_too.clear(stencils.reach);
  for (std::size_t p = 0; p < state.grains.size(); ++p) {
    const Weights weights(stencils[p]);
    Vec3 given;
    if (explicit_forces()) given += dt * flow.force[p];
    if (added_mass) {
      deposit(weights, stride, quad(added_volume[p] * per_cell), woven_too.at(stencils[p]));
      if (!state.grains.fixed[p]) given += added_volume[p] * state.grains.velocity[p];
    }
    deposit(weights, stride, quad(-per_cell * given), woven.at(stencils[p]));
  }
  woven.settle(reaction), smoothing.spread(reaction);
  if (added_mass) woven_too.settle(added_exchange), smoothing.spread(added_exchange);
  for (int c = 0; c < 3; ++c) {
    double* b = impulse.component(c);
    const double *r = reaction.component(c), *added = added_exchange.component(c),
                 *u = state.fluid.velocity.component(c);
    for_each_face_within(grid, c, reaction.reach, [&](std::size_t n) { b[n] += r[n] + added[n] * u[n]; });
  }
}

/// Of a grain's added mass, what a contact force moves with it: the liquid at its faces goes along by the part A/(eps + A),
/// A = sum w m_a/V_c as in the drag solve, and does not where a wall holds it; of the direction in which most does. With the
/// whole of m_a, in a bed several times the liquid there is, liquid would overtake the grains that push it.
void Coupler::Parts::find_carried_mass(const Grains& grains) {
  Deposited& along = added_exchange;
  for (int c = 0; c < 3; ++c)
    for_each_face_within(grid, c, along.reach, [a = along.component(c), eps = before.face.component(c)](std::size_t n) {
      a[n] /= eps[n] + a[n];
    });
  clear_walls(grid, along);
  woven.read(stencils.reach, smoothing.seen<FaceFields>(along, seen));
  const Strides stride(grid);
  carried_mass.resize(grains.size());
  for (std::size_t p = 0; p < grains.size(); ++p) {
    const Vec3 part = on_faces(sample(Weights(stencils[p]), stride, woven.at(stencils[p])));
    carried_mass[p] = scene.bed.fluid.density * added_volume[p] * (1 - std::max({part.x, part.y, part.z}));
  }
}

/// The one implicit solve of the step for all that fluid and grains exchange; leaves the grains' constant push.
void Coupler::Parts::solve_drag(State& state, double dt) {
  Stopwatch watch(times.drag);
  const bool implicit = implicit_viscosity(dt);
  predict_grains(state, dt);
  if (spin_exchange) predict_spins(state, dt), spin_exchange->prepare(stencils, spin_strength, spin_target, smoothing);
  if (fluid_alone() && !implicit) {
    move_fluid_alone(state, dt);
    return book_drive_of_fluid(state);
  }
  if (fluid_alone()) {
    find_acceleration(state);
    state.fluid.velocity = carried;
  }
  find_impulse(state, dt);
  if (scene.terms.added_mass) find_carried_mass(state.grains);
  DragProblem problem{.stencils = stencils,
                      .exchange = exchange,
                      .relaxation = relaxation,
                      .ballistic = ballistic,
                      .flow_velocity = flow.velocity,
                      .smoothing = smoothing};
  if (implicit)
    problem.implicit_viscosity = scene.bed.fluid.viscosity * dt,
    problem.turbulence = turbulence ? &*turbulence : nullptr;
  problem.step = dt;
  problem.spin = spin_exchange ? &*spin_exchange : nullptr;
  health.drag_iterations = drag.solve(grid, problem, before.face, impulse, state.fluid.velocity, flow_velocity);
  health.converged = health.drag_iterations < ImplicitDrag::most_iterations;
  book_exchange(state, dt);
  if (spin_exchange) book_torques(state.grains, dt);
  if (implicit) book_wall_shear(drag.change());
  book_drive_of_fluid(state);
}

}   // namespace bedload

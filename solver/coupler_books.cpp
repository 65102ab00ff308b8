// Forces that the solve has found, into the push of the grains and the books of momentum and energy.
#include "solver/coupler_parts.hpp"

#include "solver/fluid/face_loops.hpp"

namespace bedload {

/// The lid's work on the fluid and G's, whose force moves with the mean of u^n and u*.
void Coupler::Parts::book_drive_of_fluid(const State& state) {
  books.by_lid = -books.on_lid.x * state.search.lid_speed;
  const Vec3 g = drive(state);
  for (int c = 0; c < 3; ++c) {
    if (g[c] == 0) continue;
    const double *eps = before.face.component(c), *u = state.fluid.velocity.component(c), *old = carried.component(c);
    books.by_gradient += scene.bed.fluid.density * grid.cell_volume() * g[c] *
                         sum_over_faces(grid, c, [=, whole = model_b()](std::size_t n) {
                           return (whole ? 1 : eps[n]) * 0.5 * (u[n] + old[n]);
                         });
  }
}

/// Weight's, the push's and G's work on the grains over the way they went.
void Coupler::Rung::book_drive_of_grains(const State& state, double dt) {
  const Grains& grains = state.grains;
  const Vec3 g = drive(state);
  for (std::size_t p = 0; p < grains.size(); ++p) {
    if (grains.fixed[p]) continue;
    const double volume = sphere_volume(grains.diameter[p]);
    Vec3 force = grains.density[p] * weight(grains.density[p]);
    force.x += state.search.push * norm(force);
    books.by_weight += volume / dt * dot(force, moved[p]);
    if (!model_b()) books.by_gradient += scene.bed.fluid.density * volume / dt * dot(g, moved[p]);
  }
}

/// The forces that the solve has found, into the grains' push and the books.
void Coupler::Rung::book_exchange(const State& state, double dt) {
  const Grains& grains = state.grains;
  const double rho = scene.bed.fluid.density;
  Vec3 on_grains;
  for (std::size_t p = 0; p < grains.size(); ++p) {
    const Vec3 a = relaxation[p], difference = flow_velocity[p] - ballistic[p];
    const Vec3 slip{difference.x / (1 + a.x), difference.y / (1 + a.y), difference.z / (1 + a.z)};   // u* - v'
    Vec3 force = scaled(flow.drag[p], slip);                                                         // per rho_f
    drag_force[p] = rho * force;
    books.exchange_loss += rho * dot(force, slip);
    const double mass = specific_mass(grains, p);
    if (scene.terms.added_mass) {
      const Vec3 velocity = grains.fixed[p] ? Vec3{} : grains.velocity[p];
      force += added_volume[p] / dt * (slip - (flow.velocity[p] - velocity));
    }
    on_grains += force;
    if (!model_b()) on_grains += sphere_volume(grains.diameter[p]) * flow.acceleration[p];
    if (explicit_forces()) on_grains += flow.force[p];
    if (grains.fixed[p]) continue;
    push[p] += force / mass;
    // In the sub-steps contacts meet the grain with its liquid; the solve has already met the mean of the last step's.
    if (scene.terms.added_mass)
      push[p] += (1 / (rho * mass) - 1 / (rho * mass + carried_mass[p])) * grains.mean_contact_force[p];
  }
  books.on_grains = rho * on_grains;
}

/// The torque on a grain where the fluid turns at `turn` [1/s], into its spin and the books.
void Coupler::Rung::book_torque(const Grains& grains, std::size_t p, Vec3 turn, double dt) {
  torque[p] = scaled(scene.bed.fluid.density * spin_strength[p] / dt, turn - spin_target[p]);
  Vec3 slip = turn - spin_start[p];
  if (!grains.fixed[p]) {
    const double d = grains.diameter[p];
    spin_push[p] = torque[p] / sphere_inertia(grains.density[p] * sphere_volume(d), d);
    slip -= dt * spin_push[p];
  }
  books.exchange_loss += dot(torque[p], slip);
}

/// The torques that the solve has found, into the grains' spin and what the couples leave on walls into the books.
void Coupler::Parts::book_torques(const Grains& grains, double dt) {
  const double rho = scene.bed.fluid.density;
  find_vorticity(grid, drag.change(), vorticity_change);
  for (int t = 0; t < 3; ++t) {
    double* w = vorticity.component(t);
    for (std::size_t n = 0; n < vorticity.x.values.size(); ++n) w[n] += vorticity_change.component(t)[n];
  }
  woven_edges.read(stencils.reach, smoothing.edges_seen(vorticity, seen));
  for (std::size_t p = 0; p < grains.size(); ++p) book_torque(grains, p, 0.5 * turning_at(p), dt);
  const auto walls = spin_exchange->on_walls(vorticity);
  books.on_bottom += rho / dt * walls.bottom, books.on_lid += rho / dt * walls.top;
}

}   // namespace bedload

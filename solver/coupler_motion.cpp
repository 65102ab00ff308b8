// Grains move; void fraction, volume flux and momentum follow them.
#include "solver/coupler_parts.hpp"

#include "solver/fluid/boundaries.hpp"
#include "solver/fluid/face_loops.hpp"
#include "solver/grains/box_walls.hpp"

namespace bedload {

/// Sub-steps of {contacts, motion} under the constant push; drag does not change within them.
void Coupler::Rung::move_grains(State& state, double dt) {
  Stopwatch watch(times.contacts);
  Grains& grains = state.grains;
  moved.assign(grains.size(), {});
  if (health.substeps == 0) return;
  if (scene.terms.added_mass) contact_before = grains.mean_contact_force;
  const GrainHealth contact =
      dynamics.advance(grains, state.contacts, {.push = push, .spin_push = spin_push, .added_mass = carried_mass},
                       dt / health.substeps, health.substeps, state.search.lid_speed);
  health.deepest_overlap = contact.deepest_overlap;
  books.contact_on_walls = contact.force_on_walls;
  const PeriodicBox box(scene.bed);
  for (std::size_t p = 0; p < grains.size(); ++p) {
    Vec3& x = grains.position[p];
    moved[p] = x - positions[p];
    x = box.wrapped(x);
    for (int c = 0; c < 3; ++c) {
      if (!std::isfinite(x[c])) health.finite = false;
      health.grain_travel = std::max(health.grain_travel, std::abs(moved[p][c]) / reach[c]);
      if (x[c] < 0 || x[c] > box.length[c]) health.lost_grain = true;
    }
  }
  book_drive_of_grains(state, dt);
  health.lost_grain |= health.grain_travel >= 1;   // more than the charge-conserving deposit can carry
}

/// Of a contact force that the drag solve did not know of, what moves the grain's liquid [N].
Vec3 Coupler::Rung::force_on_liquid(const Grains& grains, std::size_t p) const {
  const double part = carried_mass[p] / (scene.bed.fluid.density * specific_mass(grains, p) + carried_mass[p]);
  return part * (grains.mean_contact_force[p] - contact_before[p]);
}

/// The flux that transport needs, then everything that belongs to x^{n+1}.
void Coupler::Parts::deposit_at_new_positions(const State& state, double dt) {
  Stopwatch watch(times.deposit);
  if (failed()) return;
  const Grains& grains = state.grains;
  if (fluid_alone()) {
    if (!response.mobile_fraction.reach.empty())   // of grains that are no longer there
      find_mixture_response(grid, grains, stencils, exchange, scene.bed.fluid.density, before, model_b(), response,
                            smoothing);
    return;
  }
  const Reach former = stencils.reach;
  find_stencils(grid, grains, stencils);
  deposit_swept_flux(grid, grains, positions, moved, united(former, stencils.reach), dt, solid_flux, smoothing);
  for (int c = 0; c < 3; ++c)
    for_each_face_within(grid, c, solid_flux.reach,
                         [f = flux.component(c), j = solid_flux.component(c)](std::size_t n) { f[n] -= j[n]; });
  fill_face_ghosts(grid, flux);

  deposit_void_fraction(grid, grains, stencils, after, smoothing);
  fill_face_ghosts(grid, after.face);
  deposit_solid_flux(grid, grains, stencils, solid_flux, smoothing);
  find_mixture_response(grid, grains, stencils, exchange, scene.bed.fluid.density, after, model_b(), response,
                        smoothing);
}

void Coupler::Parts::transport_momentum(State& state, double dt) {
  Stopwatch watch(times.transport);
  if (failed()) return;
  if (fluid_alone()) return transport(grid, carried, dt, carried, state.fluid.velocity, transport_scratch);
  transport(grid, flux, before.face, after.face, dt, carried, state.fluid.velocity, transport_scratch);
  std::swap(before, after);
  positions = state.grains.position;
}

/// Contact forces that the drag solve did not know of have moved grains with their liquid: the liquid's part of the impulse
/// is the fluid's.
void Coupler::Parts::carry_liquid(State& state, double dt) {
  if (!scene.terms.added_mass || health.substeps == 0 || failed()) return;
  Stopwatch watch(times.drag);
  const Grains& grains = state.grains;
  const Strides stride(grid);
  const double rho = scene.bed.fluid.density;
  woven.clear(stencils.reach);
  for (std::size_t p = 0; p < grains.size(); ++p) {
    if (grains.fixed[p]) continue;
    const Vec3 on_liquid = force_on_liquid(grains, p);
    deposit(Weights(stencils[p]), stride, quad(dt / (rho * grid.cell_volume()) * on_liquid), woven.at(stencils[p]));
    books.on_grains -= on_liquid;
  }
  woven.settle(reaction), smoothing.spread(reaction);
  for (int c = 0; c < 3; ++c) {
    double* u = state.fluid.velocity.component(c);
    for_each_face_within(
        grid, c, reaction.reach,
        [&, r = reaction.component(c), eps = before.face.component(c)](std::size_t n) { u[n] += r[n] / eps[n]; });
  }
}

}   // namespace bedload

// What the step starts from: grains on the grid, accelerations on faces, the flow at the grains.
#include "solver/coupler_parts.hpp"

#include "solver/fluid/boundaries.hpp"
#include "solver/fluid/courant.hpp"
#include "solver/fluid/face_loops.hpp"
#include "solver/fluid/operators.hpp"
#include "solver/fluid/rows.hpp"

namespace bedload {

/// Void fraction and stencils of x^n; those of the last step serve when nothing has moved since.
void Coupler::Parts::place_on_grid(const Grains& grains) {
  Stopwatch watch(times.deposit);
  if (positions == grains.position && diameters == grains.diameter) return;
  find_stencils(grid, grains, stencils);
  deposit_void_fraction(grid, grains, stencils, before, smoothing);
  fill_face_ghosts(grid, before.face);
  positions = grains.position;
  diameters = grains.diameter;
}

/// a_f = -grad q + nu lap u + G, and what turbulence adds.
void Coupler::Parts::find_acceleration(const State& state) {
  bedload::acceleration(grid, state.fluid.pressure, carried, scene.bed.fluid.viscosity, drive(state), acceleration);
  if (turbulence) turbulence->add_force(carried, 1, acceleration);
  clear_walls(grid, acceleration);
}

/// The acceleration of the faces and the volume flux eps u + J of the start of the step; fluid alone is accelerated later.
void Coupler::Parts::accelerate_faces(State& state) {
  Stopwatch watch(times.transport);
  fill_velocity_ghosts(grid, state.fluid.velocity, state.search.lid_speed);
  if (fluid_alone()) std::swap(carried, state.fluid.velocity);   // the step writes u* without reading what is there
  else carried = state.fluid.velocity;
  const FaceFields& u = carried;
  fill_centre_ghosts(grid, state.fluid.pressure);
  deposit_solid_flux(grid, state.grains, stencils, solid_flux, smoothing);
  Courant courant;
  for (int c = 0; c < 3; ++c) {
    double* const f = flux.component(c);
    const double *eps = before.face.component(c), *v = u.component(c);
    for_each_face_row(grid, c, [=, &courant, alone = fluid_alone()](std::size_t row, int length) {
      courant.add_row(c, v + row, length);
      if (alone) return;
      double* __restrict out = f + row;
      for (int k = 0; k < length; ++k) out[k] = eps[row + k] * v[row + k];
    });
    for_each_face_within(grid, c, solid_flux.reach, [&, j = solid_flux.component(c)](std::size_t n) { f[n] += j[n]; });
  }
  courant_rate = courant.rate(grid.h);
  if (turbulence) {   // a bed is as rough as its grains are large
    const double z_b = state.search.bed_height;
    turbulence->find(u, state.search.lid_speed, z_b, z_b > 0 ? scene.bed.grains.diameter : scene.bottom_roughness);
  }
  if (!fluid_alone()) find_acceleration(state), fill_face_ghosts(grid, flux);
  health.divergence_left =
      largest_divergence(grid, fluid_alone() ? u : flux);   // per time; choose_step makes it per step
  book_wall_shear(u);
  const double rho = scene.bed.fluid.density;
  const Vec3 box = grid.length();
  books.driving = rho * box.x * box.y * box.z * drive(state);
}

/// What bottom and lid take of a flow, or of its change, through viscosity and turbulence.
void Coupler::Parts::book_wall_shear(const FaceFields& velocity) {
  const double rho = scene.bed.fluid.density;
  const auto add = [&](const WallShear& shear) {
    books.on_bottom += rho * shear.bottom, books.on_lid += rho * shear.top;
  };
  add(wall_shear(grid, velocity, scene.bed.fluid.viscosity));
  if (turbulence) add(turbulence->wall_shear(velocity));
}

/// What grains see of an acceleration that fluid and grains share: on overfilled faces, the part that is left to them.
const FaceFields& Coupler::Parts::on_grains(const FaceFields& all) {
  if (before.overfilled.empty()) return all;
  shared = all;
  for (const OverfilledFace& f : before.overfilled) shared.component(f.direction)[f.face] *= f.grain_share;
  return shared;
}

/// The vorticity that woven_edges holds, at a grain.
Vec3 Coupler::Parts::turning_at(std::size_t p) const {
  return on_faces(sample(Weights<On::edges>(stencils[p]), Strides(grid), woven_edges.at(stencils[p])));
}

void Coupler::Parts::sample_at_grains(State& state) {
  Stopwatch watch(times.sample);
  sample_flow(grid, state.grains, stencils, carried, on_grains(acceleration), before.centre, law,
              scene.bed.fluid.viscosity, scene.terms, flow, smoothing);
  health.void_clamps = flow.void_clamps;
  health.face_clamps = before.overfilled.size();
  health.disturbance_clamps = flow.disturbance_clamps;
  if (!wants_vorticity()) return;
  find_vorticity(grid, carried, vorticity);
  woven_edges.read(stencils.reach, smoothing.edges_seen(vorticity, seen));
  flow.vorticity.resize(stencils.size());
  for (std::size_t p = 0; p < stencils.size(); ++p) flow.vorticity[p] = turning_at(p);
  add_explicit_forces({grid, PeriodicBox(scene.bed), scene.bed.fluid.viscosity, state.search.lid_speed}, state.grains,
                      scene.terms, sheltering, flow);
  health.lift_clamps = flow.lift_clamps;
}

}   // namespace bedload

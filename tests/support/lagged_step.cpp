#include "tests/support/lagged_step.hpp"

#include <cmath>

#include "solver/fluid/boundaries.hpp"
#include "solver/fluid/face_loops.hpp"
#include "solver/fluid/operators.hpp"

namespace bedload::test {

LaggedStep::LaggedStep(const Scene& scene)
    : scene_(scene),
      grid_(scene.grid),
      dynamics_(scene.bed),
      drag_(grid_),
      pressure_(grid_),
      before_(grid_),
      after_(grid_),
      acceleration_(grid_),
      laplace_(grid_),
      impulse_(grid_),
      flux_(grid_),
      kick_(grid_),
      solid_flux_(grid_),
      response_(grid_),
      rhs_(grid_),
      correction_(grid_) {}

void LaggedStep::step(State& state, double dt, int substeps) {
  Grains& grains = state.grains;
  FaceFields& u = state.fluid.velocity;
  const double rho = scene_.bed.fluid.density, nu = scene_.bed.fluid.viscosity;
  find_stencils(grid_, grains, stencils_);
  deposit_void_fraction(grid_, grains, stencils_, before_);
  fill_face_ghosts(grid_, before_.face);

  fill_velocity_ghosts(grid_, u, 0);
  const FaceFields carried = u;
  fill_centre_ghosts(grid_, state.fluid.pressure);
  gradient(grid_, state.fluid.pressure, acceleration_);
  laplacian(grid_, u, laplace_);
  deposit_solid_flux(grid_, grains, stencils_, solid_flux_);
  for (int c = 0; c < 3; ++c)
    for_each_unknown_face(grid_, c, [&](std::size_t n) {
      double& a = acceleration_.component(c)[n];
      a = nu * laplace_.component(c)[n] - a;
      impulse_.component(c)[n] = dt * before_.face.component(c)[n] * a;
      flux_.component(c)[n] = solid_flux_.component(c)[n] + before_.face.component(c)[n] * u.component(c)[n];
    });

  FlowAtGrains flow;
  sample_flow(grid_, grains, stencils_, u, acceleration_, before_.centre, drag_law(scene_.drag), nu, scene_.terms,
              flow);
  const std::size_t count = grains.size();
  std::vector<Vec3> exchange(count), relaxation(count), ballistic(count), push(count), flow_velocity(count);
  for (std::size_t p = 0; p < count; ++p) {
    const double volume = sphere_volume(grains.diameter[p]), mass = volume * grains.density[p] / rho;
    exchange[p] = flow.drag[p] * dt / grid_.cell_volume(), relaxation[p] = flow.drag[p] * dt / mass;
    push[p] = (1 - rho / grains.density[p]) * scene_.bed.gravity + volume / mass * flow.acceleration[p];
    if (scene_.terms.added_mass && !last_velocity_.empty())
      push[p] += 0.5 * volume / mass * (flow.acceleration[p] - (grains.velocity[p] - last_velocity_[p]) / dt);
    ballistic[p] = grains.velocity[p] + dt * (push[p] + grains.mean_contact_force[p] / (rho * mass));
  }
  drag_.solve(grid_, {stencils_, exchange, relaxation, ballistic, flow.velocity, 0}, before_.face, impulse_, u,
              flow_velocity);
  for (std::size_t p = 0; p < count; ++p)
    push[p] += relaxation[p].x / dt / (1 + relaxation[p].x) * (flow_velocity[p] - ballistic[p]);

  const std::vector<Vec3> start = grains.position;
  last_velocity_ = grains.velocity;
  dynamics_.advance(grains, state.contacts, {.push = push}, dt / substeps, substeps, 0);
  std::vector<Vec3> moved(count);
  for (std::size_t p = 0; p < count; ++p) {
    moved[p] = grains.position[p] - start[p];
    for (int c = 0; c < 3; ++c)
      if (grid_.periodic(c))
        grains.position[p][c] -= grid_.length()[c] * std::floor(grains.position[p][c] / grid_.length()[c]);
  }
  const Reach former = stencils_.reach;
  find_stencils(grid_, grains, stencils_);
  deposit_swept_flux(grid_, grains, start, moved, united(former, stencils_.reach), dt, solid_flux_);
  for (int c = 0; c < 3; ++c)
    for_each_unknown_face(grid_, c, [&](std::size_t n) { flux_.component(c)[n] -= solid_flux_.component(c)[n]; });
  fill_face_ghosts(grid_, flux_);
  deposit_void_fraction(grid_, grains, stencils_, after_);
  fill_face_ghosts(grid_, after_.face);
  transport(grid_, flux_, before_.face, after_.face, dt, carried, u, transport_scratch_);

  deposit_solid_flux(grid_, grains, stencils_, solid_flux_);
  Grains held = grains;   // the pressure equation of a fluid between grains that do not give way
  held.fixed.assign(count, 1);
  find_mixture_response(grid_, held, stencils_, exchange, rho, after_, false, response_);
  for (int c = 0; c < 3; ++c)
    for_each_unknown_face(grid_, c, [&](std::size_t n) {
      flux_.component(c)[n] = (solid_flux_.component(c)[n] + after_.face.component(c)[n] * u.component(c)[n]) / dt;
    });
  fill_face_ghosts(grid_, flux_), fill_face_ghosts(grid_, response_.coefficient);
  divergence(grid_, flux_, rhs_);
  std::fill(correction_.values.begin(), correction_.values.end(), 0.0);
  pressure_.solve(response_.coefficient, rhs_, correction_, 1e-4, 1e-9 / (dt * dt));
  gradient(grid_, correction_, kick_);
  for (int c = 0; c < 3; ++c)
    for_each_unknown_face(grid_, c, [&](std::size_t n) {
      u.component(c)[n] -= dt * response_.fluid.component(c)[n] * kick_.component(c)[n];
    });
  for (std::size_t n = 0; n < correction_.values.size(); ++n) state.fluid.pressure[n] += correction_[n];
}

}   // namespace bedload::test

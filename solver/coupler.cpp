// One coupled step, in the order of the physics.
#include "solver/coupler_parts.hpp"

namespace bedload {

Coupler::Parts::Parts(const Scene& given)
    : scene(given),
      grid(given.grid),
      law(drag_law(given.drag)),
      fall_time(time_of_fall(given)),
      smoothing(given.grid, given.smoothing),
      dynamics(given.bed, {given.terms.wet_restitution, given.terms.lubrication}),
      drag(grid),
      pressure(grid),
      before(grid),
      after(grid),
      acceleration(grid),
      impulse(grid),
      flux(grid),
      solid_flux(grid),
      woven(grid),
      woven_too(grid),
      response(grid),
      rhs(grid),
      correction(grid),
      kick(grid),
      carried(grid) {
  if (scene.terms.turbulence) turbulence.emplace(grid, scene.bed.fluid.viscosity);
  if (scene.terms.added_mass || explicit_forces()) added_exchange = reaction = Deposited(grid);
  before.woven = after.woven = solid_flux.woven = response.exchange = flow.woven = woven;
  response.locked = flow.woven_too = woven_too;
  drag.work_in(woven, woven_too);
  if (scene.terms.viscous_torque) spin_exchange.emplace(grid), spin_exchange->work_in(woven, woven_too);
  if (wants_vorticity()) vorticity = vorticity_change = FaceFields(grid), woven_edges = Woven(woven, On::edges);
}

Coupler::Coupler(const Scene& scene) : parts_(std::make_unique<Parts>(scene)) {}
Coupler::~Coupler() = default;
const StepBooks& Coupler::books() const { return parts_->books; }
std::span<const Vec3> Coupler::drag_on_grains() const { return parts_->drag_force; }
std::span<const Vec3> Coupler::torque_on_grains() const { return parts_->torque; }
const StepTimes& Coupler::times() const { return parts_->times; }
void Coupler::forget() {
  const StepTimes spent = parts_->times;
  auto tables = std::move(parts_->flow.self_disturbance);   // of the grid alone
  parts_ = std::make_unique<Parts>(parts_->scene);
  parts_->times = spent;
  parts_->flow.self_disturbance = std::move(tables);
}

StepHealth Coupler::step(State& state, double longest) {
  Parts& parts = *parts_;
  Stopwatch watch(parts.times.total);
  parts.health = {};
  parts.books = {};
  parts.place_on_grid(state.grains);
  parts.accelerate_faces(state);
  parts.sample_at_grains(state);
  const double dt = parts.choose_step(state, longest);
  parts.solve_drag(state, dt);
  parts.move_grains(state, dt);
  parts.deposit_at_new_positions(state, dt);
  parts.transport_momentum(state, dt);
  parts.carry_liquid(state, dt);
  parts.project(state, dt);
  ++state.clock.step;
  state.clock.time += dt;
  return parts.health;
}

}   // namespace bedload

// One coupled step, in the order of the physics.
#include "solver/coupler_layers.hpp"
#include "solver/coupler_parts.hpp"

namespace bedload {

Coupler::Rung::Rung(const Scene& given, Vec3 of_travel)
    : scene(given),
      grid(given.grid),
      reach(of_travel),
      law(drag_law(given.drag)),
      fall_time(time_of_fall(given)),
      dynamics(given.bed, {given.terms.wet_restitution, given.terms.lubrication}) {}

Coupler::Parts::Parts(const Scene& given)
    : Rung(given, given.grid.h),
      smoothing(given.grid, given.smoothing),
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

std::unique_ptr<Coupler::Rung> Coupler::rung_of(const Scene& scene) {
  switch (scene.fluid) {
    case FluidRung::profile: return std::make_unique<ProfileRung>(scene);
    case FluidRung::column: return std::make_unique<ColumnRung>(scene);
    case FluidRung::box: break;
  }
  return std::make_unique<Parts>(scene);
}

Coupler::Coupler(const Scene& scene) : rung_(rung_of(scene)) {}
Coupler::~Coupler() = default;
const StepBooks& Coupler::books() const { return rung_->books; }
std::span<const Vec3> Coupler::drag_on_grains() const { return rung_->drag_force; }
std::span<const Vec3> Coupler::torque_on_grains() const { return rung_->torque; }
const StepTimes& Coupler::times() const { return rung_->times; }
void Coupler::forget() {
  auto anew = rung_of(rung_->scene);
  anew->times = rung_->times;
  anew->flow.self_disturbance = std::move(rung_->flow.self_disturbance);   // tables of the grid alone
  rung_ = std::move(anew);
}

StepHealth Coupler::step(State& state, double longest) {
  Rung& rung = *rung_;
  Stopwatch watch(rung.times.total);
  rung.health = {};
  rung.books = {};
  rung.step(state, longest);
  ++state.clock.step;
  state.clock.time += rung.health.dt;
  return rung.health;
}

std::vector<double> Coupler::steady_column(const Grains& grains, const ImposedFlow& flow) {
  return rung_->steady_column(grains, flow);
}

void Coupler::Parts::step(State& state, double longest) {
  place_on_grid(state.grains);
  accelerate_faces(state);
  sample_at_grains(state);
  const double dt = choose_step(state, longest);
  solve_drag(state, dt);
  move_grains(state, dt);
  deposit_at_new_positions(state, dt);
  transport_momentum(state, dt);
  carry_liquid(state, dt);
  project(state, dt);
}

}   // namespace bedload

// One coupled step of grains and a layered flow, in the order of the physics.
#include "solver/coupler_layers.hpp"

#include <algorithm>
#include <cmath>

namespace bedload {
namespace {

constexpr int most_halvings = 200;
constexpr double steady_to = 1e-11;   // of the fastest layer
constexpr double packed = 0.6;   // phi_max of the mixing length: random close packing, less what slices of it scatter

bool all_finite(std::span<const double> u, const Grains& g) {
  bool finite = std::ranges::all_of(u, [](double each) { return std::isfinite(each); });
  for (const auto* each : {&g.velocity, &g.spin, &g.mean_contact_force, &g.mean_contact_torque})
    for (const Vec3& v : *each) finite &= std::isfinite(norm2(v));
  return finite;
}

/// Grains may cross layers within a step; what they may not pass over is the distance over which they sample.
Vec3 own_diameter(const Scene& scene) {
  const double d = scene.bed.grains.diameter;
  return {d, d, d};
}

}   // namespace

Column column_of(const Scene& scene) {
  return {.layers = scene.grid.cells[2],
          .thickness = scene.grid.h.z,
          .viscosity = scene.bed.fluid.viscosity,
          .top = scene.bed.top,
          .packing = scene.terms.turbulence ? packed : 0,
          .sand_roughness = scene.bottom_roughness};
}

Coupler::Layers::Layers(const Scene& given)
    : Rung(given, own_diameter(given)),
      column(column_of(given)),
      area(given.bed.length.x * given.bed.length.y),
      fluid(column),
      held_back(static_cast<std::size_t>(column.layers), 1) {}

std::span<double> Coupler::Layers::profile(State& state) const {
  return {&state.fluid.velocity.x[grid.index(0, 0, 0)], static_cast<std::size_t>(column.layers)};
}

void Coupler::Layers::step(State& state, double longest) {
  place_in_layers(state.grains);
  sample_at_grains(state);
  const double dt = choose_step(state, longest);
  predict_grains(state, dt);
  if (scene.terms.viscous_torque) predict_spins(state, dt);
  {
    Stopwatch watch(times.drag);
    advance_fluid(state, dt);
    feel_end_of_step(state);
    book_exchange(state, dt);
    if (scene.terms.viscous_torque) turn_grains(state, dt);
  }
  move_grains(state, dt);
  if (scene.terms.added_mass && health.substeps > 0) book_liquid(state.grains);
  if (!failed()) displace_fluid(state, dt);
  health.finite &= all_finite(profile(state), state.grains);
}

void Coupler::Layers::place_in_layers(const Grains& grains) {
  Stopwatch watch(times.deposit);
  positions = grains.position;
  find_slices(column, grains, slices);
  average_grains(column, grains, slices, area, solid);
}

/// Flow, void fraction and drag at the grains; a layer holds all grains at its height, so that a grain's own part is small.
void Coupler::Layers::sample_at_grains(State& state) {
  Stopwatch watch(times.sample);
  const Grains& grains = state.grains;
  const std::size_t count = grains.size();
  const std::span<const double> u = profile(state);
  flow.velocity.assign(count, {}), flow.void_fraction.resize(count), flow.acceleration.assign(count, {});
  flow.drag.assign(count, {}), flow.force.assign(count, {});
  flow.packing.own.resize(count), flow.packing.others.resize(count);
  flow.void_clamps = flow.disturbance_clamps = flow.lift_clamps = 0;
  for (std::size_t p = 0; p < count; ++p) {
    double squares = 0;
    for (std::size_t n = slices.begin[p]; n < slices.begin[p + 1]; ++n) squares += slices.part[n] * slices.part[n];
    const double held = sample(slices, p, solid.fraction);
    flow.velocity[p].x = sample(slices, p, u);
    flow.packing.own[p] = squares * sphere_volume(grains.diameter[p]) / (area * column.thickness);
    flow.packing.others[p] = std::max(0.0, held - flow.packing.own[p]);
    flow.void_fraction[p] = 1 - held;
  }
  find_drag(grid, grains, law, column.viscosity, scene.terms, flow);
  sample_stress(stress_divergence(state, u), state);
  stress_before_.resize(count);
  for (std::size_t p = 0; p < count; ++p) stress_before_[p] = flow.acceleration[p].x;
  health.void_clamps = flow.void_clamps;
  if (!wants_vorticity()) return;
  sample_vorticity(state);
  add_explicit_forces({grid, PeriodicBox(scene.bed), column.viscosity, state.search.lid_speed}, grains, scene.terms,
                      sheltering, flow);
  health.lift_clamps = flow.lift_clamps;
}

void Coupler::Layers::sample_vorticity(State& state) {
  fluid.find_shear(profile(state), state.search.lid_speed, shear_);
  flow.vorticity.assign(state.grains.size(), {});
  for (std::size_t p = 0; p < flow.vorticity.size(); ++p) flow.vorticity[p].y = sample(slices, p, shear_);
}

/// What acts on the volume of grains: drive and viscous stress.
void Coupler::Layers::sample_stress(std::span<const double> divergence, const State& state) {
  const double driven = drive(state).x;
  for (std::size_t p = 0; p < flow.acceleration.size(); ++p)
    flow.acceleration[p].x = driven + sample(slices, p, divergence);
}

/// The flow at the grains at the end of the step, the liquid that it leaves to them, and its stress in the place of what the prediction took it for.
void Coupler::Layers::feel_end_of_step(State& state) {
  const Grains& grains = state.grains;
  const std::span<const double> u = profile(state);
  sample_stress(fluid.stress_divergence(), state);
  for (std::size_t p = 0; p < grains.size(); ++p) {
    flow_velocity[p] = {sample(slices, p, u), 0, 0};
    if (!grains.fixed[p] && !model_b())
      push[p].x += scene.bed.fluid.density / grains.density[p] * (flow.acceleration[p].x - stress_before_[p]);
  }
  if (!scene.terms.added_mass) return;
  carried_mass.resize(grains.size());
  for (std::size_t p = 0; p < grains.size(); ++p)
    carried_mass[p] = scene.bed.fluid.density * added_volume[p] * sample(slices, p, held_back);
}

/// Torques by the flow at the end of the step. Fluid at rest across it holds spins about x and z.
void Coupler::Layers::turn_grains(State& state, double dt) {
  sample_vorticity(state);
  for (std::size_t p = 0; p < state.grains.size(); ++p) book_torque(state.grains, p, 0.5 * flow.vorticity[p], dt);
}

void Coupler::Layers::book_liquid(const Grains& grains) {
  for (std::size_t p = 0; p < grains.size(); ++p)
    if (!grains.fixed[p]) books.on_grains -= force_on_liquid(grains, p);
}

std::span<const double> Coupler::ColumnRung::stress_divergence(const State& state, std::span<const double> u) {
  fluid.measure(u, solid, state.search.lid_speed);
  health.face_clamps = static_cast<std::uint64_t>(fluid.clamps());
  return fluid.stress_divergence();
}

void Coupler::ColumnRung::advance_fluid(State& state, double dt) {
  const double gradient = state.search.gradient, rho = scene.bed.fluid.density, lid = state.search.lid_speed;
  const std::span<double> u = profile(state);
  const auto flux = [&] {   // of the fluid, per width [m2/s]: what the gradient works on
    double sum = 0;
    for (std::size_t k = 0; k < u.size(); ++k) sum += (1 - solid.fraction[k]) * u[k];
    return sum * column.thickness;
  };
  const double flux_before = flux();
  const bool added_mass = scene.terms.added_mass;
  if (added_mass) {
    answer_ = flow.drag;
    for (std::size_t p = 0; p < answer_.size(); ++p) answer_[p] += added_volume[p] / dt * Vec3{1, 1, 1};
  }
  find_exchange(column, slices, {added_mass ? answer_ : flow.drag, relaxation, ballistic, flow.force}, area, exchange_);
  if (added_mass)
    add_added_mass(column, state.grains, slices, {added_volume, flow.velocity, relaxation}, u, area, dt, exchange_,
                   along_);
  if (scene.terms.viscous_torque) find_couples(column, slices, spin_strength, spin_target, area, dt, exchange_);
  fluid.step(u, solid, exchange_, {.acceleration = gradient, .lid_speed = lid}, dt);
  if (added_mass)   // liquid goes along with grains that others push by the part A/(eps + A)
    for (std::size_t k = 0; k < held_back.size(); ++k)
      held_back[k] = fluid.void_fraction()[k] / (fluid.void_fraction()[k] + along_[k]);
  const ColumnBooks& b = fluid.books();
  books.on_bottom.x = rho * area * b.on_bottom, books.on_lid.x = rho * area * b.on_lid;
  books.driving.x = rho * scene.bed.length.z * area * gradient;
  books.by_lid = -books.on_lid.x * lid;
  books.by_gradient = rho * area * gradient * 0.5 * (flux_before + flux());
}

/// Steps of the fluid alone between grains that are fixed, each so long that nothing of the flow before is left in it. Half of each:
/// with the drag and the eddies of the flow before, u -> C/u and u -> (u + C/u)/2 where the root of C is looked for (Heron).
std::vector<double> Coupler::ColumnRung::steady_column(const Grains& grains, const ImposedFlow& imposed) {
  State still;
  still.fluid = FluidState(grid);
  still.grains = grains;
  still.grains.velocity.assign(grains.size(), {}), still.grains.spin.assign(grains.size(), {});
  still.grains.fixed.assign(grains.size(), 1);
  still.search.lid_speed = imposed.lid_speed, still.search.gradient = imposed.gradient;

  const double height = scene.bed.length.z, dt = 1e6 * height * height / column.viscosity;
  const std::span<double> u = profile(still);
  std::vector<double> before(u.size());
  place_in_layers(still.grains);
  for (int n = 0; n < most_halvings; ++n) {
    std::copy(u.begin(), u.end(), before.begin());
    sample_at_grains(still);
    predict_grains(still, dt);
    if (scene.terms.viscous_torque) predict_spins(still, dt);
    advance_fluid(still, dt);
    double change = 0, fastest = 0;
    for (std::size_t k = 0; k < u.size(); ++k) {
      u[k] = 0.5 * (before[k] + u[k]);
      change = std::max(change, std::abs(u[k] - before[k])), fastest = std::max(fastest, std::abs(u[k]));
    }
    if (change <= steady_to * fastest) break;
  }
  return {u.begin(), u.end()};
}

/// The liquid's part of what contacts have done that the solve did not know of, by layer as much as goes along there: so that
/// nowhere it overtakes the grains that push it. With the weights of the step's start, as the grains' inertia had them.
void Coupler::ColumnRung::push_liquid(State& state, double dt) {
  const Grains& grains = state.grains;
  const std::span<double> u = profile(state);
  const std::span<const double> eps = fluid.void_fraction();
  const double per_mass = dt / (scene.bed.fluid.density * area * column.thickness);
  for (std::size_t p = 0; p < grains.size(); ++p) {
    if (grains.fixed[p]) continue;
    const double impulse = per_mass * force_on_liquid(grains, p).x / sample(slices, p, held_back);
    for (std::size_t n = slices.begin[p], k = slices.first[p]; n < slices.begin[p + 1]; ++n, ++k)
      u[k] += impulse * slices.part[n] * held_back[k] / eps[k];
  }
}

void Coupler::ColumnRung::displace_fluid(State& state, double dt) {
  Stopwatch watch(times.transport);
  if (health.substeps == 0) return;
  if (scene.terms.added_mass) push_liquid(state, dt);
  find_slices(column, state.grains, slices);
  average_grains(column, state.grains, slices, area, moved_solid_);
  fluid.carry(profile(state), solid.fraction, moved_solid_.fraction);
}

Coupler::ProfileRung::ProfileRung(const Scene& given)
    : Layers(given),
      no_solid_{std::vector<double>(static_cast<std::size_t>(column.layers)),
                std::vector<double>(static_cast<std::size_t>(column.layers))} {}

std::span<const double> Coupler::ProfileRung::stress_divergence(const State& state, std::span<const double> u) {
  fluid.measure(u, no_solid_, state.search.lid_speed);
  return fluid.stress_divergence();
}

/// The stress on the walls is that of the flow given. It drags the lid and drives itself: nothing of that is in balance.
void Coupler::ProfileRung::advance_fluid(State& state, double) {
  const double per_area = scene.bed.fluid.density * area;
  books.on_bottom.x = per_area * fluid.stress().front(), books.on_lid.x = -per_area * fluid.stress().back();
  books.driving.x = per_area * scene.bed.length.z * state.search.gradient;
}

}   // namespace bedload

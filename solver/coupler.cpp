#include "solver/coupler.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <numbers>
#include <optional>

#include "solver/coupling/added_mass.hpp"
#include "solver/coupling/explicit_forces.hpp"
#include "solver/coupling/hydrodynamic_forces.hpp"
#include "solver/coupling/implicit_drag.hpp"
#include "solver/coupling/mixture_response.hpp"
#include "solver/coupling/spin_exchange.hpp"
#include "solver/fluid/boundaries.hpp"
#include "solver/fluid/face_loops.hpp"
#include "solver/fluid/momentum.hpp"
#include "solver/fluid/operators.hpp"
#include "solver/fluid/pressure_projection.hpp"
#include "solver/fluid/rows.hpp"
#include "solver/fluid/turbulence.hpp"
#include "solver/grains/grain_dynamics.hpp"

namespace bedload {
namespace {

constexpr double largest_cfl = 0.5;
constexpr double largest_grain_travel = 0.2;   // of a cell edge
constexpr double harmless_relaxation = 0.2;    // below it even explicit drag is stable
constexpr double largest_relaxation = 200;     // a = beta T/M of any grain
constexpr int least_substeps = 4;              // where drag holds grains fast, a > 1
constexpr double explicit_viscosity_limit = 1.0 / 12;
// Of the divergence that the projection starts with. Momentum does not depend on it, and the kick leaves more than this
// around grains that move; where none does, only the next limit counts, so that volume is kept whatever happens.
constexpr double pressure_tolerance = 1e-4;
constexpr double least_divergence = 1e-9;   // volume change per step that is not worth an iteration

bool all_finite(const State& state) {
  bool finite = true;
  for (int c = 0; c < 3; ++c)
    for (const double *v = state.fluid.velocity.component(c), *end = v + state.fluid.velocity.x.values.size(); v != end;
         ++v)
      finite &= std::isfinite(*v);
  for (const double q : state.fluid.pressure.values) finite &= std::isfinite(q);
  for (const Vec3& v : state.grains.velocity) finite &= std::isfinite(norm2(v));
  return finite;
}

bool any_mobile(const Grains& grains) {
  return std::find(grains.fixed.begin(), grains.fixed.end(), 0) != grains.fixed.end();
}

class Stopwatch {
 public:
  explicit Stopwatch(double& sum) : sum_(sum), start_(std::chrono::steady_clock::now()) {}
  ~Stopwatch() { sum_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  double& sum_;
  std::chrono::steady_clock::time_point start_;
};

/// Duration of the shortest Hertz collision of two like grains of the bed at `speed`, or at the speed of an overlap of
/// 0.1 % if that is more: resting contacts are springs too.
double shortest_contact(const Grains& grains, const GrainProperties& g, double speed) {
  double shortest = std::numeric_limits<double>::infinity(), diameter = 0, density = 0;
  for (std::size_t p = 0; p < grains.size(); ++p) {
    if (grains.fixed[p]) continue;
    const double d = grains.diameter[p], rho = grains.density[p], scale = d * std::pow(rho, 0.4);   // t_c ~ d rho^(2/5)
    if (scale < shortest) shortest = scale, diameter = d, density = rho;
  }
  const double resting =
      std::sqrt(std::pow(1e-3, 2.5) * g.young_modulus / (0.98 * (1 - g.poisson * g.poisson) * density));
  return contact_time(diameter, density, g.young_modulus, g.poisson, std::max(speed, resting));
}

/// max(sqrt(d/(|s - 1| g)), d/U_t) [s]; infinite without weight.
double time_of_fall(const Scene& scene) {
  const GrainProperties& g = scene.bed.grains;
  const double s = g.density / scene.bed.fluid.density, gravity = norm(scene.bed.gravity),
               reduced = std::abs(s - 1) * gravity;
  if (!(reduced > 0)) return std::numeric_limits<double>::infinity();
  return std::max(std::sqrt(g.diameter / reduced),
                  g.diameter / terminal_speed(scene.drag, scene.bed.fluid.viscosity, s, g.diameter, gravity));
}

double wrapped(double x, double length) {
  x -= length * std::floor(x / length);
  return x < length ? x : 0;   // rounding of a tiny negative x
}

}   // namespace

struct Coupler::Parts {
  explicit Parts(const Scene& given)
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
        laplace(grid),
        impulse(grid),
        flux(grid),
        solid_flux(grid),
        response(grid),
        rhs(grid),
        correction(grid),
        kick(grid) {
    if (scene.terms.turbulence) turbulence.emplace(grid, scene.bed.fluid.viscosity);
    if (scene.terms.added_mass || explicit_forces()) added_exchange = reaction = FaceFields(grid);
    if (scene.terms.viscous_torque) spin_exchange.emplace(grid);
    if (wants_vorticity()) vorticity = vorticity_change = FaceFields(grid);
  }

  const Scene scene;
  const StaggeredGrid grid;
  const DragLaw law;
  const double fall_time;
  const KernelSmoothing smoothing;
  GrainDynamics dynamics;
  ImplicitDrag drag;
  PressureSolver pressure;
  std::optional<Turbulence> turbulence;   // a function of u^n; only where the scene has it

  // Scratch; `stencils` and `before` belong to `positions` and are kept when the state still has them.
  std::vector<Vec3> positions;
  std::vector<double> diameters;
  std::vector<Stencil> stencils;
  VoidFraction before, after;
  FaceFields acceleration, laplace, impulse, flux, solid_flux;
  MixtureResponse response;
  Field<Centre> rhs, correction;
  FaceFields kick, carried, shared;
  FaceFields seen;   // what grains read of a field; only with a smoothing
  TransportScratch transport_scratch;
  FlowAtGrains flow;
  Sheltering sheltering;
  std::vector<Vec3> exchange, relaxation, ballistic, flow_velocity, push, moved, drag_force;
  // Only where the terms need them.
  std::vector<double> added_volume, carried_mass;   // C_A V_p [m3]; the liquid that a contact force moves too [kg]
  std::vector<Vec3> contact_before;                 // mean contact force that the drag solve has met [N]
  FaceFields added_exchange, reaction;
  std::optional<SpinExchange> spin_exchange;
  FaceFields vorticity, vorticity_change;   // on edges [1/s]
  std::vector<Vec3> spin_strength;          // T c' [m5]
  std::vector<Vec3> spin_start, spin_target, spin_push, torque;

  StepBooks books;
  StepTimes times;
  StepHealth health;

  bool failed() const { return !health.finite || health.lost_grain; }
  bool model_b() const { return scene.terms.model_b(); }
  bool explicit_forces() const { return any_explicit(scene.terms); }
  bool wants_vorticity() const { return scene.terms.viscous_torque || explicit_forces(); }
  double specific_mass(const Grains& g, std::size_t p) const {
    return sphere_volume(g.diameter[p]) * g.density[p] / scene.bed.fluid.density;
  }
  /// -dp/dx that drives the fluid, and the uniform gradient that holds back the net flux of a z-periodic box [m/s2].
  Vec3 drive(const State& s) const { return {s.search.gradient, 0, s.fluid.column_gradient}; }

  void place_on_grid(const Grains&);
  void accelerate_faces(State&);
  void book_wall_shear(const FaceFields& velocity);
  FaceFields& on_grains(FaceFields& acceleration);
  void sample_at_grains(State&);
  double choose_step(const State&, double longest);
  double courant_rate(const FaceFields& velocity) const;
  int limit_by_grains(const State&, double& step);
  void shorten(double& step, double limit, StepLimit by);
  void predict_grains(const State&, double dt);
  void predict_spins(const State&, double dt);
  void find_impulse(const State&, double dt);
  void react_on_fluid(const State&, double dt);
  void solve_drag(State&, double dt);
  void book_exchange(const State&, double dt);
  void book_torques(const Grains&, double dt);
  void book_drive_of_fluid(const State&);
  void book_drive_of_grains(const State&, double dt);
  void find_carried_mass(const Grains&);
  void move_grains(State&, double dt);
  void carry_liquid(State&, double dt);
  void deposit_at_new_positions(const State&, double dt);
  void transport_momentum(State&, double dt);
  void project(State&, double dt);
  void hold_net_flux(State&, double dt);
  void kick_mixture(State&, double dt);
  Vec3 weight(double density) const;
};

Coupler::Coupler(const Scene& scene) : parts_(std::make_unique<Parts>(scene)) {}
Coupler::~Coupler() = default;
const StepBooks& Coupler::books() const { return parts_->books; }
std::span<const Vec3> Coupler::drag_on_grains() const { return parts_->drag_force; }
std::span<const Vec3> Coupler::torque_on_grains() const { return parts_->torque; }
const StepTimes& Coupler::times() const { return parts_->times; }
void Coupler::forget() {
  const StepTimes spent = parts_->times;
  parts_ = std::make_unique<Parts>(parts_->scene);
  parts_->times = spent;
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

/// a_f = -grad q + nu lap u + G, and the volume flux eps u + J of the start of the step.
void Coupler::Parts::accelerate_faces(State& state) {
  Stopwatch watch(times.transport);
  FaceFields& u = state.fluid.velocity;
  fill_velocity_ghosts(grid, u, state.search.lid_speed);
  carried = u;
  fill_centre_ghosts(grid, state.fluid.pressure);
  gradient(grid, state.fluid.pressure, acceleration);
  laplacian(grid, u, laplace);
  deposit_solid_flux(grid, state.grains, stencils, flux, smoothing);
  const double nu = scene.bed.fluid.viscosity;
  for (int c = 0; c < 3; ++c) {
    double *a = acceleration.component(c), *f = flux.component(c);
    const double *lap = laplace.component(c), *eps = before.face.component(c), *v = u.component(c);
    const double g = drive(state)[c];
    for_each_unknown_face(grid, c, [&](std::size_t n) {
      a[n] = -a[n] + nu * lap[n] + g;
      f[n] += eps[n] * v[n];
    });
  }
  if (turbulence) {   // a bed is as rough as its grains are large
    const double z_b = state.search.bed_height;
    turbulence->find(u, state.search.lid_speed, z_b, z_b > 0 ? scene.bed.grains.diameter : scene.bottom_roughness);
    turbulence->add_force(u, 1, acceleration);
  }
  clear_walls(grid, acceleration);
  fill_face_ghosts(grid, flux);
  divergence(grid, flux, rhs);
  double largest = 0;   // per time; choose_step makes it per step
  for_each_cell_row(grid, [&](std::size_t row, int length) {
    for (std::size_t n = row; n < row + length; ++n) largest = std::max(largest, std::abs(rhs[n]));
  });
  health.divergence_left = largest;
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
FaceFields& Coupler::Parts::on_grains(FaceFields& all) {
  if (before.overfilled.empty()) return all;
  shared = all;
  for (const OverfilledFace& f : before.overfilled) shared.component(f.direction)[f.face] *= f.grain_share;
  return shared;
}

void Coupler::Parts::sample_at_grains(State& state) {
  Stopwatch watch(times.sample);
  sample_flow(grid, state.grains, stencils, state.fluid.velocity, on_grains(acceleration), before.centre, law,
              scene.bed.fluid.viscosity, scene.terms, flow, smoothing);
  health.void_clamps = flow.void_clamps;
  health.disturbance_clamps = flow.disturbance_clamps;
  if (!wants_vorticity()) return;
  find_vorticity(grid, carried, vorticity);
  const FaceFields& turning = smoothing.edges_seen(grid, vorticity, seen);
  flow.vorticity.resize(stencils.size());
  for (std::size_t p = 0; p < stencils.size(); ++p)
    flow.vorticity[p] = sample_edges(stencils[p], Strides(grid), turning);
  add_explicit_forces({grid, PeriodicBox(scene.bed), scene.bed.fluid.viscosity, state.search.lid_speed}, state.grains,
                      scene.terms, sheltering, flow);
}

void Coupler::Parts::shorten(double& step, double limit, StepLimit by) {
  if (!(limit < step)) return;
  step = limit;
  health.limited_by = by;
}

/// Cells that the flow crosses per time, summed over the directions [1/s]: CFL = rate x step.
double Coupler::Parts::courant_rate(const FaceFields& velocity) const {
  double rate = 0;
  for (int c = 0; c < 3; ++c) {
    double fastest = 0;
    for_each_unknown_face(
        grid, c, [&, v = velocity.component(c)](std::size_t n) { fastest = std::max(fastest, std::abs(v[n])); });
    rate += fastest / grid.h[c];
  }
  return rate;
}

/// The longest step, in whole DEM steps, that every limit allows (docs/physics_coupling.md, "The fluid step").
double Coupler::Parts::choose_step(const State& state, double longest) {
  const double rate = courant_rate(state.fluid.velocity);
  double step = longest;
  if (rate > 0) shorten(step, largest_cfl / rate, StepLimit::cfl);
  if (any_mobile(state.grains)) {
    const int least = limit_by_grains(state, step);
    health.substeps = std::max(least, static_cast<int>(step / scene.bed.dem_step * (1 + 1e-12)));
    step = std::min(step, health.substeps * scene.bed.dem_step);
  }
  health.cfl = step * rate;
  health.divergence_left *= step;
  return health.dt = step;
}

/// Travel, relaxation by drag, half the duration of a collision, a tenth of the time in which a grain falls its diameter.
/// Returns the least number of sub-steps: in a single one a dashpot sees, of grains that drag holds fast, only the change of
/// contact forces since the last step, which drag has not met yet, and drives it up.
int Coupler::Parts::limit_by_grains(const State& state, double& step) {
  const Grains& grains = state.grains;
  const double shortest_edge = std::min({grid.h.x, grid.h.y, grid.h.z});
  double fastest = 0;
  for (std::size_t p = 0; p < grains.size(); ++p)
    if (!grains.fixed[p]) fastest = std::max(fastest, norm(grains.velocity[p]));
  if (fastest > 0) shorten(step, largest_grain_travel * shortest_edge / fastest, StepLimit::travel);
  double relaxation_time = std::numeric_limits<double>::infinity();   // the shortest M/beta
  for (std::size_t p = 0; p < grains.size(); ++p)
    if (const double beta = std::max({flow.drag[p].x, flow.drag[p].y, flow.drag[p].z}); !grains.fixed[p] && beta > 0)
      relaxation_time = std::min(relaxation_time, specific_mass(grains, p) / beta);
  shorten(step, largest_relaxation * relaxation_time, StepLimit::drag);
  // Drag that is constant over a step lags behind a collision; that matters only where drag is not weak.
  const double weak_drag = harmless_relaxation * relaxation_time;
  shorten(step, std::max(0.5 * shortest_contact(grains, scene.bed.grains, fastest), weak_drag), StepLimit::contact);
  shorten(step, 0.1 * fall_time, StepLimit::weight);
  return step > relaxation_time ? least_substeps : 1;
}

Vec3 Coupler::Parts::weight(double density) const {
  return scene.terms.buoyancy ? (1 - scene.bed.fluid.density / density) * scene.bed.gravity : scene.bed.gravity;
}

/// Ballistic velocities, and what drag and added mass exchange over the step: added mass resists increments of velocity as
/// drag resists velocity, so that E = beta T + m_a stands where beta T stood.
void Coupler::Parts::predict_grains(const State& state, double dt) {
  const Grains& grains = state.grains;
  const double rho = scene.bed.fluid.density;
  const std::size_t count = grains.size();
  exchange.resize(count), relaxation.resize(count), ballistic.resize(count), flow_velocity.resize(count),
      push.resize(count), drag_force.resize(count);
  if (scene.terms.added_mass) find_added_mass(grid, grains, flow.void_fraction, model_b(), added_volume, smoothing);
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
void Coupler::Parts::predict_spins(const State& state, double dt) {
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
    if (scene.terms.wall_forces) wall = wall_torque(grid, grains.position[p], d, flow.packing.others[p]);
    spin_strength[p] = dt * c * wall.shear, spin_target[p] = spin_start[p] = {};
    if (grains.fixed[p]) continue;
    const double inertia = sphere_inertia(grains.density[p] * sphere_volume(d), d);
    spin_start[p] = spin + dt / inertia * grains.mean_contact_torque[p];
    for (int t = 0; t < 3; ++t) {
      spin_strength[p][t] /= 1 + dt * c * wall.spin[t] * rho / inertia;
      spin_target[p][t] = wall.spin[t] / wall.shear[t] * spin_start[p][t];
    }
  }
  spin_exchange->prepare(stencils, spin_strength, spin_target, smoothing);
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
  clear(reaction), clear(added_exchange);
  for (std::size_t p = 0; p < state.grains.size(); ++p) {
    Vec3 given;
    if (explicit_forces()) given += dt * flow.force[p];
    if (scene.terms.added_mass) {
      const double share = added_volume[p] * per_cell;
      deposit(stencils[p], stride, {share, share, share}, added_exchange);
      if (!state.grains.fixed[p]) given += added_volume[p] * state.grains.velocity[p];
    }
    deposit(stencils[p], stride, -per_cell * given, reaction);
  }
  fold_deposits(grid, reaction), fold_deposits(grid, added_exchange);
  smoothing.spread(reaction), smoothing.spread(added_exchange);
  for (int c = 0; c < 3; ++c) {
    double* b = impulse.component(c);
    const double *r = reaction.component(c), *added = added_exchange.component(c),
                 *u = state.fluid.velocity.component(c);
    for_each_unknown_face(grid, c, [&](std::size_t n) { b[n] += r[n] + added[n] * u[n]; });
  }
}

/// Of a grain's added mass, what a contact force moves with it: the liquid at its faces goes along by the part A/(eps + A),
/// A = sum w m_a/V_c as in the drag solve, and does not where a wall holds it; the mean of the three directions. With the
/// whole of m_a, in a bed several times the liquid there is, liquid would overtake the grains that push it.
void Coupler::Parts::find_carried_mass(const Grains& grains) {
  FaceFields& along = added_exchange;
  for (int c = 0; c < 3; ++c)
    for_each_unknown_face(
        grid, c, [a = along.component(c), eps = before.face.component(c)](std::size_t n) { a[n] /= eps[n] + a[n]; });
  clear_walls(grid, along);
  const FaceFields& read = smoothing.seen(grid, along, seen);
  const Strides stride(grid);
  carried_mass.resize(grains.size());
  for (std::size_t p = 0; p < grains.size(); ++p) {
    const Vec3 part = sample(stencils[p], stride, read);
    carried_mass[p] = scene.bed.fluid.density * added_volume[p] * (1 - (part.x + part.y + part.z) / 3);
  }
}

/// The one implicit solve of the step for all that fluid and grains exchange; leaves the grains' constant push.
void Coupler::Parts::solve_drag(State& state, double dt) {
  Stopwatch watch(times.drag);
  const double nu = scene.bed.fluid.viscosity;
  predict_grains(state, dt);
  if (spin_exchange) predict_spins(state, dt);
  find_impulse(state, dt);
  if (scene.terms.added_mass) find_carried_mass(state.grains);
  const double shortest_edge = std::min({grid.h.x, grid.h.y, grid.h.z});
  const double largest = nu + (turbulence ? turbulence->largest() : 0);
  const bool implicit = largest * dt > explicit_viscosity_limit * shortest_edge * shortest_edge;
  DragProblem problem{.stencils = stencils,
                      .exchange = exchange,
                      .relaxation = relaxation,
                      .ballistic = ballistic,
                      .flow_velocity = flow.velocity,
                      .smoothing = smoothing};
  if (implicit) problem.implicit_viscosity = nu * dt, problem.turbulence = turbulence ? &*turbulence : nullptr;
  problem.step = dt;
  problem.spin = spin_exchange ? &*spin_exchange : nullptr;
  health.drag_iterations = drag.solve(grid, problem, before.face, impulse, state.fluid.velocity, flow_velocity);
  health.converged = health.drag_iterations < ImplicitDrag::most_iterations;
  book_exchange(state, dt);
  if (spin_exchange) book_torques(state.grains, dt);
  if (implicit) book_wall_shear(drag.change());
  book_drive_of_fluid(state);
}

/// The lid's work on the fluid and G's, whose force moves with the mean of u^n and u*.
void Coupler::Parts::book_drive_of_fluid(const State& state) {
  books.driving_power = -books.on_lid.x * state.search.lid_speed;
  const Vec3 g = drive(state);
  for (int c = 0; c < 3; ++c) {
    if (g[c] == 0) continue;
    const double *eps = before.face.component(c), *u = state.fluid.velocity.component(c), *old = carried.component(c);
    books.driving_power += scene.bed.fluid.density * grid.cell_volume() * g[c] *
                           sum_over_faces(grid, c, [=, whole = model_b()](std::size_t n) {
                             return (whole ? 1 : eps[n]) * 0.5 * (u[n] + old[n]);
                           });
  }
}

/// Weight's and G's work on the grains over the way they went.
void Coupler::Parts::book_drive_of_grains(const State& state, double dt) {
  const Grains& grains = state.grains;
  const double rho = scene.bed.fluid.density;
  double work = 0;
  for (std::size_t p = 0; p < grains.size(); ++p) {
    if (grains.fixed[p]) continue;
    Vec3 force = grains.density[p] * weight(grains.density[p]);
    force.x += state.search.push * norm(force);
    if (!model_b()) force += rho * drive(state);
    work += sphere_volume(grains.diameter[p]) * dot(force, moved[p]);
  }
  books.driving_power += work / dt;
}

/// The forces that the solve has found, into the grains' push and the books.
void Coupler::Parts::book_exchange(const State& state, double dt) {
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

/// The torques that the solve has found, into the grains' spin and what the couples leave on walls into the books.
void Coupler::Parts::book_torques(const Grains& grains, double dt) {
  const double rho = scene.bed.fluid.density;
  find_vorticity(grid, drag.change(), vorticity_change);
  for (int t = 0; t < 3; ++t) {
    double* w = vorticity.component(t);
    for (std::size_t n = 0; n < vorticity.x.values.size(); ++n) w[n] += vorticity_change.component(t)[n];
  }
  const FaceFields& turning = smoothing.edges_seen(grid, vorticity, seen);
  for (std::size_t p = 0; p < grains.size(); ++p) {
    const Vec3 turn = 0.5 * sample_edges(stencils[p], Strides(grid), turning);
    torque[p] = scaled(rho * spin_strength[p] / dt, turn - spin_target[p]);
    Vec3 slip = turn - spin_start[p];
    if (!grains.fixed[p]) {
      const double d = grains.diameter[p];
      spin_push[p] = torque[p] / sphere_inertia(grains.density[p] * sphere_volume(d), d);
      slip -= dt * spin_push[p];
    }
    books.exchange_loss += dot(torque[p], slip);
  }
  const auto walls = spin_exchange->on_walls(vorticity);
  books.on_bottom += rho / dt * walls.bottom, books.on_lid += rho / dt * walls.top;
}

/// Sub-steps of {contacts, motion} under the constant push; drag does not change within them.
void Coupler::Parts::move_grains(State& state, double dt) {
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
  const Vec3 length = scene.bed.length;
  for (std::size_t p = 0; p < grains.size(); ++p) {
    Vec3& x = grains.position[p];
    moved[p] = x - positions[p];
    for (int c = 0; c < 3; ++c) {
      if (!std::isfinite(x[c])) health.finite = false;
      health.grain_travel = std::max(health.grain_travel, std::abs(moved[p][c]) / grid.h[c]);
      if (grid.periodic(c)) x[c] = wrapped(x[c], length[c]);
      if (x[c] < 0 || x[c] > length[c]) health.lost_grain = true;
    }
  }
  book_drive_of_grains(state, dt);
  health.lost_grain |= health.grain_travel >= 1;   // more than the charge-conserving deposit can carry
}

/// The flux that transport needs, then everything that belongs to x^{n+1}.
void Coupler::Parts::deposit_at_new_positions(const State& state, double dt) {
  Stopwatch watch(times.deposit);
  if (failed()) return;
  const Grains& grains = state.grains;
  deposit_swept_flux(grid, grains, positions, moved, dt, solid_flux, smoothing);
  for (int c = 0; c < 3; ++c)
    for_each_unknown_face(grid, c,
                          [f = flux.component(c), j = solid_flux.component(c)](std::size_t n) { f[n] -= j[n]; });
  fill_face_ghosts(grid, flux);

  find_stencils(grid, grains, stencils);
  deposit_void_fraction(grid, grains, stencils, after, smoothing);
  fill_face_ghosts(grid, after.face);
  deposit_solid_flux(grid, grains, stencils, solid_flux, smoothing);
  find_mixture_response(grid, grains, stencils, exchange, scene.bed.fluid.density, after, model_b(), response,
                        smoothing);
}

void Coupler::Parts::transport_momentum(State& state, double dt) {
  Stopwatch watch(times.transport);
  if (failed()) return;
  transport(grid, flux, before.face, after.face, dt, carried, state.fluid.velocity, transport_scratch);
  std::swap(before, after);
  positions = state.grains.position;
}

/// Contact forces that the drag solve did not know of have moved grains with their liquid: the liquid's part of the impulse
/// is the fluid's.
void Coupler::Parts::carry_liquid(State& state, double dt) {
  if (!scene.terms.added_mass || health.substeps == 0 || failed()) return;
  const Grains& grains = state.grains;
  const Strides stride(grid);
  const double rho = scene.bed.fluid.density;
  clear(reaction);
  for (std::size_t p = 0; p < grains.size(); ++p) {
    if (grains.fixed[p]) continue;
    const double part = carried_mass[p] / (rho * specific_mass(grains, p) + carried_mass[p]);
    const Vec3 on_liquid = part * (grains.mean_contact_force[p] - contact_before[p]);
    deposit(stencils[p], stride, dt / (rho * grid.cell_volume()) * on_liquid, reaction);
    books.on_grains -= on_liquid;
  }
  fold_deposits(grid, reaction);
  smoothing.spread(reaction);
  for (int c = 0; c < 3; ++c) {
    double* u = state.fluid.velocity.component(c);
    for_each_unknown_face(grid, c, [&, r = reaction.component(c), eps = before.face.component(c)](std::size_t n) {
      u[n] += r[n] / eps[n];
    });
  }
}

/// Makes div(eps u + J) vanish at the new instant: fluid and mobile grains give way to the pressure together.
void Coupler::Parts::project(State& state, double dt) {
  Stopwatch watch(times.pressure);
  if (failed()) return;
  for (int c = 0; c < 3; ++c) {
    double* f = solid_flux.component(c);
    const double *eps = before.face.component(c), *u = state.fluid.velocity.component(c);
    for_each_unknown_face(grid, c, [&](std::size_t n) { f[n] = (f[n] + eps[n] * u[n]) / dt; });
  }
  fill_face_ghosts(grid, solid_flux);
  fill_face_ghosts(grid, response.coefficient);
  divergence(grid, solid_flux, rhs);
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
  const double *f = solid_flux.component(2), *both = response.coefficient.component(2);
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
    on_fixed[c] = sum_over_faces(
        grid, c, [&](std::size_t n) { return -k[n] * (locked[n] * cf[n] + (model_b() ? 0 : 1 - eps[n] - phi[n])); });
    for_each_unknown_face(grid, c, [&](std::size_t n) {
      u[n] -= dt * cf[n] * k[n];
      k[n] *= cp[n];
    });
  }
  books.on_grains += rho * grid.cell_volume() * on_fixed;
  if (health.substeps == 0) return;
  const FaceFields& push_seen = smoothing.seen(grid, kick, seen);
  const Strides stride(grid);
  for (std::size_t p = 0; p < state.grains.size(); ++p) {
    if (state.grains.fixed[p]) continue;
    const Vec3 change = -sample(stencils[p], stride, push_seen);
    state.grains.velocity[p] += dt * change;
    books.on_grains += rho * specific_mass(state.grains, p) * change;
  }
}

}   // namespace bedload

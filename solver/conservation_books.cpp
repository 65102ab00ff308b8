// Volume, momentum and energy of fluid and grains, before and after each step.
#include "solver/conservation_books.hpp"
#include "solver/bed/frozen_grains.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/coupling/added_mass.hpp"
#include "solver/coupling/void_fraction.hpp"
#include "solver/fluid/face_loops.hpp"
#include "solver/grains/box_walls.hpp"
#include "solver/grains/rolling_resistance.hpp"

namespace bedload {
namespace {

double mass_of(const Grains& g, std::size_t p) { return g.density[p] * sphere_volume(g.diameter[p]); }

/// Energy of the springs of contacts: what laws and box say of each pair at rest where it is.
class ContactEnergy {
 public:
  explicit ContactEnergy(const BedScene& bed) : box_(bed), walls_(walls_of(bed)), law_(bed.grains) {}

  double operator()(const State& state) const {
    const ContactHistory contacts = all_contacts(state.contacts, state.asleep);
    double sum = 0;
    for (std::size_t n = 0; n < contacts.size(); ++n) {
      const Overlap o = overlap(state.grains, contacts.lower[n], contacts.higher[n]);
      sum += law_.energy(o, contacts.spring[n]);
      if (!contacts.rolling.empty()) sum += RollingResistance::energy(law_, o, contacts.rolling[n]);
    }
    return sum;
  }

 private:
  Overlap overlap(const Grains& g, std::uint32_t i, std::uint32_t j) const {
    const double r = g.diameter[i] / 2;
    if (j >= g.size()) {
      const auto wall = std::ranges::find(walls_, static_cast<Wall>(j), &FlatWall::name);
      return {.depth = wall->depth(g.position[i], r), .root_radius = std::sqrt(r)};
    }
    const double other = g.diameter[j] / 2;
    return {.depth = r + other - norm(box_.shortest(g.position[j] - g.position[i])),
            .root_radius = std::sqrt(r * other / (r + other))};
  }

  PeriodicBox box_;
  std::vector<FlatWall> walls_;
  HertzMindlin law_;
};

/// The sums of one state.
struct Sums {
  Vec3 momentum;          // of fluid and grains [kg m/s]
  double magnitude = 0;   // the same without signs
  double energy = 0;      // kinetic, and of springs [J]
};

}   // namespace

struct ConservationBooks::Parts {
  explicit Parts(const Scene& given)
      : scene(given),
        grid(given.grid),
        smoothing(given.grid, given.smoothing),
        springs(given.bed),
        eps(grid),
        woven(grid) {}

  Sums sums_of(const State&);
  double of_added_mass(const State&);
  void check_grains(const State&);
  void book_momentum(const Sums& before, const Sums& after, const State&, double dt, const StepBooks&);
  void book_energy(const Sums& before, const Sums& after, const State& from, const State& to, double dt,
                   const StepBooks&);
  Vec3 weight(double of_grain) const {
    return (of_grain - (scene.terms.buoyancy ? scene.bed.fluid.density : 0)) * scene.bed.gravity;
  }

  const Scene scene;
  const StaggeredGrid grid;
  const KernelSmoothing smoothing;
  const ContactEnergy springs;
  Stencils stencils;
  VoidFraction eps;
  FaceFields seen_flow;
  Woven woven;
  std::vector<Vec3> flow;
  Field<Centre> seen_eps;
  std::vector<double> void_fraction, added;
  GrainPacking packing;

  Books worst;
  std::vector<double> diameter, density;   // of the first state
  double dissipated = 0, most_dissipated = 0, exchanged = 0;
};

ConservationBooks::ConservationBooks(const Scene& scene) : parts_(std::make_unique<Parts>(scene)) {}
ConservationBooks::~ConservationBooks() = default;
const Books& ConservationBooks::worst() const { return parts_->worst; }

void ConservationBooks::add(const State& before, const State& after, const StepHealth& health, const StepBooks& books) {
  Parts& parts = *parts_;
  Books& worst = parts.worst;
  worst.divergence = std::max(worst.divergence, before.search.hold_begun ? health.divergence_left : 0);
  worst.mobile |= health.substeps > 0;
  parts.check_grains(after);
  const Sums from = parts.sums_of(before), to = parts.sums_of(after);
  if (!before.search.hold_begun) return;
  parts.book_momentum(from, to, before, health.dt, books);
  parts.book_energy(from, to, before, after, health.dt, books);
}

void ConservationBooks::Parts::check_grains(const State& state) {
  const Grains& grains = state.grains;
  if (diameter.empty()) diameter = grains.diameter, density = grains.density;
  worst.grains_unchanged &= diameter == grains.diameter && density == grains.density;
  for (const Vec3& x : grains.position)
    for (int c = 0; c < 3; ++c) worst.grains_unchanged &= x[c] >= 0 && x[c] <= scene.bed.length[c];
}

Sums ConservationBooks::Parts::sums_of(const State& state) {
  const Grains& grains = state.grains;
  const double rho = scene.bed.fluid.density, cell = grid.cell_volume();
  find_stencils(grid, grains, stencils);
  deposit_void_fraction(grid, grains, stencils, eps, smoothing);

  const Vec3 length = grid.length();
  const double box = length.x * length.y * length.z;
  double fluid = cell * sum_over_cells(grid, [&](std::size_t n) { return eps.centre[n]; }), solid = 0;
  for (const double d : grains.diameter) solid += sphere_volume(d);
  worst.fluid_volume = std::max(worst.fluid_volume, std::abs(fluid - (box - solid)) / box);

  Sums sums;
  for (int c = 0; c < 3; ++c) {
    const double *e = eps.face.component(c), *u = state.fluid.velocity.component(c);
    const auto over = [&](auto&& value) { return cell * sum_over_faces(grid, c, value); };
    sums.momentum[c] = rho * over([=](std::size_t n) { return e[n] * u[n]; });
    sums.magnitude += rho * over([=](std::size_t n) { return e[n] * std::abs(u[n]); });
    sums.energy += rho / 2 * over([=](std::size_t n) { return e[n] * u[n] * u[n]; });
  }
  for (std::size_t p = 0; p < grains.size(); ++p) {
    const double mass = mass_of(grains, p);
    sums.momentum += mass * grains.velocity[p];
    sums.magnitude += mass * norm(grains.velocity[p]);
    sums.energy +=
        mass / 2 * norm2(grains.velocity[p]) + sphere_inertia(mass, grains.diameter[p]) / 2 * norm2(grains.spin[p]);
  }
  sums.energy += springs(state);
  if (scene.terms.added_mass) sums.energy += of_added_mass(state);
  return sums;
}

/// Kinetic energy of the liquid that a grain carries along, C_A rho V_p |u - v|^2/2: what added mass takes up and gives back.
double ConservationBooks::Parts::of_added_mass(const State& state) {
  const Grains& grains = state.grains;
  const Strides stride(grid);
  const Field<Centre>& packed = smoothing.seen(eps.centre, seen_eps);
  woven.read(stencils.reach, smoothing.seen(state.fluid.velocity, seen_flow), &packed);
  void_fraction.resize(grains.size()), flow.resize(grains.size());
  for (std::size_t p = 0; p < grains.size(); ++p) {
    const Quad read = sample(Weights(stencils[p]), stride, woven.at(stencils[p]));
    flow[p] = on_faces(read), void_fraction[p] = in_cell(read);
  }
  packing.crowded = scene.terms.crowded;
  find_packing(grid, grains, packed, void_fraction, packing, smoothing);
  find_added_mass(grains, void_fraction, packing, scene.terms.model_b(), added);
  double sum = 0;
  for (std::size_t p = 0; p < grains.size(); ++p) sum += added[p] / 2 * norm2(flow[p] - grains.velocity[p]);
  return scene.bed.fluid.density * sum;
}

/// d(momentum) = (drive + weight along the slope + push - what bottom, lid and walls take up) dt.
void ConservationBooks::Parts::book_momentum(const Sums& before, const Sums& after, const State& state, double dt,
                                             const StepBooks& books) {
  const Grains& grains = state.grains;
  const bool seen =
      grid.periodic(0) && grid.periodic(1) && std::ranges::all_of(grains.fixed, [](std::uint8_t f) { return f == 0; });
  if (!seen) return;
  Vec3 force = books.driving - books.on_bottom - books.on_lid - books.contact_on_walls;
  for (std::size_t p = 0; p < grains.size(); ++p) {
    const Vec3 w = weight(grains.density[p]);
    force += sphere_volume(grains.diameter[p]) * w;
    force.x += sphere_volume(grains.diameter[p]) * state.search.push * norm(w);
  }
  const Vec3 made = after.momentum - before.momentum - dt * force;
  const double scale = after.magnitude + before.magnitude + dt * norm(force);
  if (scale > 0)
    worst.momentum = std::max(worst.momentum.value_or(0), std::max(std::abs(made.x), std::abs(made.y)) / scale);
}

/// Work of drive, lid, weight and push, less what the energy grew by, is dissipated; that sum may not fall.
void ConservationBooks::Parts::book_energy(const Sums& before, const Sums& after, const State& from, const State& to,
                                           double dt, const StepBooks& books) {
  const Grains& grains = from.grains;
  const auto on_lid = static_cast<std::uint32_t>(Wall::z_high);
  if (from.search.lid_speed != 0 && std::ranges::find(to.contacts.higher, on_lid) != to.contacts.higher.end()) {
    worst.energy.reset();   // the lid's work on grains is not booked
    exchanged = std::numeric_limits<double>::infinity();
  }
  if (std::isinf(exchanged)) return;
  if (exchanged == 0) {
    exchanged = before.energy;
    for (std::size_t p = 0; p < grains.size(); ++p)   // a bed with less counts as settled
      exchanged += 1e-6 * sphere_volume(grains.diameter[p]) * norm(weight(grains.density[p])) * grains.diameter[p];
  }
  exchanged += dt * (std::abs(books.by_gradient) + std::abs(books.by_lid) + std::abs(books.by_weight));
  dissipated += dt * (books.by_gradient + books.by_lid + books.by_weight) - (after.energy - before.energy);
  most_dissipated = std::max(most_dissipated, dissipated);
  if (exchanged > 0) worst.energy = std::max(worst.energy.value_or(0), (most_dissipated - dissipated) / exchanged);
}

}   // namespace bedload

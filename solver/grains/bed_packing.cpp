// One-way settling in still fluid, and when a bed counts as settled.
#include "solver/grains/bed_packing.hpp"

#include <algorithm>
#include <cmath>

#include "solver/grains/box_walls.hpp"
#include "solver/grains/stragglers.hpp"

namespace bedload {
namespace {

constexpr int fewest_substeps = 50, most_substeps = 200;   // of an interval; the whole bed always takes the fewest
constexpr double settled_energy = 1e-6;                    // mean kinetic energy per grain / (W' d) [-]
constexpr double weight_not_carried = 0.5;   // of a grain's own weight that its contacts may leave unbalanced [-]

// What these cost in packing: docs/physics_grains.md, (G13).
constexpr double highest_restitution = 0.9;   // of collisions while settling: what a thin liquid alone slows rests late
constexpr double slowest_fall = 0.01;         // of sqrt((1 - rho_f/rho) g d): slower than that, speed has no say

// And these: docs/decisions/bed_preparation.md.
constexpr double longest_step = 0.3;        // of the Rayleigh time of the smallest grain
constexpr double straggler_energy = 3e-6;   // of a grain / (W' d) [-] that moves: more than this ...
constexpr double unsteady_energy = 1e-7;    // ... or this, on less contacts than a grain rests on
constexpr int steady_contacts = 3;
constexpr double few = 0.5;   // of all grains: more stragglers are not worth cutting out

/// Submerged weight per mass [m/s2]. The box stands level while a bed is poured and is tilted afterwards, as a flume
/// is: else a slope near the angle of repose would never come to rest.
Vec3 settling_push(const BedScene& scene, double density) {
  return {0, 0, (1 - scene.fluid.density / density) * scene.gravity.z};
}

/// (G13) [1/s].
double drag_rate(const BedScene& scene, double d, double density) {
  const double stokes = 18 * scene.fluid.viscosity * scene.fluid.density / (density * d * d);
  return std::min(stokes, std::sqrt(norm(settling_push(scene, density)) / d) / slowest_fall);
}

/// The longest that contacts bear [s]. Grains softer than "auto" overlap deeper, and the frequency of a contact goes with
/// the sixth root of their stiffness; the fourth is on the safe side, and two square roots are the same bits everywhere.
double settling_step(const BedScene& scene) {
  const GrainProperties& g = scene.grains;
  const double stiff = std::min(1.0, g.young_modulus / automatic_young_modulus(scene, bed_layers(scene)));
  return longest_step * std::sqrt(std::sqrt(stiff)) *
         rayleigh_time(g.diameter * (1 - 2 * g.spread), g.density, g.young_modulus, g.poisson);
}

/// The same bed, with collisions that lose something and steps of its own.
BedScene to_settle(BedScene scene) {
  scene.grains.restitution = std::min(scene.grains.restitution, highest_restitution);
  scene.dem_step = settling_step(scene);
  return scene;
}

}   // namespace

struct BedPacking::Parts {
  explicit Parts(const BedScene& given) : scene(to_settle(given)) {}

  double energy(const Grains&, std::size_t) const;
  double energy(const Grains&) const;
  bool carried(const Grains&, std::size_t) const;
  bool at_rest(const Grains&) const;
  double time_within(const Grains&, std::size_t, double distance) const;
  int find_stragglers(const Grains&, const ContactHistory&);
  Progress move(GrainDynamics&, Grains&, ContactHistory&, int substeps);
  Progress move_all(Grains&, ContactHistory&);
  Progress move_stragglers(Grains&, ContactHistory&, int substeps);

  const BedScene scene;
  GrainDynamics together{scene}, apart{scene};
  Stragglers part;
  std::vector<Vec3> push;
  std::vector<double> relaxation;
  std::vector<std::uint8_t> awake;
};

/// Of translation, per W' d [-]. Nothing slows a grain that spins about the normal of its only contact.
double BedPacking::Parts::energy(const Grains& grains, std::size_t i) const {
  return 0.5 * norm2(grains.velocity[i]) / (norm(settling_push(scene, grains.density[i])) * grains.diameter[i]);
}

/// Kinetic energy of all grains that are not fixed, per sum of their W' d [-].
double BedPacking::Parts::energy(const Grains& grains) const {
  double sum = 0, scale = 0;
  for (std::size_t i = 0; i < grains.size(); ++i) {
    if (grains.fixed[i]) continue;
    const double d = grains.diameter[i];
    const double weight = grains.density[i] * sphere_volume(d) * norm(settling_push(scene, grains.density[i]));
    sum += energy(grains, i) * weight * d, scale += weight * d;
  }
  return scale > 0 ? sum / scale : 0;
}

/// Grains that have just been let go are as slow as settled ones, and so are fine ones that sink at their terminal
/// speed: a settled grain is one whose contacts carry its weight.
bool BedPacking::Parts::carried(const Grains& grains, std::size_t i) const {
  const double mass = grains.density[i] * sphere_volume(grains.diameter[i]);
  const Vec3 weight = mass * settling_push(scene, grains.density[i]);
  return grains.fixed[i] || norm(grains.mean_contact_force[i] + weight) <= weight_not_carried * norm(weight);
}

bool BedPacking::Parts::at_rest(const Grains& grains) const {
  for (std::size_t i = 0; i < grains.size(); ++i)
    if (!carried(grains, i)) return false;
  return energy(grains) < settled_energy;
}

/// How long a grain that falls freely takes at least to go a distance [m]: v t + g' t^2/2 = distance.
double BedPacking::Parts::time_within(const Grains& grains, std::size_t i, double distance) const {
  const double v = norm(grains.velocity[i]), g = norm(settling_push(scene, grains.density[i]));
  return 2 * distance / (v + std::sqrt(v * v + 2 * g * distance));
}

/// For how many sub-steps the few grains that still move may be moved alone without leaving their neighbourhood; 0 if
/// they are not few, or none.
int BedPacking::Parts::find_stragglers(const Grains& grains, const ContactHistory& contacts) {
  std::vector<int> touches(grains.size());
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const bool floor = contacts.higher[k] == static_cast<std::uint32_t>(Wall::z_low);
    touches[contacts.lower[k]] += floor ? steady_contacts : 1;   // a floor carries alone
    if (contacts.higher[k] < grains.size()) ++touches[contacts.higher[k]];
  }
  awake.resize(grains.size());
  double substeps = most_substeps;
  std::size_t count = 0;
  for (std::size_t i = 0; i < grains.size(); ++i) {
    const double slow = touches[i] < steady_contacts ? unsteady_energy : straggler_energy;
    awake[i] = !grains.fixed[i] && (energy(grains, i) > slow || !carried(grains, i));
    if (!awake[i]) continue;
    ++count;
    substeps = std::min(substeps, time_within(grains, i, Stragglers::margin * grains.diameter[i]) / scene.dem_step);
  }
  const bool are_few = count > 0 && static_cast<double>(count) < few * static_cast<double>(grains.size());
  return are_few ? static_cast<int>(substeps) : 0;
}

BedPacking::Progress BedPacking::Parts::move(GrainDynamics& dynamics, Grains& grains, ContactHistory& contacts,
                                             int substeps) {
  push.resize(grains.size()), relaxation.resize(grains.size());
  for (std::size_t i = 0; i < grains.size(); ++i) {
    push[i] = settling_push(scene, grains.density[i]);
    relaxation[i] = drag_rate(scene, grains.diameter[i], grains.density[i]);
  }
  const GrainDrive drive{.push = push, .relaxation = relaxation};
  const GrainHealth health = dynamics.advance(grains, contacts, drive, scene.dem_step, substeps, 0);
  const PeriodicBox box(scene);
  for (Vec3& place : grains.position) place = box.wrapped(place);
  const auto moved = static_cast<std::uint64_t>(std::ranges::count(grains.fixed, 0));
  return {substeps * scene.dem_step, energy(grains), health.deepest_overlap, false,
          moved * static_cast<std::uint64_t>(substeps)};
}

BedPacking::Progress BedPacking::Parts::move_all(Grains& grains, ContactHistory& contacts) {
  Progress progress = move(together, grains, contacts, fewest_substeps);
  progress.settled = at_rest(grains);
  return progress;
}

BedPacking::Progress BedPacking::Parts::move_stragglers(Grains& grains, ContactHistory& contacts, int substeps) {
  Progress progress = move(apart, part.grains, part.contacts, substeps);
  part.put_back(grains, contacts);
  progress.energy = energy(grains);
  return progress;
}

BedPacking::BedPacking(const BedScene& scene) : parts_(std::make_unique<Parts>(scene)) {}
BedPacking::~BedPacking() = default;

// Only the bed as a whole comes to rest: what stragglers leave is judged after an interval of all grains.
BedPacking::Progress BedPacking::advance(Grains& grains, ContactHistory& contacts) {
  Parts& p = *parts_;
  if (p.at_rest(grains)) return p.move_all(grains, contacts);
  const int substeps = p.find_stragglers(grains, contacts);
  if (substeps < fewest_substeps) return p.move_all(grains, contacts);
  p.part.cut_out(p.scene, grains, contacts, p.awake);
  return p.move_stragglers(grains, contacts, substeps);
}

double BedPacking::patience() const {
  const BedScene& scene = parts_->scene;
  const double height = scene.length.z, weight = norm(settling_push(scene, scene.grains.density));
  return 100 * (height * drag_rate(scene, scene.grains.diameter, scene.grains.density) / weight +
                std::sqrt(2 * height / weight));
}

bool needs_settling(const BedScene& scene) {
  const bool loose = scene.source.kind == BedSource::Kind::poured || scene.source.kind == BedSource::Kind::lattice;
  const bool has_floor = scene.sides[2] == Side::wall;
  return loose && scene.source.count > 0 && has_floor && settling_push(scene, scene.grains.density).z != 0;
}

}   // namespace bedload

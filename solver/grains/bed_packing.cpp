// One-way settling in still fluid, and when a bed counts as settled.
#include "solver/grains/bed_packing.hpp"

#include <algorithm>
#include <cmath>

#include "solver/grains/box_walls.hpp"

namespace bedload {
namespace {

constexpr int substeps_per_interval = 50;
constexpr double settled_energy = 1e-6;      // mean kinetic energy per grain / (W' d) [-]
constexpr double weight_not_carried = 0.5;   // of a grain's own weight that its contacts may leave unbalanced [-]

// What both cost in packing: docs/physics_grains.md, (G13).
constexpr double highest_restitution = 0.9;   // of collisions while settling: what a thin liquid alone slows rests late
constexpr double slowest_fall = 0.01;         // of sqrt((1 - rho_f/rho) g d): slower than that, speed has no say

/// The same bed, with collisions that lose something.
BedScene lossy(BedScene scene) {
  scene.grains.restitution = std::min(scene.grains.restitution, highest_restitution);
  return scene;
}

/// Submerged weight per mass [m/s2]. The box stands level while a bed is poured and is tilted afterwards, as a flume
/// is: else a slope near the angle of repose would never come to rest.
Vec3 settling_push(const BedScene& scene, double density) {
  return {0, 0, (1 - scene.fluid.density / density) * scene.gravity.z};
}

}   // namespace

struct BedPacking::Parts {
  explicit Parts(const BedScene& scene_) : scene(scene_), dynamics(lossy(scene_)) {}

  double drag_rate(double diameter, double density) const;
  void set_forces(const Grains&);
  void wrap(Grains&) const;
  Progress judge(const Grains&, const GrainHealth&) const;

  BedScene scene;
  GrainDynamics dynamics;
  std::vector<Vec3> push;
  std::vector<double> relaxation;
};

/// (G13) [1/s].
double BedPacking::Parts::drag_rate(double d, double density) const {
  const double stokes = 18 * scene.fluid.viscosity * scene.fluid.density / (density * d * d);
  return std::min(stokes, std::sqrt(norm(settling_push(scene, density)) / d) / slowest_fall);
}

void BedPacking::Parts::set_forces(const Grains& grains) {
  push.resize(grains.size()), relaxation.resize(grains.size());
  for (std::size_t i = 0; i < grains.size(); ++i) {
    push[i] = settling_push(scene, grains.density[i]);
    relaxation[i] = drag_rate(grains.diameter[i], grains.density[i]);
  }
}

void BedPacking::Parts::wrap(Grains& grains) const {
  const PeriodicBox box(scene);
  for (Vec3& place : grains.position) place = box.wrapped(place);
}

// Grains that have just been let go are as slow as settled ones, and so are fine ones that sink at their terminal
// speed: a settled grain is one whose contacts carry its weight. Energy is that of translation: nothing slows a grain
// that spins about the normal of its only contact.
BedPacking::Progress BedPacking::Parts::judge(const Grains& grains, const GrainHealth& health) const {
  double energy = 0, scale = 0;
  bool carried = true;
  for (std::size_t i = 0; i < grains.size(); ++i) {
    if (grains.fixed[i]) continue;
    const double mass = grains.density[i] * sphere_volume(grains.diameter[i]);
    const Vec3 weight = mass * push[i];
    energy += 0.5 * mass * norm2(grains.velocity[i]);
    scale += norm(weight) * grains.diameter[i];
    carried = carried && norm(grains.mean_contact_force[i] + weight) <= weight_not_carried * norm(weight);
  }
  const double per_weight = scale > 0 ? energy / scale : 0;
  return {substeps_per_interval * scene.dem_step, per_weight, health.deepest_overlap,
          carried && per_weight < settled_energy};
}

BedPacking::BedPacking(const BedScene& scene) : parts_(std::make_unique<Parts>(scene)) {}
BedPacking::~BedPacking() = default;

BedPacking::Progress BedPacking::advance(Grains& grains, ContactHistory& contacts) {
  parts_->set_forces(grains);
  const GrainDrive drive{.push = parts_->push, .relaxation = parts_->relaxation};
  const GrainHealth health =
      parts_->dynamics.advance(grains, contacts, drive, parts_->scene.dem_step, substeps_per_interval, 0);
  parts_->wrap(grains);
  return parts_->judge(grains, health);
}

double BedPacking::patience() const {
  const BedScene& scene = parts_->scene;
  const double height = scene.length.z, weight = norm(settling_push(scene, scene.grains.density));
  return 100 * (height * parts_->drag_rate(scene.grains.diameter, scene.grains.density) / weight +
                std::sqrt(2 * height / weight));
}

bool needs_settling(const BedScene& scene) {
  const bool loose = scene.source.kind == BedSource::Kind::poured || scene.source.kind == BedSource::Kind::lattice;
  const bool has_floor = scene.sides[2] == Side::wall;
  return loose && scene.source.count > 0 && has_floor && settling_push(scene, scene.grains.density).z != 0;
}

}   // namespace bedload

// The sub-steps, and the two scales of time that choose their length.
#include "solver/grains/grain_dynamics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "solver/grains/contact_forces.hpp"
#include "solver/grains/films.hpp"
#include "solver/grains/grain_motion.hpp"
#include "solver/grains/rolling_resistance.hpp"

namespace bedload {

/// Scratch: nothing here outlives a call in meaning. The springs come from and return to the caller's ContactHistory;
/// the list is used again only if it still covers the grains that are handed in.
struct GrainDynamics::Workspace {
  Workspace(const BedScene& scene, ContactTerms terms)
      : rough(scene.grains), smooth(rough.without_friction()), list(scene, wet_law(scene, terms), terms.lubrication) {
    if (terms.lubrication) films.emplace(scene);
    if (scene.grains.rolling_friction > 0) rolling.emplace(scene.grains.rolling_friction);
  }

  void take(const Grains&, const GrainDrive&, double dt);
  void give(Grains&, int substeps) const;
  void prepare_list(ContactHistory&, double dt, bool list_holds_springs);
  Vec3 add_forces(const GrainDrive&, double dt, double lid_speed);
  double deepest_overlap() const;

  const WetRestitution* wet_law(const BedScene& scene, ContactTerms terms) {
    return terms.wet_restitution ? &wet.emplace(scene.fluid, scene.grains.restitution) : nullptr;
  }

  HertzMindlin rough, smooth;
  std::optional<WetRestitution> wet;
  std::optional<Films> films;
  std::optional<RollingResistance> rolling;
  NeighbourList list;
  std::vector<Body> bodies;
  std::vector<Load> loads;
  std::vector<Load> sum_of_loads;
  std::vector<double> damp;
};

void GrainDynamics::Workspace::take(const Grains& grains, const GrainDrive& drive, double dt) {
  const std::size_t n = grains.size();
  bodies.resize(n), damp.resize(n);
  loads.assign(n, {}), sum_of_loads.assign(n, {});
  for (std::size_t i = 0; i < n; ++i) {
    const double mass = grains.density[i] * sphere_volume(grains.diameter[i]);
    const double inertia = drive.added_mass.empty() ? mass : mass + drive.added_mass[i];
    const bool fixed = grains.fixed[i] != 0;
    bodies[i] = {grains.position[i], 0.5 * grains.diameter[i],
                 grains.velocity[i], fixed ? 0 : 1 / inertia,
                 grains.spin[i],     fixed ? 0 : 1 / sphere_inertia(mass, grains.diameter[i])};
    damp[i] = drive.relaxation.empty() ? 1 : 1 / (1 + dt * drive.relaxation[i]);
  }
}

void GrainDynamics::Workspace::give(Grains& grains, int substeps) const {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    grains.mean_contact_force[i] = sum_of_loads[i].force / substeps;
    grains.mean_contact_torque[i] = sum_of_loads[i].torque / substeps;
    if (grains.fixed[i]) continue;
    grains.position[i] = bodies[i].position;
    grains.velocity[i] = bodies[i].velocity;
    grains.spin[i] = bodies[i].spin;
  }
}

void GrainDynamics::Workspace::prepare_list(ContactHistory& history, double dt, bool list_holds_springs) {
  if (list_holds_springs) {
    if (list.still_covers(bodies)) return;
    list.save(history);
  } else if (list.covers(bodies)) {
    list.load(history);
    return;
  }
  list.rebuild(bodies, dt, history);
}

/// The loads of a sub-step, films last: they act on the velocity that all other forces would leave. Returns the force of
/// the grains on the walls [N].
Vec3 GrainDynamics::Workspace::add_forces(const GrainDrive& drive, double dt, double lid_speed) {
  const WetRestitution* const damping = wet ? &*wet : nullptr;
  add_pair_forces(rough, damping, list.box(), bodies, dt, list.pairs, loads);
  Vec3 on_walls =
      add_wall_forces(rough, smooth, damping, list.walls(), bodies, dt, lid_speed, list.wall_contacts, loads);
  if (rolling) add_rolling_torques(*rolling, rough, bodies, dt, list, loads);
  if (films) on_walls += films->add_forces(list, bodies, drive.push, damp, dt, loads);
  return on_walls;
}

double GrainDynamics::Workspace::deepest_overlap() const {
  double deepest = 0;
  for (std::size_t k = 0; k < list.pairs.size(); ++k) {
    const double smaller = std::min(bodies[list.pairs.ids.lower[k]].radius, bodies[list.pairs.ids.higher[k]].radius);
    deepest = std::max(deepest, list.pairs.depth[k] / (2 * smaller));
  }
  for (const WallContact& c : list.wall_contacts) deepest = std::max(deepest, c.depth / (2 * bodies[c.grain].radius));
  return deepest;
}

GrainDynamics::GrainDynamics(const BedScene& scene, ContactTerms terms)
    : work_(std::make_unique<Workspace>(scene, terms)) {}
GrainDynamics::~GrainDynamics() = default;
void GrainDynamics::forget() { work_->list.forget(); }

GrainHealth GrainDynamics::advance(Grains& grains, ContactHistory& contacts, const GrainDrive& drive, double dt,
                                   int substeps, double lid_speed) {
  Workspace& w = *work_;
  GrainHealth health;
  w.take(grains, drive, dt);
  for (int s = 0; s < substeps; ++s) {
    w.prepare_list(contacts, dt, s > 0);
    health.force_on_walls += w.add_forces(drive, dt, lid_speed);
    spin_bodies(w.bodies, drive.spin_push, dt);
    move_bodies(w.bodies, w.loads, drive.push, w.damp, dt, w.sum_of_loads);
  }
  w.list.save(contacts);
  w.give(grains, substeps);
  health.force_on_walls = health.force_on_walls / substeps;
  health.deepest_overlap = w.deepest_overlap();
  health.contacts = contacts.size();
  return health;
}

double rayleigh_time(double diameter, double density, double young_modulus, double poisson) {
  const double shear_modulus = young_modulus / (2 * (1 + poisson));
  return std::numbers::pi * diameter / 2 * std::sqrt(density / shear_modulus) / (0.1631 * poisson + 0.8766);
}

double contact_time(double diameter, double density, double young_modulus, double poisson, double speed) {
  const double mass = density * sphere_volume(diameter) / 2;              // m* of two equal grains
  const double modulus = young_modulus / (2 * (1 - poisson * poisson));   // Y*
  return 2.87 * std::pow(mass * mass / (diameter / 4 * modulus * modulus * speed), 0.2);
}

}   // namespace bedload

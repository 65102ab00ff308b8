// The sub-steps, and the two scales of time that choose their length.
#include "solver/grains/grain_dynamics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "solver/grains/contact_forces.hpp"
#include "solver/grains/films.hpp"
#include "solver/grains/rolling_resistance.hpp"

namespace bedload {

namespace {

/// Rare forces want the loads of all grains.
bool any_rare(const BedScene& scene, ContactTerms terms) {
  return terms.lubrication || scene.grains.rolling_friction > 0;
}

}   // namespace

/// Scratch: nothing here outlives a call in meaning. The springs come from and return to the caller's ContactHistory;
/// the list is used again only if it still covers the grains that are handed in.
struct GrainDynamics::Workspace {
  Workspace(const BedScene& scene, ContactTerms terms, const GrainKernels& of_processor)
      : kernels(of_processor),
        rough(scene.grains),
        smooth(rough.without_friction()),
        list(scene, wet_law(scene, terms), terms.lubrication, any_rare(scene, terms) ? 0 : grains_at_once) {
    if (terms.lubrication) films.emplace(scene);
    if (scene.grains.rolling_friction > 0) rolling.emplace(scene.grains.rolling_friction);
  }

  void take(const Grains&, const GrainDrive&, double dt);
  void give(Grains&, int substeps) const;
  void prepare_list(ContactHistory&, double dt, bool list_holds_springs);
  Vec3 advance(const GrainDrive&, double dt, double lid_speed, bool first_substep);
  Vec3 add_rare_forces(double dt, std::span<Load>);
  double deepest_overlap() const;

  const WetRestitution* wet_law(const BedScene& scene, ContactTerms terms) {
    return terms.wet_restitution ? &wet.emplace(scene.fluid, scene.grains.restitution) : nullptr;
  }

  const GrainKernels& kernels;
  HertzMindlin rough, smooth;
  std::optional<WetRestitution> wet;
  std::optional<Films> films;
  std::optional<RollingResistance> rolling;
  NeighbourList list;
  Bodies bodies;
  std::vector<Push> push;
  std::vector<Load> loads;
  std::vector<LoadSum> sums;
};

void GrainDynamics::Workspace::take(const Grains& grains, const GrainDrive& drive, double dt) {
  const std::size_t n = grains.size();
  bodies.spheres.resize(n), bodies.motions.resize(n), push.resize(n);
  sums.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double mass = grains.density[i] * sphere_volume(grains.diameter[i]);
    const double inertia = drive.added_mass.empty() ? mass : mass + drive.added_mass[i];
    const bool fixed = grains.fixed[i] != 0;
    bodies.spheres[i] = sphere_of(grains.position[i], 0.5 * grains.diameter[i], grains.velocity[i], grains.spin[i]);
    bodies.motions[i] = {grains.velocity[i], fixed ? 0 : 1 / inertia, grains.spin[i],
                         fixed ? 0 : 1 / sphere_inertia(mass, grains.diameter[i])};
    push[i] = {drive.push[i], drive.relaxation.empty() ? 1 : 1 / (1 + dt * drive.relaxation[i])};
  }
}

void GrainDynamics::Workspace::give(Grains& grains, int substeps) const {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (grains.fixed[i] == frozen) continue;   // its other contacts sleep: what they bear is not in the sum
    grains.mean_contact_force[i] = sums[i].force / substeps;
    grains.mean_contact_torque[i] = sums[i].torque / substeps;
    if (grains.fixed[i]) continue;
    grains.position[i] = bodies.spheres[i].position;
    grains.velocity[i] = bodies.motions[i].velocity;
    grains.spin[i] = bodies.motions[i].spin;
  }
}

void GrainDynamics::Workspace::prepare_list(ContactHistory& history, double dt, bool list_holds_springs) {
  if (list_holds_springs) {
    if (list.still_covers(bodies)) return;
    list.save(history);
  } else if (list.covers(bodies)) {
    list.recall(history);
    return;
  }
  list.rebuild(bodies, dt, history);
}

/// Torques and forces that few scenes have, films last: they act on the velocity that all other forces would leave.
/// Returns the force of the grains on the walls [N].
Vec3 GrainDynamics::Workspace::add_rare_forces(double dt, std::span<Load> of) {
  if (rolling) add_rolling_torques(*rolling, rough, bodies, dt, list, of);
  return films ? films->add_forces(list, bodies, push, dt, of) : Vec3{};
}

/// One sub-step. All pairs of a grain have a lower id no higher than its own: once those are met, nothing asks for the grain
/// any more, and it may move. Returns the force of the grains on the walls [N].
Vec3 GrainDynamics::Workspace::advance(const GrainDrive& drive, double dt, double lid_speed, bool first_substep) {
  const std::size_t n = bodies.size();
  const bool rare = rolling || films;
  const std::size_t at_once = rare ? n : std::min(n, grains_at_once);
  loads.resize(at_once);
  Vec3 on_walls = meet_walls(rough, smooth, wet ? &*wet : nullptr, bodies, dt, lid_speed, list);
  PairWave wave(kernels, pair_pass(rough, wet ? &*wet : nullptr, bodies, dt, list), list);
  SumPass sum = sum_pass(bodies, list);
  const MotionPass motion{bodies.spheres.data(),
                          bodies.motions.data(),
                          push.data(),
                          drive.spin_push.empty() ? nullptr : drive.spin_push.data(),
                          list.inverse_skins().data(),
                          sums.data(),
                          first_substep,
                          dt};
  double fastest = 0;
  for (std::size_t first = 0; first < n; first += at_once) {
    const std::size_t last = std::min(n, first + at_once);
    wave.meet_below(last);
    kernels.add_up(sum, first, last, loads.data());
    if (rare) on_walls += add_rare_forces(dt, loads);
    fastest = std::max(fastest, kernels.move(motion, first, last, loads.data()));
  }
  list.note_speed(std::sqrt(fastest), dt);
  return on_walls;
}

double GrainDynamics::Workspace::deepest_overlap() const {
  // The overlap per r_i + r_j times this is no less than the overlap per diameter of the smaller: few pairs need more.
  const double most_unlike = list.most_unlike_radii();
  double deepest = 0;
  for (const PairBlock& b : list.pairs.blocks) {
    int deeper = 0;   // counted, which takes the compiler no order
    for (std::size_t k = 0; k < PairBlock::pairs; ++k)
      deeper += b.depth[k] * b.inverse_radius_sum[k] * most_unlike > deepest;
    if (deeper == 0) continue;
    for (std::size_t k = 0; k < PairBlock::pairs; ++k) {
      if (!(b.depth[k] > 0)) continue;
      const double smaller = std::min(bodies.spheres[b.lower[k]].radius, bodies.spheres[b.higher[k]].radius);
      deepest = std::max(deepest, b.depth[k] / (2 * smaller));
    }
  }
  for (const WallContact& c : list.wall_contacts)
    deepest = std::max(deepest, c.depth / (2 * bodies.spheres[c.grain].radius));
  return deepest;
}

GrainDynamics::GrainDynamics(const BedScene& scene, ContactTerms terms, const GrainKernels& kernels)
    : work_(std::make_unique<Workspace>(scene, terms, kernels)) {}
GrainDynamics::~GrainDynamics() = default;
void GrainDynamics::forget() { work_->list.forget(); }

GrainHealth GrainDynamics::advance(Grains& grains, ContactHistory& contacts, const GrainDrive& drive, double dt,
                                   int substeps, double lid_speed) {
  Workspace& w = *work_;
  GrainHealth health;
  w.take(grains, drive, dt);
  for (int s = 0; s < substeps; ++s) {
    w.prepare_list(contacts, dt, s > 0);
    health.force_on_walls += w.advance(drive, dt, lid_speed, s == 0);
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

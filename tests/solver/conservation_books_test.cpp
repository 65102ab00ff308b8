// Books that could not fail would prove nothing: every one is shown states that balance and states that do not.
#include "solver/conservation_books.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "solver/fluid/face_loops.hpp"
#include "tests/support/scenes.hpp"

namespace bedload::test {
namespace {

constexpr double d = 1e-3, gravity = 9.81, dt = 1e-3;
constexpr Vec3 middle{8e-3, 8e-3, 8e-3};

Scene channel_scene() {
  Scene scene = fluid_scene({8, 8, 8}, {2 * d, 2 * d, 2 * d}, channel, 1e-6);
  scene.bed.gravity = {0, 0, -gravity};
  add_grains(scene, d, 2.65, 0.1);
  return scene;
}

State resting(const Scene& scene, const std::vector<Vec3>& places = {middle}) {
  State state = state_of(scene, places, false);
  state.search.hold_begun = 1;
  return state;
}

double mass_of(const Scene& scene) { return scene.bed.grains.density * sphere_volume(d); }

Books books_of(const Scene& scene, const State& before, const State& after, const StepBooks& step = {}) {
  ConservationBooks books(scene);
  StepHealth health;
  health.dt = dt, health.substeps = 1;
  books.add(before, after, health, step);
  return books.worst();
}

void set_fluid(const Scene& scene, double u, State& state) {
  for_each_unknown_face(scene.grid, 0, [&](std::size_t n) { state.fluid.velocity.x[n] = u; });
}

TEST(EnergyBook, LetsAGrainHaveWhatItsSubmergedWeightGivesAndNoMore) {
  for (const bool added_mass : {false, true}) {
    Scene scene = channel_scene();
    scene.terms.added_mass = added_mass;
    const double rho = scene.bed.fluid.density, volume = sphere_volume(d), fall = 0.3 * d;
    const double work = (scene.bed.grains.density - rho) * volume * gravity * fall;
    const double inertia =
        mass_of(scene) + (added_mass ? 0.5 * rho * volume : 0);   // half the displaced liquid goes along
    const State before = resting(scene);
    StepBooks step;
    step.by_weight = work / dt;
    for (const double surplus : {0.0, 0.5}) {
      State after = before;
      after.grains.position[0].z -= fall;
      after.grains.velocity[0].z = -std::sqrt(2 * work * (1 + surplus) / inertia);
      EXPECT_NEAR(*books_of(scene, before, after, step).energy, surplus, 1e-5) << added_mass;
    }
  }
}

TEST(EnergyBook, LetsASpringGiveBackItsEnergyAndNoMore) {
  // Hertz: 2/5 F delta with F = 4/3 Y* sqrt(R*) delta^(3/2); Mindlin: S_t xi^2/2 with S_t = 8 G* sqrt(R* delta); rolling:
  // R*^2 S_t psi^2/2. Pairs also across the seam, walls low and high.
  Scene scene = channel_scene();
  scene.bed.gravity = {};
  const GrainProperties& g = scene.bed.grains;
  const double depth = 0.01 * d, xi = 0.004 * d, psi = 0.02;
  const double young =
      g.young_modulus / (2 * (1 - g.poisson * g.poisson));   // Y*: grains and walls are of one material
  const double shear = g.young_modulus / (4 * (1 + g.poisson) * (2 - g.poisson));   // G*
  struct Touching {
    std::vector<Vec3> places;
    std::uint32_t partner;
    double radius;   // R*
  };
  const double side = scene.bed.length.x;
  const auto wall = [](Wall name) { return static_cast<std::uint32_t>(name); };
  for (const Touching& contact : {Touching{{middle, middle + Vec3{d - depth, 0, 0}}, 1, d / 4},
                                  Touching{{{d / 4, 8 * d, 8 * d}, {side - 3 * d / 4 + depth, 8 * d, 8 * d}}, 1, d / 4},
                                  Touching{{{8 * d, 8 * d, d / 2 - depth}}, wall(Wall::z_low), d / 2},
                                  Touching{{{8 * d, 8 * d, side - d / 2 + depth}}, wall(Wall::z_high), d / 2}}) {
    const double radius = contact.radius;
    const double force = 4.0 / 3 * young * std::sqrt(radius) * std::pow(depth, 1.5);
    const double stiffness = 8 * shear * std::sqrt(radius * depth);
    const double sheared = stiffness * xi * xi / 2, rolled = radius * radius * stiffness * psi * psi / 2;
    const double energy = 2.0 / 5 * force * depth + sheared + rolled;
    ASSERT_GT(rolled, 0.01 * energy);
    State before = resting(scene, contact.places);
    before.contacts.lower = {0};
    before.contacts.higher = {contact.partner};
    before.contacts.spring = {{0, xi, 0}};
    before.contacts.rolling = {{0, psi, 0}};
    for (const double surplus : {0.0, 0.2}) {
      State after = before;
      after.contacts = {};
      after.grains.velocity[0].y = std::sqrt(2 * energy * (1 + surplus) / mass_of(scene));
      EXPECT_NEAR(*books_of(scene, before, after).energy, surplus, 1e-9) << contact.partner;
    }
  }
}

TEST(EnergyBook, CountsTheWorkOfLidGradientAndWeight) {
  Scene scene = channel_scene();
  scene.bed.gravity = {};
  const Vec3 box = scene.grid.length();
  const double mass = scene.bed.fluid.density * box.x * box.y * box.z, u = 0.1;
  const State before = resting(scene, {});
  for (const auto work : {&StepBooks::by_lid, &StepBooks::by_gradient, &StepBooks::by_weight})
    for (const double surplus : {0.0, 0.5}) {
      StepBooks step;
      step.*work = mass * u * u / 2 / dt;   // energy of the flow that is driven
      State after = before;
      set_fluid(scene, u * std::sqrt(1 + surplus), after);
      EXPECT_NEAR(*books_of(scene, before, after, step).energy, surplus, 1e-9);
    }
}

TEST(MomentumBook, BalancesEveryForceAndMissesNone) {
  Scene scene = channel_scene();
  scene.bed.gravity = {0.5, 0, -gravity};
  const double rho = scene.bed.fluid.density, volume = sphere_volume(d);
  const Vec3 box = scene.grid.length();
  const double fluid_mass = rho * (box.x * box.y * box.z - volume);
  const double weight = (scene.bed.grains.density - rho) * volume * norm(scene.bed.gravity), push = 0.2;
  const double down_slope = (scene.bed.grains.density - rho) * volume * scene.bed.gravity.x;
  struct Case {
    Vec3 StepBooks::*force;
    double sign;
  };
  for (const auto [force, sign] : {Case{&StepBooks::driving, 1}, Case{&StepBooks::on_bottom, -1},
                                   Case{&StepBooks::on_lid, -1}, Case{&StepBooks::contact_on_walls, -1}}) {
    const double strength = 0.7 * weight;
    StepBooks step;
    (step.*force).x = strength;
    State before = resting(scene), after = before;
    before.search.push = push;
    after.grains.velocity[0].x = dt * (down_slope + push * weight) / mass_of(scene);
    set_fluid(scene, sign * dt * strength / fluid_mass, after);
    EXPECT_LE(*books_of(scene, before, after, step).momentum, 1e-13);
    set_fluid(scene, 0, after);   // and what the force should have done is missing
    EXPECT_GT(*books_of(scene, before, after, step).momentum, 0.1);
    set_fluid(scene, sign * dt * strength / fluid_mass, after);
    after.grains.velocity[0].x = 0;   // weight and push without effect
    EXPECT_GT(*books_of(scene, before, after, step).momentum, 0.05);
  }
}

TEST(GrainBook, SeesAGrainThatChangesOrLeavesTheBox) {
  const Scene scene = channel_scene();
  const State before = resting(scene);
  EXPECT_TRUE(books_of(scene, before, before).grains_unchanged);
  State outside = before;
  outside.grains.position[0].z = -0.1 * d;
  EXPECT_FALSE(books_of(scene, before, outside).grains_unchanged);

  ConservationBooks books(scene);   // sizes are compared with those of the first step
  State larger = before;
  larger.grains.diameter[0] *= 1.001;
  books.add(before, before, {}, {});
  books.add(before, larger, {}, {});
  EXPECT_FALSE(books.worst().grains_unchanged);
}

}   // namespace
}   // namespace bedload::test

// Energy of fluid and grains: nothing but what drives them may raise it.
#include <gtest/gtest.h>

#include <algorithm>

#include "solver/coupler.hpp"
#include "solver/coupling/drag_laws.hpp"
#include "solver/fluid/face_loops.hpp"
#include "tests/support/scenes.hpp"

namespace bedload::test {
namespace {

Terms model_b() {
  Terms terms;
  terms.pressure_gradient = terms.viscous_stress = false;
  return terms;
}
Terms with_everything_implicit() {
  Terms terms;
  terms.added_mass = terms.viscous_torque = true;
  return terms;
}

struct EnergyCase {
  double density_ratio, viscosity;
  Terms terms{};
  friend void PrintTo(const EnergyCase& c, std::ostream* out) {
    *out << "density ratio " << c.density_ratio << ", viscosity " << c.viscosity << ", Model "
         << (c.terms.model_b() ? "B" : "A") << (c.terms.added_mass ? ", added mass, torque" : "");
  }
};
class Driven : public testing::TestWithParam<EnergyCase> {};
INSTANTIATE_TEST_SUITE_P(Energy, Driven,
                         testing::Values(EnergyCase{1.05, 1e-5}, EnergyCase{2.65, 1e-5},
                                         EnergyCase{2.65, 1e-5, model_b()},
                                         EnergyCase{1.01, 1e-5, with_everything_implicit()},
                                         EnergyCase{2.65, 1e-5, with_everything_implicit()},
                                         EnergyCase{2.65, 1e-3, with_everything_implicit()}));

TEST(Work, OfTheGradientIsWhatAPlugOfFluidGains) {
  Scene scene = fluid_scene({4, 4, 4}, {1e-3, 1e-3, 1e-3}, periodic_box, 1e-6);
  State state = state_of(scene, {}, true);
  state.search.gradient = 3;
  std::ranges::fill(state.fluid.velocity.x.values, 0.1);
  Coupler coupler(scene);
  const double before = kinetic_energy(scene, state);
  const double dt = coupler.step(state, 1e-3).dt;
  const double gained = kinetic_energy(scene, state) - before;
  ASSERT_GT(gained, 0.02 * before);
  EXPECT_NEAR(coupler.books().by_gradient * dt / gained, 1, 1e-9);
  EXPECT_EQ(coupler.books().by_lid, 0);
  EXPECT_EQ(coupler.books().by_weight, 0);
}

TEST(Work, OfTheLidIsViscosityTimesTheShearSquared) {
  const double nu = 1e-4, rate = 10;
  Scene scene = fluid_scene({4, 4, 8}, {1e-3, 1e-3, 5e-4}, channel, nu);
  State state = state_of(scene, {}, true);
  const Vec3 box = scene.grid.length();
  state.search.lid_speed = rate * box.z;
  for_each_unknown_face(scene.grid, 0, [&](std::size_t n) {
    const auto k = static_cast<std::ptrdiff_t>(n) % scene.grid.stride(1) - StaggeredGrid::ghosts;
    state.fluid.velocity.x[n] = rate * (static_cast<double>(k) + 0.5) * scene.grid.h.z;
  });
  Coupler coupler(scene);
  coupler.step(state, 1e-4);
  EXPECT_NEAR(coupler.books().by_lid / (1000 * nu * rate * rate * box.x * box.y * box.z), 1, 1e-9);
  EXPECT_EQ(coupler.books().by_gradient, 0);
}

TEST(Work, OnGrainsIsTheirSubmergedWeightPushAndGradientTimesTheirWay) {
  const double d = 1e-3, push = 0.3, gradient = 2;
  for (const bool whole : {false, true}) {   // in Model B the fluid alone is driven
    Scene scene = fluid_scene({4, 4, 6}, {2 * d, 2 * d, 2 * d}, channel, 1e-5);
    scene.bed.gravity = {0.5, 0, -9.81};
    if (whole) scene.terms = model_b();
    add_grains(scene, d, 2.65, 0.05);
    // One across the seam.
    State state = state_of(scene, {{8 * d - 1e-9, 4 * d, 6 * d}, {4 * d, 4 * d, 6 * d}}, false);
    state.grains.velocity = {{0.02, 0, 0}, {0, 0.01, -0.01}};
    state.search.push = push;
    const auto after_step = [&](double asked, State& after) {
      after = state;
      after.search.gradient = asked;
      Coupler coupler(scene);
      const double dt = coupler.step(after, scene.steps.fluid_interval).dt;
      EXPECT_NEAR(dt, scene.steps.fluid_interval, 1e-9 * dt);
      return coupler.books();
    };
    State still, driven;
    const StepBooks without = after_step(0, still), with = after_step(gradient, driven);
    const double volume = sphere_volume(d), submerged = 1650 * volume, dt = scene.steps.fluid_interval;
    Vec3 way;
    for (int p = 0; p < 2; ++p) way += driven.grains.position[p] - state.grains.position[p];
    way.x += 8 * d;
    ASSERT_GT(way.x, 0);
    const double weight = submerged * (dot(scene.bed.gravity, way) + push * norm(scene.bed.gravity) * way.x);
    EXPECT_NEAR(with.by_weight * dt / weight, 1, 1e-9) << whole;
    EXPECT_EQ(without.by_gradient, 0);

    // Of the gradient: on the mean of the volume flux before and after.
    const auto flux = [&](const State& s) {
      double sum = 0;
      const FaceFields eps = face_void_fraction(scene, s);
      for_each_unknown_face(scene.grid, 0,
                            [&](std::size_t n) { sum += (whole ? 1 : eps.x[n]) * s.fluid.velocity.x[n]; });
      sum *= scene.grid.cell_volume();
      for (const Vec3& v : s.grains.velocity) sum += whole ? 0 : volume * v.x;
      return sum;
    };
    EXPECT_NEAR(with.by_gradient / (1000 * gradient * (flux(state) + flux(driven)) / 2), 1, 0.01) << whole;
  }
}

TEST_P(Driven, SuspensionGainsNoMoreThanItsDriveGives) {
  // Grains that do not touch settle under a gradient, with and without a lid: kinetic energy against the work of what drives.
  const double d = 1e-3;
  Scene scene = fluid_scene({4, 4, 6}, {2 * d, 2 * d, 2 * d}, channel, GetParam().viscosity);
  scene.bed.gravity = {0.5, 0, -9.81};
  scene.terms = GetParam().terms;
  add_grains(scene, d, GetParam().density_ratio, 0.05);
  for (const double lid_speed : {0.0, 0.02}) {
    State state = state_of(scene, cubic_places({5, 5, 4}, {}, {8 * d, 8 * d, 12 * d}, 0.1 * d, 3), false);
    state.search.lid_speed = lid_speed, state.search.gradient = 0.3;
    Coupler coupler(scene);
    double work = 0, lost = 0;
    for (int i = 0; i < 100; ++i) {
      const StepHealth health = coupler.step(state, 0.2 * scene.steps.fluid_interval);
      ASSERT_TRUE(health.finite && !health.lost_grain);
      ASSERT_EQ(health.deepest_overlap, 0);
      EXPECT_GE(coupler.books().exchange_loss, 0);
      const StepBooks& books = coupler.books();
      work += (books.by_lid + books.by_gradient + books.by_weight) * health.dt;
      lost += coupler.books().exchange_loss * health.dt;
      const double energy = kinetic_energy(scene, state);
      EXPECT_LT(energy, work + 0.01 * lost) << i;
      if (lid_speed == 0) {
        EXPECT_GT(energy + lost, 0.3 * work) << i;   // viscosity takes the rest
      }
    }
    if (lid_speed == 0) RecordProperty("booked", std::to_string((kinetic_energy(scene, state) + lost) / work));
  }
}

}   // namespace
}   // namespace bedload::test

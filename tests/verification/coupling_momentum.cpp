// Momentum of fluid and grains together: nothing but walls and weight may change it.
#include <gtest/gtest.h>

#include <random>

#include "solver/coupler.hpp"
#include "solver/fluid/face_loops.hpp"
#include "tests/support/scenes.hpp"

namespace bedload::test {
namespace {

double sum_of_sizes(const State& state) {
  double sum = 0;
  for (std::size_t p = 0; p < state.grains.size(); ++p)
    sum += state.grains.density[p] * sphere_volume(state.grains.diameter[p]) * norm(state.grains.velocity[p]);
  return sum;
}

const Terms model_b{true, true, false, false};

Terms with_added_mass(Terms terms = {}) {
  terms.added_mass = true;
  return terms;
}

Terms with_torque(Terms terms = {}) {
  terms.viscous_torque = true;
  return terms;
}

constexpr Smoothing wide{.xy = 1.8e-3, .z = 0.9e-3};

/// Magnus, and the terms that look at shear.
Terms with_lateral(Terms terms = {}) {
  terms.magnus = terms.shear_lift = terms.exposure = true;
  return terms;
}

struct MomentumCase {
  double density_ratio;
  Terms terms{};
  Smoothing smoothing{};
  friend void PrintTo(const MomentumCase& c, std::ostream* out) {
    *out << "density ratio " << c.density_ratio << ", Model " << (c.terms.model_b() ? "B" : "A")
         << (c.terms.added_mass ? ", added mass" : "") << (c.terms.viscous_torque ? ", viscous torque" : "")
         << (c.terms.magnus ? ", lift, Magnus, exposure" : "") << (c.smoothing == Smoothing{} ? "" : ", smoothed");
  }
};
class PeriodicSuspension : public testing::TestWithParam<MomentumCase> {};
INSTANTIATE_TEST_SUITE_P(
    Momentum, PeriodicSuspension,
    testing::Values(MomentumCase{1.05}, MomentumCase{2.65}, MomentumCase{2.65, model_b},
                    MomentumCase{1.01, with_added_mass()}, MomentumCase{1.05, with_added_mass()},
                    MomentumCase{2.65, with_added_mass()}, MomentumCase{1.01, with_added_mass(model_b)},
                    MomentumCase{2.65, with_added_mass(model_b)}, MomentumCase{1.05, with_torque(with_added_mass())},
                    MomentumCase{2.65, with_torque(model_b)}, MomentumCase{2.65, with_lateral()},
                    MomentumCase{2.65, {}, wide}, MomentumCase{1.01, with_torque(with_added_mass()), wide},
                    MomentumCase{2.65, with_torque(model_b), wide}));

TEST_P(PeriodicSuspension, KeepsItWhileGrainsMoveAndCollide) {
  const double d = 1e-3;
  Scene scene = fluid_scene({4, 4, 8}, {2 * d, 2 * d, d}, periodic_box, 1e-6);
  scene.terms = GetParam().terms;
  scene.smoothing = GetParam().smoothing;
  add_grains(scene, d, GetParam().density_ratio, 0.1);
  State state = state_of(scene, cubic_places({7, 7, 7}, {}, scene.grid.length(), 0.05 * d, 5), false);
  std::mt19937 random(9);
  for (Vec3& v : state.grains.velocity)
    for (int c = 0; c < 3; ++c) v[c] = 0.1 * (2.0 * random() / std::mt19937::max() - 1);
  for (std::size_t n = 0; n < state.fluid.velocity.x.values.size(); ++n) state.fluid.velocity.x[n] = 0.02;
  Coupler coupler(scene);
  const Vec3 start = total_momentum(scene, state);
  const double scale = sum_of_sizes(state);
  std::size_t contacts = 0;
  for (int i = 0; i < 200; ++i) {
    EXPECT_TRUE(coupler.step(state, scene.steps.fluid_interval).finite);
    contacts += state.contacts.size();
  }
  EXPECT_GT(contacts, 1000u);   // they did collide
  EXPECT_LT(norm(total_momentum(scene, state) - start) / scale, 1e-10);
}

struct BooksCase {
  Terms terms{};
  double viscosity = 1e-6;
  Smoothing smoothing{};
  friend void PrintTo(const BooksCase& c, std::ostream* out) {
    *out << "viscosity " << c.viscosity << ", Model " << (c.terms.model_b() ? "B" : "A")
         << (c.terms.added_mass ? ", added mass" : "") << (c.terms.viscous_torque ? ", viscous torque" : "")
         << (c.terms.magnus ? ", lift, Magnus, exposure" : "") << (c.smoothing == Smoothing{} ? "" : ", smoothed");
  }
};
class ShearedMixture : public testing::TestWithParam<BooksCase> {};
INSTANTIATE_TEST_SUITE_P(Momentum, ShearedMixture,
                         testing::Values(BooksCase{}, BooksCase{model_b}, BooksCase{{}, 1e-2},
                                         BooksCase{model_b, 1e-2},   // 1e-2: implicit
                                         BooksCase{with_added_mass()}, BooksCase{with_added_mass(model_b)},
                                         BooksCase{with_added_mass(), 1e-2}, BooksCase{with_torque()},
                                         BooksCase{with_torque(with_added_mass(model_b))},
                                         BooksCase{with_torque(), 1e-2}, BooksCase{with_lateral()},
                                         BooksCase{with_lateral(model_b)}, BooksCase{{}, 1e-6, wide},
                                         BooksCase{with_torque(with_added_mass()), 1e-2, wide},
                                         BooksCase{with_torque(model_b), 1e-6, wide}));

TEST_P(ShearedMixture, IsBookedCompletelyAlongTheFlow) {
  // A tilted channel with a lid and a gradient; fixed and free grains of two sizes and densities. What the fluid gains is
  // what drives it, less the forces on walls and grains.
  const double d = 1e-3;
  Scene scene = fluid_scene({4, 4, 12}, {2 * d, 2 * d, d}, channel, GetParam().viscosity);
  scene.bed.gravity = {1.0, 0, -9.7};
  scene.terms = GetParam().terms;
  scene.smoothing = GetParam().smoothing;
  add_grains(scene, d, 2.65, 0.1);
  State state = state_of(scene, cubic_places({7, 7, 7}, {}, {8 * d, 8 * d, 7.5 * d}, 0.05 * d, 6), false);
  for (std::size_t p = 0; p < state.grains.size(); ++p) {
    state.grains.fixed[p] = state.grains.position[p].z < 2 * d;
    if (p % 3 == 0) state.grains.density[p] = 1500, state.grains.diameter[p] *= 0.9;
  }
  state.search.lid_speed = 0.3;
  state.search.gradient = 0.5;
  Coupler coupler(scene);
  for (int i = 0; i < 100; ++i) {
    const double before = fluid_momentum(scene, state).x;
    const StepHealth health = coupler.step(state, scene.steps.fluid_interval);
    ASSERT_TRUE(health.finite && !health.lost_grain);
    const StepBooks& books = coupler.books();
    const double booked = books.driving.x - books.on_bottom.x - books.on_lid.x - books.on_grains.x;
    const double scale = std::abs(books.driving.x) + std::abs(books.on_lid.x) + std::abs(books.on_grains.x) +
                         std::abs(before) / health.dt;
    EXPECT_NEAR((fluid_momentum(scene, state).x - before) / health.dt / scale, booked / scale, 1e-12);
  }
}

/// A flat layer on the bottom whose faces would hold more solid than fits, below a sheared liquid.
class OverfilledLayer : public testing::TestWithParam<Terms> {};
INSTANTIATE_TEST_SUITE_P(Momentum, OverfilledLayer,
                         testing::Values(Terms{}, model_b, with_added_mass(), with_torque(with_added_mass())));

TEST_P(OverfilledLayer, IsBookedAndKeepsTheFlowWithinWhatDrivesIt) {
  const double d = 1e-3, lid = 0.05;
  Scene scene = fluid_scene({4, 4, 12}, {2 * d, 2 * d, 0.5 * d}, channel, 1e-5);
  scene.bed.gravity = {0.5, 0, -9.8};
  scene.bed.grains.friction = 0;
  scene.terms = GetParam();
  add_grains(scene, d, 2.65, 0.1);
  State state =
      state_of(scene, cubic_places({8, 8, 1}, {0, 0, 0.49 * d}, {8 * d, 8 * d, 0.51 * d}, 0.005 * d, 6), false);
  state.search.lid_speed = lid;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      for (int k = 0; k < 12; ++k)
        state.fluid.velocity.x[scene.grid.index(i, j, k)] = lid * std::max(0.0, (k + 0.5) / 12 * 1.2 - 0.2);
  const FaceFields eps = bedload::test::face_void_fraction(scene, state);
  EXPECT_EQ(eps.z[scene.grid.index(1, 1, 1)], 0.2);
  Coupler coupler(scene);
  const double start = total_momentum(scene, state).x;
  double given = 0, handled = 0, fastest = 0;
  for (int i = 0; i < 300; ++i) {
    const StepHealth health = coupler.step(state, scene.steps.fluid_interval);
    ASSERT_TRUE(health.finite && !health.lost_grain) << i;
    const StepBooks& books = coupler.books();
    double force = books.driving.x - books.on_bottom.x - books.on_lid.x - books.contact_on_walls.x;
    for (std::size_t p = 0; p < state.grains.size(); ++p)
      force += (state.grains.density[p] - 1000) * sphere_volume(d) * scene.bed.gravity.x;
    given += force * health.dt, handled += std::abs(force) * health.dt;
    for (int c = 0; c < 3; ++c)
      for_each_unknown_face(scene.grid, c, [&, u = state.fluid.velocity.component(c)](std::size_t n) {
        fastest = std::max(fastest, std::abs(u[n]));
      });
  }
  EXPECT_NEAR(total_momentum(scene, state).x - start, given, 1e-10 * (handled + std::abs(start)));
  EXPECT_LT(fastest, 1.5 * lid);   // grains roll down a slope of 3 degrees; nothing is faster than the lid
}

}   // namespace
}   // namespace bedload::test

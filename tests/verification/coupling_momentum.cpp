// Momentum of fluid and grains together: nothing but walls and weight may change it.
#include <gtest/gtest.h>

#include <random>

#include "solver/coupler.hpp"
#include "tests/support/scenes.hpp"

namespace bedload::test {
namespace {

double sum_of_sizes(const State& state) {
  double sum = 0;
  for (std::size_t p = 0; p < state.grains.size(); ++p)
    sum += state.grains.density[p] * sphere_volume(state.grains.diameter[p]) * norm(state.grains.velocity[p]);
  return sum;
}

class PeriodicSuspension : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Momentum, PeriodicSuspension, testing::Values(1.05, 2.65));

TEST_P(PeriodicSuspension, KeepsItWhileGrainsMoveAndCollide) {
  const double d = 1e-3;
  Scene scene = fluid_scene({4, 4, 8}, {2 * d, 2 * d, d}, periodic_box, 1e-6);
  add_grains(scene, d, GetParam(), 0.1);
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

}  // namespace
}  // namespace bedload::test

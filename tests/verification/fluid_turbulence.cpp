// Turbulent flow through the whole coupled step: log layers, the laminar limit, the books.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "solver/coupler.hpp"
#include "tests/support/scenes.hpp"

namespace bedload::test {
namespace {

constexpr double depth = 0.05, friction_speed = 0.05, viscosity = 1e-6;   // a flume: Re_tau 2500

/// A film under a gradient that puts `friction_speed` on its bottom, in cells as wide as it is deep.
Scene film_scene(double roughness, int layers) {
  Scene scene = fluid_scene({3, 3, layers}, {depth, depth, depth / layers}, channel, viscosity);
  scene.grid.top = scene.bed.top = Top::free_slip;
  scene.terms.turbulence = true;
  scene.bottom_roughness = roughness;
  return scene;
}

State run(Coupler& coupler, const Scene& scene, double duration, double longest) {
  State state = state_of(scene, {}, false);
  state.search.gradient = friction_speed * friction_speed / depth;
  while (state.clock.time < duration) {
    const StepHealth health = coupler.step(state, longest);
    EXPECT_TRUE(health.finite && health.converged);
  }
  return state;
}

struct LogLayer {
  const char* name;
  double roughness;
  double at(double z) const {   // u/u*
    if (roughness > 0) return std::log(30 * z / roughness) / 0.41;
    return std::log(z * friction_speed / viscosity) / 0.41 + 5.2;
  }
  friend void PrintTo(const LogLayer& l, std::ostream* out) { *out << l.name; }
};
class TurbulentFilm : public testing::TestWithParam<LogLayer> {};
INSTANTIATE_TEST_SUITE_P(Fluid, TurbulentFilm, testing::Values(LogLayer{"smooth", 0}, LogLayer{"rough", 1e-3}));

TEST_P(TurbulentFilm, HasALogLayerAndItsBottomBearsTheGradient) {
  const Scene scene = film_scene(GetParam().roughness, 20);
  Coupler coupler(scene);
  const State state = run(coupler, scene, 150, 0.05);
  for (int k = 4; k < 16; ++k) {   // z/H 0.2 to 0.8
    const double expected = GetParam().at((k + 0.5) * scene.grid.h.z);
    EXPECT_NEAR(state.fluid.velocity.x[scene.grid.index(0, 0, k)] / friction_speed, expected, 0.03 * expected) << k;
  }
  EXPECT_NEAR(coupler.books().on_bottom.x, coupler.books().driving.x, 1e-3 * coupler.books().driving.x);
}

TEST(Turbulence, IsTheSameFlowWhetherItsStressIsImplicitOrNot) {
  const Scene scene = film_scene(1e-3, 10);
  double top[2];
  for (int n = 0; n < 2; ++n) {
    Coupler coupler(scene);
    const double longest = n ? 0.05 : 0.002;   // nu_t T/h_z^2 about 0.4 and 0.02, by 1/12
    top[n] = run(coupler, scene, 40, longest).fluid.velocity.x[scene.grid.index(0, 0, 9)];
  }
  EXPECT_NEAR(top[0], top[1], 1e-3 * top[0]);
}

/// nu_t/nu is at most C_s^2 |S| Delta^2/nu, and the flow differs by no more than that share.
TEST(Turbulence, LeavesALaminarFlowAlone) {
  constexpr int layers = 16;
  Scene scene = fluid_scene({3, 3, layers}, {0.125, 0.125, 1.0 / layers}, channel, 1e-3);
  const double gradient = 1e-4, steepest = gradient * 0.5 / 1e-3;   // Poiseuille: |S| at the walls; Re 12
  const double share = 0.17 * 0.17 * steepest * 0.125 * 0.125 / 1e-3;
  ASSERT_LT(share, 0.03);
  double fastest[2], on_bottom[2];
  for (bool turbulence : {false, true}) {
    scene.terms.turbulence = turbulence;
    State state = state_of(scene, {}, false);
    state.search.gradient = gradient;
    Coupler coupler(scene);
    for (int n = 0; n < 1000; ++n) coupler.step(state, 4);
    fastest[turbulence] = state.fluid.velocity.x[scene.grid.index(0, 0, layers / 2)];
    on_bottom[turbulence] = coupler.books().on_bottom.x / coupler.books().driving.x;
  }
  EXPECT_LT(fastest[1], fastest[0]);
  EXPECT_GT(fastest[1], (1 - share) * fastest[0]);
  EXPECT_NEAR(on_bottom[0], 0.5, 1e-9);
  EXPECT_NEAR(on_bottom[1], 0.5, 1e-9);
}

/// Fixed and free grains under a lid: what the fluid gains is what drives it, less the forces on walls and grains.
TEST(Turbulence, IsBookedCompletely) {
  const double d = 1e-3;
  Terms model_b;
  model_b.pressure_gradient = model_b.viscous_stress = false;
  for (Terms terms : {Terms{}, model_b})
    for (double bed : {0.0, 4 * d})
      for (double lid_speed : {0.5, 20.0}) {   // 20 m/s: implicit
        Scene scene = fluid_scene({4, 4, 24}, {2 * d, 2 * d, 0.5 * d}, channel, 1e-6);
        scene.terms = terms;
        scene.terms.turbulence = true;
        scene.bottom_roughness = 1e-4;
        add_grains(scene, d, 2.65, 0.1);
        State state = state_of(scene, cubic_places({7, 7, 4}, {}, {8 * d, 8 * d, 4 * d}, 0.05 * d, 6), false);
        for (std::size_t p = 0; p < state.grains.size(); ++p) state.grains.fixed[p] = p % 2;
        std::mt19937 random(3);
        for (int c = 0; c < 3; ++c)
          for (std::size_t n = 0; n < state.fluid.velocity.x.values.size(); ++n)
            state.fluid.velocity.component(c)[n] = lid_speed * (random() / 4294967296.0);
        state.search.lid_speed = lid_speed;
        state.search.bed_height = bed;
        Coupler coupler(scene);
        for (int i = 0; i < 20; ++i) {
          const double before = fluid_momentum(scene, state).x;
          const StepHealth health = coupler.step(state, scene.steps.fluid_interval);
          ASSERT_TRUE(health.finite && !health.lost_grain);
          const StepBooks& books = coupler.books();
          const double booked = -books.on_bottom.x - books.on_lid.x - books.on_grains.x;
          const double scale = std::abs(books.on_lid.x) + std::abs(books.on_grains.x) + std::abs(before) / health.dt;
          EXPECT_NEAR((fluid_momentum(scene, state).x - before) / health.dt / scale, booked / scale, 1e-12);
        }
      }
}

}   // namespace
}   // namespace bedload::test

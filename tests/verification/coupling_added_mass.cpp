// Added mass: a grain set free, and the dense columns in which schemes blow up whose grains answer to pressure a step late.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "solver/coupler.hpp"
#include "solver/coupling/drag_laws.hpp"
#include "tests/support/lagged_step.hpp"
#include "tests/support/scenes.hpp"

namespace bedload::test {
namespace {

constexpr double gravity = 9.81;

/// A grain of 0.1 mm in the middle of cells of 4000 d, which it hardly stirs; water.
struct Release {
  Release(double density_ratio, DragLawName law)
      : scene(fluid_scene({4, 4, 4}, {4000 * d, 4000 * d, 4000 * d}, closed_box, 1e-6)) {
    scene.bed.gravity = {0, 0, -gravity};
    scene.drag = law;
    scene.terms.added_mass = true;
    add_grains(scene, d, density_ratio, 0.01);
    state = state_of(scene, {{6800 * d, 8400 * d, 8800 * d}}, false);
  }
  static constexpr double d = 1e-4;
  Scene scene;
  State state;
};

TEST(AddedMass, SlowsTheReleaseOfAGrainByItsShareOfTheInertia) {
  for (const double s : {0.5, 1.01, 1.05, 2.65}) {
    Release grain(s, DragLawName::stokes);
    const double step = 1e-9;   // drag has not begun
    Coupler(grain.scene).step(grain.state, step);
    EXPECT_NEAR(-grain.state.grains.velocity[0].z / step / ((s - 1) * gravity / (s + 0.5)), 1, 1e-4) << s;
  }
}

struct ReleaseCase {
  DragLawName law;
  double speed[6];   // after 0.2, 0.5, 1, 2, 5 and 10 ms [m/s]
};

TEST(AddedMass, GivesTheFallOfAGrainSetFree) {
  // s 3, d 0.1 mm in water: (s + 1/2) V dv/dt = (s - 1) V g - drag(v), integrated independently to five digits.
  const double times[] = {0.2e-3, 0.5e-3, 1e-3, 2e-3, 5e-3, 10e-3};
  const ReleaseCase cases[] = {
      {DragLawName::stokes, {1.0654e-3, 2.4715e-3, 4.3826e-3, 7.0031e-3, 1.0067e-2, 1.0836e-2}},
      {DragLawName::schiller_naumann, {1.0641e-3, 2.4582e-3, 4.3144e-3, 6.7239e-3, 9.1026e-3, 9.5025e-3}},
      {DragLawName::di_felice, {1.0639e-3, 2.4518e-3, 4.2773e-3, 6.5772e-3, 8.6749e-3, 8.9714e-3}}};
  for (const auto& [law, speed] : cases) {
    Release grain(3, law);
    Coupler coupler(grain.scene);
    for (int i = 0, done = 0; i < 6; ++i) {
      const int steps = static_cast<int>(std::lround(times[i] / 2e-6));
      for (; done < steps; ++done) coupler.step(grain.state, 2e-6);
      EXPECT_NEAR(grain.state.clock.time, times[i], 1e-12);
      EXPECT_NEAR(-grain.state.grains.velocity[0].z / speed[i], 1, 1e-3) << name_of(law) << " at " << times[i];
    }
  }
}

/// Speed after a collision with the bottom over the speed before, of a bead of 3 mm and s 2.5 at 0.2 m/s in still liquid.
double rebound(double fluid_step) {
  const double d = 3e-3, approach = 0.2;
  Scene scene = fluid_scene({3, 3, 3}, {4 * d, 4 * d, 4 * d}, channel, 1e-6);
  scene.bed.gravity = {};
  scene.terms = {.drag = false, .buoyancy = false, .added_mass = true};
  add_grains(scene, d, 2.5, approach);
  scene.bed.grains.restitution = 0.9;
  State state = state_of(scene, {{2 * d, 2 * d, 0.55 * d}}, false);
  state.grains.velocity[0].z = -approach;
  Coupler coupler(scene);
  for (const double end = 0.2 * d / approach; state.clock.time < end;) coupler.step(state, fluid_step);
  return state.grains.velocity[0].z / approach;
}

TEST(AddedMass, GoesAlongInACollisionWhateverTheFluidStep) {
  // Contacts that met the grain's mass alone, and its liquid a step later, would leave 0.77 or 0.60, by the step.
  for (const double step : {1e-5, 1e-4, 1e-3}) EXPECT_NEAR(rebound(step), 0.9, 0.02) << step;
}

/// A column of grains at packing density 0.58 between bottom and top, hardly touching: layers of a body-centred lattice.
Scene dense_column(double density_ratio, State& state) {
  const double d = 1e-3, a = 1.204 * d;   // edge of the lattice's cell
  const int layers = 28;
  const Vec3 length{6 * a, 6 * a, (layers - 1) * a / 2 + 1.05 * d};
  Scene scene = fluid_scene({4, 4, 9}, {length.x / 4, length.y / 4, length.z / 9}, channel, 1e-6);
  scene.bed.gravity = {0, 0, -gravity};
  add_grains(scene, d, density_ratio,
             terminal_speed(DragLawName::di_felice, scene.bed.fluid.viscosity, density_ratio, d, gravity));
  std::vector<Vec3> places;
  unsigned shift = 0;
  for (int k = 0; k < layers; ++k)
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        const double odd = 0.5 * (k % 2), wobble = 0.004 * d * ((shift = (shift * 31 + 17) % 101) / 50.0 - 1);
        places.push_back({(i + odd + 0.2) * a + wobble, (j + odd + 0.2) * a - wobble, 0.52 * d + k * a / 2 + wobble});
      }
  state = state_of(scene, places, false);
  return scene;
}

double fastest(const State& state) {
  double most = 0;
  for (const Vec3& v : state.grains.velocity) most = std::max(most, norm(v));
  for (int c = 0; c < 3; ++c)
    for (std::size_t n = 0; n < state.fluid.velocity.x.values.size(); ++n)
      most = std::max(most, std::abs(state.fluid.velocity.component(c)[n]));
  return most;
}

struct DenseColumnCase {
  double density_ratio;
  bool added_mass;
  friend void PrintTo(const DenseColumnCase& c, std::ostream* out) {
    *out << "density ratio " << c.density_ratio << (c.added_mass ? ", added mass" : "");
  }
};
class DenseColumn : public testing::TestWithParam<DenseColumnCase> {};
INSTANTIATE_TEST_SUITE_P(AddedMass, DenseColumn,
                         testing::Values(DenseColumnCase{1.01, false}, DenseColumnCase{1.01, true},
                                         DenseColumnCase{1.05, false}, DenseColumnCase{1.05, true}));

TEST_P(DenseColumn, StaysBoundedWhereTheLaggedSchemeBlowsUp) {
  const auto [s, added_mass] = GetParam();
  State start;
  Scene scene = dense_column(s, start);
  scene.terms.added_mass = added_mass;
  const double terminal = terminal_speed(DragLawName::di_felice, scene.bed.fluid.viscosity, s, 1e-3, gravity);
  for (const int substeps : {10, 1}) {   // a shorter step does not help
    State state = start;
    LaggedStep lagged(scene);
    int steps = 0;
    for (; steps < 100 && fastest(state) < 10 * terminal; ++steps)
      lagged.step(state, substeps * scene.bed.dem_step, substeps);
    RecordProperty("lagged_steps_of_" + std::to_string(substeps), steps);
    EXPECT_LT(steps, 100) << "the lagged scheme was bounded: " << fastest(state) / terminal << " of U_t";
  }

  Coupler coupler(scene);
  for (int i = 0; i < 1000; ++i) {
    const StepHealth health = coupler.step(start, scene.steps.fluid_interval);
    ASSERT_TRUE(health.finite && !health.lost_grain && health.converged) << i;
    ASSERT_LT(fastest(start), terminal) << i;
  }
}

TEST(LaggedStep, IsTheSameStepWhereGrainsAreHeavyEnoughForIt) {
  // s = 8 > (1 - eps)/eps: the oracle lives, and its grains settle as ours do.
  State state;
  const Scene scene = dense_column(8, state);
  State lagged_state = state;
  LaggedStep lagged(scene);
  Coupler coupler(scene);
  for (int i = 0; i < 300; ++i) {
    lagged.step(lagged_state, scene.bed.dem_step, 1);
    coupler.step(state, scene.bed.dem_step);
  }
  double ours = 0, lagging = 0;
  for (std::size_t p = 0; p < state.grains.size(); ++p)
    ours += state.grains.velocity[p].z, lagging += lagged_state.grains.velocity[p].z;
  EXPECT_NEAR(lagging / ours, 1, 0.01);
  EXPECT_NEAR(fastest(lagged_state) / fastest(state), 1, 0.01);
}

}   // namespace
}   // namespace bedload::test

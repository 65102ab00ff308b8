// Viscous torque: grains that turn with the flow, grains that keep it from turning, and where the energy goes.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "solver/coupler.hpp"
#include "solver/fluid/face_loops.hpp"
#include "tests/support/scenes.hpp"

namespace bedload::test {
namespace {

constexpr double d = 1e-3;

/// Height of the middle of a face normal to x or y [m].
double height_of(const Scene& scene, std::size_t n) {
  const auto row = static_cast<std::ptrdiff_t>(n) % scene.grid.stride(1);
  return (static_cast<double>(row) - StaggeredGrid::ghosts + 0.5) * scene.grid.h.z;
}

template <class Profile>
void set_flow_along_x(const Scene& scene, State& state, Profile&& profile) {
  for_each_unknown_face(scene.grid, 0,
                        [&](std::size_t n) { state.fluid.velocity.x[n] = profile(height_of(scene, n)); });
}

/// A grain in a Couette flow of shear rate 1/s, in cells of 40 d: the volume that it displaces is no matter.
struct ShearedGrain {
  explicit ShearedGrain(bool fixed, double viscosity = 1e-5)
      : scene(fluid_scene({4, 4, 4}, {h, h, h}, channel, viscosity)) {
    scene.terms.viscous_torque = true;
    add_grains(scene, d, 2.65, 0.01);
    state = state_of(scene, {{1.9 * h, 2.1 * h, 1.9 * h}}, fixed);
    state.search.lid_speed = rate * 4 * h;
    set_flow_along_x(scene, state, [&](double z) { return rate * z; });
    if (!fixed) state.grains.velocity[0].x = rate * 1.9 * h;
  }
  static constexpr double rate = 1, h = 40 * d;   // [1/s], [m]
  Scene scene;
  State state;
};

TEST(ViscousTorque, OnAGrainHeldInShearIsStokes) {
  ShearedGrain grain(true);
  Coupler coupler(grain.scene);
  coupler.step(grain.state, 1e-6);
  const double mu = 1e-2, omega = 0.5 * grain.rate;
  EXPECT_NEAR(coupler.torque_on_grains()[0].y / (8 * std::numbers::pi * mu * std::pow(d / 2, 3) * omega), 1, 1e-4);
  EXPECT_NEAR(coupler.torque_on_grains()[0].x, 0, 1e-20);
}

TEST(ViscousTorque, OnAGrainThatTouchesTheBottomInShearIsThatOfGoldmanCoxAndBrenner) {
  // 0.944 x 4 pi mu gdot a^3. A linear shear is read exactly; the grain displaces 2e-5 of the cell that it touches.
  for (const bool near : {true, false}) {
    ShearedGrain grain(true);
    grain.scene.terms.wall_forces = near;
    grain.state.grains.position[0].z = 0.5 * d;
    Coupler coupler(grain.scene);
    coupler.step(grain.state, 1e-6);
    const double mu = 1e-2, a = d / 2;
    EXPECT_NEAR(coupler.torque_on_grains()[0].y / (4 * std::numbers::pi * mu * grain.rate * a * a * a),
                near ? 0.944 : 1, 1e-4);
  }
}

TEST(ViscousTorque, SlowsAGrainThatSpinsBesideAWallMore) {
  // At a gap of 0.1 a: 0.3817 - 0.4 ln 0.1 about axes along the wall, nothing more about its normal.
  const double mu = 1e-2, a = d / 2, factor = 0.3817 - 0.4 * std::log(0.1), spin = 2;
  for (const int axis : {0, 1, 2}) {
    ShearedGrain grain(false);
    grain.scene.terms.wall_forces = true;
    grain.state.search.lid_speed = 0;
    set_flow_along_x(grain.scene, grain.state, [](double) { return 0; });
    grain.state.grains.velocity[0] = {};
    grain.state.grains.position[0].z = 1.1 * a;
    grain.state.grains.spin[0][axis] = spin;
    Coupler coupler(grain.scene);
    const double step = 1e-6, relaxed = 60 * 1e-5 * step / (2.65 * d * d) * factor;   // 3e-4: of the spin, in the step
    coupler.step(grain.state, step);
    EXPECT_NEAR(coupler.torque_on_grains()[0][axis] / (-8 * std::numbers::pi * mu * a * a * a * spin),
                axis == 2 ? 1 : factor, 2 * relaxed);
    EXPECT_LT(grain.state.grains.spin[0][axis], spin);
  }
}

TEST(ViscousTorque, TurnsALoneGrainWithHalfTheVorticity) {
  ShearedGrain grain(false);
  Coupler coupler(grain.scene);
  const double response = 2.65 * d * d / 60 / 1e-5;   // I/(pi mu d^3)
  while (grain.state.clock.time < 20 * response) coupler.step(grain.state, 0.2 * response);
  EXPECT_NEAR(grain.state.grains.spin[0].y / (0.5 * grain.rate), 1, 1e-4);
  EXPECT_NEAR(coupler.torque_on_grains()[0].y, 0, 1e-4 * std::numbers::pi * 1e-2 * d * d * d * grain.rate);
}

TEST(ViscousTorque, LeavesAGrainThatTurnsWithTheFluidAlone) {
  ShearedGrain grain(false);
  grain.state.grains.spin[0] = {0, 0.5 * grain.rate, 0};
  Coupler coupler(grain.scene);
  for (int i = 0; i < 50; ++i) coupler.step(grain.state, grain.scene.steps.fluid_interval);
  EXPECT_NEAR(grain.state.grains.spin[0].y / (0.5 * grain.rate), 1, 1e-4);
}

TEST(ViscousTorque, OnAGrainThatItsContactKeepsFromTurningIsStokes) {
  // Rolling friction holds it on the floor. A solve that did not know of the contact's torque would let it turn over the step
  // and find 1/(1 + lambda T) of the torque.
  ShearedGrain grain(false, 1e-4);
  grain.scene.terms.drag = false;
  grain.scene.bed.gravity = {0, 0, -9.81};
  grain.scene.bed.grains.rolling_friction = 0.5;
  grain.state.grains.position[0].z = 0.5 * d;
  grain.state.grains.velocity[0] = {};
  Coupler coupler(grain.scene);
  double step = 0;
  for (int i = 0; i < 500; ++i) step = coupler.step(grain.state, grain.scene.steps.fluid_interval).dt;
  EXPECT_GT(60 * 1e-4 / (2.65 * d * d) * step, 0.5) << "lambda T";
  EXPECT_NEAR(grain.state.grains.spin[0].y, 0, 1e-3 * grain.rate);
  const double stokes = std::numbers::pi * 0.1 * d * d * d * 0.5 * grain.rate;
  EXPECT_NEAR(coupler.torque_on_grains()[0].y / stokes, 1, 1e-3);
}

TEST(ViscousTorque, OfGrainsThatDoNotTurnThickensTheFluid) {
  // n pi mu d^3 = 6 mu phi per vorticity/2: a force 1.5 phi nu lap u beside eps nu lap u, so that a shear wave decays at
  // nu k^2 (1 + 1.5 phi/eps); k^2 as the grid has it. No drag.
  const double nu = 1e-5;
  const int n = 12;
  Scene scene = fluid_scene({4, 4, n}, {2 * d, 2 * d, 2 * d}, periodic_box, nu);
  scene.terms.viscous_torque = true;
  scene.terms.drag = false;
  add_grains(scene, d, 2.65, 0.01);
  State state = state_of(scene, cubic_places({8, 8, 2 * n}, {}, scene.grid.length(), 0, 1), true);
  const double k = 2 * std::numbers::pi / (n * 2 * d), phi = std::numbers::pi / 6, amplitude = 1e-4;
  set_flow_along_x(scene, state, [&](double z) { return amplitude * std::sin(k * z); });
  const double discrete = std::pow(2 / (2 * d) * std::sin(k * d), 2);
  Coupler coupler(scene);
  const double step = 2e-3 / (nu * discrete);   // of a decay time, 100 times
  for (int i = 0; i < 100; ++i) coupler.step(state, step);
  double left = 0;
  for_each_unknown_face(scene.grid, 0, [&](std::size_t f) {
    left += 2 * state.fluid.velocity.x[f] * std::sin(k * height_of(scene, f)) / scene.grid.cell_count();
  });
  const double thickening = -std::log(left / amplitude) / (nu * discrete * 100 * step);
  RecordProperty("thickening", std::to_string(thickening));
  EXPECT_NEAR(thickening / (1 + 1.5 * phi / (1 - phi)), 1, 0.01);
}

struct StiffCase {
  double viscous_steps;   // nu T/h^2
  bool fixed, drag;
  std::array<Side, 3> sides;
  friend void PrintTo(const StiffCase& c, std::ostream* out) {
    *out << "nu T/h2 " << c.viscous_steps << (c.fixed ? ", fixed" : ", free") << (c.drag ? "" : ", no drag")
         << (c.sides[2] == Side::wall ? ", channel" : "");
  }
};
class StiffTorque : public testing::TestWithParam<StiffCase> {};
INSTANTIATE_TEST_SUITE_P(ViscousTorque, StiffTorque,
                         testing::Values(StiffCase{0.05, false, true, periodic_box},
                                         StiffCase{1, false, true, periodic_box},
                                         StiffCase{10, false, true, periodic_box}, StiffCase{10, false, true, channel},
                                         StiffCase{10, true, false, channel}, StiffCase{10, true, true, periodic_box}));

TEST_P(StiffTorque, OnlyTakesEnergyAtAPackingOfSixTenths) {
  // A random flow among grains that spin at random, body-centred lattice at phi 0.6, nothing that drives: energy falls in
  // every step, whatever its length.
  const auto [viscous_steps, fixed, with_drag, sides] = GetParam();
  const double a = std::cbrt(2 * sphere_volume(d) / 0.6), h = 2 * a, nu = 1e-4;
  Scene scene = fluid_scene({3, 3, 4}, {h, h, h}, sides, nu);
  scene.terms.viscous_torque = true;
  scene.terms.drag = with_drag;
  add_grains(scene, d, 2.65, 0.01);
  std::vector<Vec3> places;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      for (int k = 0; k < 8; ++k)
        for (const double shift : {0.25, 0.75}) {
          const double z =
              sides[2] == Side::wall ? 0.52 * d + (k + shift - 0.25) * (8 * a - 1.04 * d) / 7.5 : (k + shift) * a;
          places.push_back({(i + shift) * a, (j + shift) * a, z});
        }
  State state = state_of(scene, places, fixed);
  std::mt19937 random(7);
  const auto number = [&](double size) { return size * (2.0 * random() / std::mt19937::max() - 1); };
  const double speed = 1e-6;   // nothing moves
  for (int c = 0; c < 3; ++c)
    for_each_unknown_face(scene.grid, c, [&](std::size_t n) { state.fluid.velocity.component(c)[n] = number(speed); });
  if (!fixed)
    for (Vec3& w : state.grains.spin) w = {number(speed / d), number(speed / d), number(speed / d)};
  const double step = viscous_steps * h * h / nu;
  scene.bed.dem_step = step / 2;
  Coupler coupler(scene);
  double energy = kinetic_energy(scene, state);
  coupler.step(state, step);   // makes the random flow free of divergence
  EXPECT_LT(kinetic_energy(scene, state), energy);
  energy = kinetic_energy(scene, state);
  const double first = energy;
  for (int i = 0; i < 30; ++i) {
    const StepHealth health = coupler.step(state, step);
    ASSERT_TRUE(health.finite && health.converged);
    const double now = kinetic_energy(scene, state);
    EXPECT_LE(now, energy + 1e-6 * first) << i;
    energy = now;
  }
}

}   // namespace
}   // namespace bedload::test

// A lone grain that falls through still fluid, against its own drag law and the walls: with the self-disturbance correction the
// speed does not depend on the cells, without it the known error is there.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/coupler.hpp"
#include "solver/coupling/drag_laws.hpp"
#include "solver/coupling/self_disturbance.hpp"
#include "tests/support/scenes.hpp"

namespace bedload::test {
namespace {

constexpr double d = 1e-4, density_ratio = 3, gravity = 9.81;

struct Fall {
  double cell;                  // edge of the cubic cells, in diameters
  std::array<int, 3> cells;     // of the closed box
  double viscosity;             // [m2/s]
  Vec3 place{0.5, 0.5, 0.85};   // where it starts, as a share of the box...
  Vec3 shift;                   // ...and from there in cells
  double distance = 10;         // how far it falls [cells]
  DragLawName law = DragLawName::di_felice;
  Terms terms{};
  double longest = 5e-4;   // fluid step [s]
};

struct Fallen {
  double mean;     // over the last four cells of fall, per terminal speed of the law
  double ripple;   // largest distance from that mean in the last cell
  double growth;   // of the mean over the last cell against the mean over the one before the last four
  double last_speed, last_height;
  std::uint64_t clamps = 0;
};

Terms corrected(Terms terms = {}) {
  terms.self_disturbance = true;
  return terms;
}

Scene scene_of(const Fall& fall) {
  const double h = fall.cell * d;
  Scene scene = fluid_scene(fall.cells, {h, h, h}, closed_box, fall.viscosity);
  scene.bed.gravity = {0, 0, -gravity};
  scene.drag = fall.law, scene.terms = fall.terms;
  add_grains(scene, d, density_ratio, terminal_speed(fall.law, fall.viscosity, density_ratio, d, gravity));
  return scene;
}

Fallen fallen(const Fall& fall) {
  const Scene scene = scene_of(fall);
  const double h = fall.cell * d, speed = terminal_speed(fall.law, fall.viscosity, density_ratio, d, gravity);
  const Vec3 start = scaled(fall.place, scene.grid.length()) + h * fall.shift;
  State state = state_of(scene, {start}, false);
  Coupler coupler(scene);
  std::vector<double> time, depth, velocity;
  Fallen seen{};
  while (time.empty() || depth.back() < fall.distance * h) {
    const StepHealth health = coupler.step(state, fall.longest);
    EXPECT_TRUE(health.finite && health.converged);
    seen.clamps += health.disturbance_clamps;
    time.push_back(state.clock.time), depth.push_back(start.z - state.grains.position[0].z);
    velocity.push_back(-state.grains.velocity[0].z / speed);
    if (time.size() > 20000) break;
  }
  const auto row = [&](double cells_from_end) {
    return static_cast<std::size_t>(std::ranges::lower_bound(depth, (fall.distance - cells_from_end) * h) -
                                    depth.begin());
  };
  const auto mean = [&](std::size_t from, std::size_t to) {
    return (depth[to] - depth[from]) / (time[to] - time[from]) / speed;
  };
  const std::size_t end = depth.size() - 1;
  seen.mean = mean(row(std::min(4.0, 0.5 * fall.distance)), end);
  const double last = mean(row(1), end);
  for (std::size_t n = row(1); n <= end; ++n) seen.ripple = std::max(seen.ripple, std::abs(velocity[n] - last));
  seen.growth = last / mean(row(2), row(1)) - 1;
  seen.last_speed = velocity.back(), seen.last_height = state.grains.position[0].z;
  testing::Test::RecordProperty("mean", std::to_string(seen.mean));
  testing::Test::RecordProperty("ripple", std::to_string(seen.ripple));
  return seen;
}

double reynolds(const Fall& fall) {
  return terminal_speed(fall.law, fall.viscosity, density_ratio, d, gravity) * d / fall.viscosity;
}

class Position : public testing::TestWithParam<Vec3> {};
INSTANTIATE_TEST_SUITE_P(SettlingSphere, Position,
                         testing::Values(Vec3{0, 0, 0}, Vec3{0.5, 0.5, 0.5}, Vec3{0.5, 0, 0.2}));

TEST_P(Position, DoesNotMatter) {
  // Down a column of edges, of centres and of faces; Re_p 0.9, where the walls are not felt.
  const Fallen seen =
      fallen({2.5, {20, 20, 36}, 1e-6, {0.5, 0.5, 0.85}, GetParam(), 10, DragLawName::di_felice, corrected()});
  EXPECT_NEAR(seen.mean, 1, 0.01);
  EXPECT_LE(seen.ripple, 0.01);
  EXPECT_LE(std::abs(seen.growth), 0.002);
  EXPECT_EQ(seen.clamps, 0u);
}

struct MeshCase {
  double cell, viscosity;
  std::array<int, 3> cells;
  double ripple;
  bool model_b = false;
  friend void PrintTo(const MeshCase& c, std::ostream* out) {
    *out << "cells of " << c.cell << " d, viscosity " << c.viscosity << ", Model " << (c.model_b ? "B" : "A");
  }
};
class Mesh : public testing::TestWithParam<MeshCase> {};
INSTANTIATE_TEST_SUITE_P(SettlingSphere, Mesh,
                         testing::Values(MeshCase{5, 1e-6, {16, 16, 32}, 0.01}, MeshCase{5, 3.6e-7, {16, 16, 32}, 0.01},
                                         MeshCase{2.5, 1e-6, {20, 20, 36}, 0.01, true},
                                         MeshCase{2.5, 3.6e-7, {20, 20, 36}, 0.01}));

TEST_P(Mesh, DoesNotMatter) {
  const auto [cell, viscosity, cells, ripple, model_b] = GetParam();
  const Terms terms = corrected(model_b ? Terms{true, true, false, false} : Terms{});
  const Fall fall{cell, cells, viscosity, {0.5, 0.5, 0.85}, {0.3, 0.4, 0}, 9, DragLawName::di_felice, terms};
  const Fallen seen = fallen(fall);
  EXPECT_NEAR(seen.mean, 1, 0.01) << "Re_p " << reynolds(fall);
  EXPECT_LE(seen.ripple, ripple);
  EXPECT_EQ(seen.clamps, 0u);
}

TEST(SettlingSphere, CreepsDownADuctAsHappelAndBartFound) {
  // Along the axis of a square duct of half width l: 1 - 1.9033 a/l, creeping flow (Happel & Bart 1974, Appl. Sci. Res. 29, 241).
  const Fall fall{5,           {12, 12, 24}, 1.044e-5, {0.5, 0.5, 0.55}, {0.2, 0.1, 0}, 4, DragLawName::stokes,
                  corrected(), 1e-3};
  ASSERT_LT(reynolds(fall), 0.011);
  EXPECT_NEAR(fallen(fall).mean, 1 - 1.9033 * 0.5 / (6 * 5), 0.01);
}

class AboveTheFloor : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(SettlingSphere, AboveTheFloor, testing::Values(2.0, 4.0));

TEST_P(AboveTheFloor, SlowsDownAsByItsImage) {
  // 1 - (9/8) a/z to first order in a/z (Lorentz 1907); the walls of the box are 25 d away.
  const double height = GetParam();   // cells
  const Fall fall{
      2.5,         {20, 20, 16}, 1.044e-5, {0.5, 0.5, (height + 2) / 16}, {0.25, 0.1, 0}, 2, DragLawName::stokes,
      corrected(), 1e-3};
  ASSERT_LT(reynolds(fall), 0.1);
  const Fallen seen = fallen(fall);
  EXPECT_NEAR(seen.last_speed, 1 - 9.0 / 8 * 0.5 * d / seen.last_height, 0.03);
}

class RawError : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(SettlingSphere, RawError, testing::Values(5.0, 2.5));

TEST_P(RawError, IsTheOneThatTheGridsResponseGives) {
  // The fluid at the grain is carried along at r W'/nu, whatever the slip: so much faster than its slip against the fluid the
  // grain falls. Down a column of edges, where the weights are even.
  const double cell = GetParam(), h = cell * d, nu = 1e-6;
  const Fall fall{cell, {16, 16, 40}, nu, {0.5, 0.5, 0.85}, {}, 10, DragLawName::di_felice, {}};
  const SelfDisturbance table(scene_of(fall).grid);
  const double law = terminal_speed(fall.law, nu, density_ratio, d, gravity), volume = sphere_volume(d),
               weight = (density_ratio - 1) * gravity * volume;   // per fluid density
  const double speed = 1.1 * law;
  double carried = 0, stress = 0;   // mean over a cell of fall
  for (int i = 0; i < 8; ++i) {
    const OwnFlow own = table.at({8 * h, 8 * h, (20 + (i + 0.5) / 8) * h}, {0, 0, speed}, nu);
    carried += own.drag.z * weight / nu / 8, stress += volume / (h * h * h) * own.stress.z / 8;
  }
  const double expected = carried / law - stress;
  EXPECT_GT(expected, cell == 5 ? 0.035 : 0.11);
  EXPECT_NEAR(fallen(fall).mean - 1, expected, 0.012);
}

struct Towed {
  bool model_b;
  friend void PrintTo(const Towed& t, std::ostream* out) { *out << "Model " << (t.model_b ? "B" : "A"); }
};
class TowedSphere : public testing::TestWithParam<Towed> {};
INSTANTIATE_TEST_SUITE_P(SettlingSphere, TowedSphere, testing::Values(Towed{false}, Towed{true}));

TEST_P(TowedSphere, FeelsItsLawThroughCellsOfItsOwnSize) {
  // So heavy that nothing slows it, over fourteen cells. In cells of 1 d the parts of second order count: the volume that gets
  // out of its way for 2 %, the stress that passes its drag on for 5 % (Model A), its flow that goes along for 1.5 %.
  const double nu = 1e-6, speed = 2 * nu / d;
  Scene scene = fluid_scene({20, 20, 36}, {d, d, d}, closed_box, nu);
  scene.drag = DragLawName::stokes;
  scene.terms = corrected(GetParam().model_b ? Terms{true, true, false, false} : Terms{});
  add_grains(scene, d, 1e6, speed);
  State state = state_of(scene, {{10 * d, 10 * d, 28 * d}}, false);
  state.grains.velocity[0] = {0, 0, -speed};
  Coupler coupler(scene);
  double impulse = 0, duration = 0;   // over the last cell
  while (state.grains.position[0].z > 14 * d) {
    const StepHealth health = coupler.step(state, 0.05 * d / speed);
    ASSERT_TRUE(health.finite && health.converged);
    ASSERT_EQ(health.disturbance_clamps, 0u);
    if (state.grains.position[0].z > 15 * d) continue;
    impulse += health.dt * coupler.books().on_grains.z, duration += health.dt;
  }
  const double law = 3 * std::numbers::pi * nu * scene.bed.fluid.density * d * speed;
  EXPECT_NEAR(impulse / duration / law, 1, 0.01);
  EXPECT_NEAR(state.grains.velocity[0].z / -speed, 1, 1e-3);
}

TEST(SettlingSphere, IsNotCorrectedInASuspension) {
  // phi 0.05: drag laws mean the flow averaged over all grains, each with its own.
  const double nu = 1e-6, h = 2e-4;
  Scene scene = fluid_scene({8, 8, 8}, {h, h, h}, periodic_box, nu);
  scene.bed.gravity = {0, 0, -gravity};
  add_grains(scene, d, density_ratio, 0.01);
  double mean[2] = {};
  for (const bool with : {false, true}) {
    scene.terms.self_disturbance = with;
    State state = state_of(scene, cubic_places({7, 7, 8}, {}, scene.grid.length(), 0.4 * d, 5), false);
    Coupler coupler(scene);
    while (state.clock.time < 0.02) coupler.step(state, 2e-4);
    for (const Vec3& v : state.grains.velocity) mean[with] += v.z / static_cast<double>(state.grains.size());
  }
  EXPECT_LT(mean[false], -0.005);
  EXPECT_NEAR(mean[true] / mean[false], 1, 1e-3);
}

}   // namespace
}   // namespace bedload::test

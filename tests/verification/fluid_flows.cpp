// Flows of fluid alone against exact solutions and a benchmark, through the whole coupled step.
#include <gtest/gtest.h>

#include <cmath>

#include "solver/coupler.hpp"
#include "solver/fluid/face_loops.hpp"
#include "tests/support/scenes.hpp"

namespace bedload {
namespace {

using namespace test;

constexpr double viscosity = 1e-3, height = 1, speed = 1e-3, density = 1000;   // slow: viscosity alone limits the step

/// Runs the flow for `duration` in equal steps of about `dt`.
void advance(Coupler& coupler, State& state, double duration, double dt) {
  const int steps = static_cast<int>(std::ceil(duration / dt - 1e-9));
  for (int n = 0; n < steps; ++n) {
    const StepHealth health = coupler.step(state, duration / steps);
    ASSERT_TRUE(health.finite);
    ASSERT_NEAR(health.dt, duration / steps,
                1e-12 * duration);   // the Courant limit must not change the plan of a test
  }
}

/// Cubic through the four samples nearest to x, where sample m stands at (m + offset) h.
template <class Sample>
double interpolated(double x, double h, double offset, Sample&& sample) {
  const int first = static_cast<int>(std::floor(x / h - offset)) - 1;
  double value = 0;
  for (int a = 0; a < 4; ++a) {
    double weight = 1;
    for (int b = 0; b < 4; ++b)
      if (b != a) weight *= (x / h - offset - (first + b)) / (a - b);
    value += weight * sample(first + a);
  }
  return value;
}

Scene channel_scene(int cells) { return fluid_scene({1, 1, cells}, {5, 5, height / cells}, channel, viscosity); }

double speed_at(const Scene& scene, const State& state, double z) {
  return interpolated(z, scene.grid.h.z, 0.5, [&](int k) { return state.fluid.velocity.x[scene.grid.index(0, 0, k)]; });
}

/// u/U at z/H = .25, .5, .75, .9 of a fluid at rest whose lid starts to move at t = 0 (series solution of du/dt = nu
/// d2u/dz2).
TEST(FluidFlows, CouetteStartUpFollowsTheSeriesSolution) {
  const double z[] = {0.25, 0.5, 0.75, 0.9};
  const struct {
    double time, u[4];
  } table[] = {{0.05, {.01763, .11384, .42920, .75183}},
               {0.10, {.08834, .26276, .57606, .82304}},
               {0.20, {.18759, .41157, .68735, .87260}}};
  const Scene scene = channel_scene(32);
  State state = state_of(scene, {}, false);
  state.search.lid_speed = speed;
  Coupler coupler(scene);
  const double diffusion_time = height * height / viscosity;
  const double dt = scene.grid.h.z * scene.grid.h.z / viscosity / 12;
  double time = 0;
  for (const auto& row : table) {
    advance(coupler, state, (row.time - time) * diffusion_time, dt);
    time = row.time;
    for (int m = 0; m < 4; ++m)
      EXPECT_NEAR(speed_at(scene, state, z[m]) / speed, row.u[m], 0.005 * row.u[m]) << "t " << time << " z " << z[m];
  }
}

TEST(FluidFlows, ImplicitViscosityEndsInTheSameCouetteFlow) {
  for (double number : {0.6, 3.0, 10.0, 100.0}) {   // nu dt/h^2
    const Scene scene = channel_scene(16);
    State state = state_of(scene, {}, false);
    state.search.lid_speed = speed;
    Coupler coupler(scene);
    const double h = scene.grid.h.z;
    advance(coupler, state, 8 * height * height / viscosity, number * h * h / viscosity);
    for (int k = 0; k < 16; ++k)
      EXPECT_NEAR(state.fluid.velocity.x[scene.grid.index(0, 0, k)], speed * (k + 0.5) * h, 1e-6 * speed) << number;
    const double shear = density * viscosity * speed / height * scene.grid.length().x * scene.grid.length().y;
    EXPECT_NEAR(coupler.books().on_bottom.x, shear, 1e-6 * shear) << number;
    EXPECT_NEAR(coupler.books().on_lid.x, -shear, 1e-6 * shear) << number;
  }
}

/// Between resting walls under a uniform gradient G: u = G z (H - z)/(2 nu); the walls bear the whole gradient.
void expect_poiseuille(int cells, double viscous_number) {
  constexpr double gradient = 4e-6;
  const Scene scene = channel_scene(cells);
  State state = state_of(scene, {}, false);
  state.search.gradient = gradient;
  Coupler coupler(scene);
  const double h = scene.grid.h.z;
  advance(coupler, state, 4 * height * height / viscosity, viscous_number * h * h / viscosity);
  const double fastest = gradient * height * height / (8 * viscosity);
  EXPECT_NEAR(speed_at(scene, state, 0.5 * height), fastest, 0.005 * fastest) << viscous_number;
  const StepBooks& books = coupler.books();
  EXPECT_NEAR(books.on_bottom.x + books.on_lid.x, books.driving.x, 1e-9 * books.driving.x) << viscous_number;
  EXPECT_NEAR(books.on_bottom.x, 0.5 * books.driving.x, 1e-9 * books.driving.x) << viscous_number;
}

TEST(FluidFlows, PoiseuilleFlowIsTheParabolaAndItsWallsBearTheGradient) { expect_poiseuille(16, 1.0 / 12); }

TEST(FluidFlows, ImplicitViscosityEndsInTheSamePoiseuilleFlow) {
  for (double number : {0.6, 3.0, 10.0}) expect_poiseuille(32, number);
}

TEST(FluidFlows, AFreeSlipTopHalvesThePoiseuilleFlow) {
  Scene scene = channel_scene(32);
  scene.grid.top = scene.bed.top = Top::free_slip;
  State state = state_of(scene, {}, false);
  state.search.gradient = 1e-6;
  Coupler coupler(scene);
  const double h = scene.grid.h.z;
  advance(coupler, state, 16 * height * height / viscosity, 10 * h * h / viscosity);
  const double fastest = 1e-6 * height * height / (2 * viscosity);
  EXPECT_NEAR(state.fluid.velocity.x[scene.grid.index(0, 0, 31)], fastest, 0.002 * fastest);
  EXPECT_NEAR(coupler.books().on_bottom.x, coupler.books().driving.x, 1e-9 * coupler.books().driving.x);
}

/// Mean |error| of the horizontal velocity of a Taylor-Green vortex in the plane of components a and b, after a quarter
/// of its decay time. At larger viscosities two errors cancel, those of transport and of the viscous decay in time.
double taylor_green_error(int cells, int a, int b) {
  const double k = 2 * M_PI, nu = 0.005;
  std::array<int, 3> n{1, 1, 1};
  n[a] = n[b] = cells;
  Vec3 h{1.0 / cells, 1.0 / cells, 1.0 / cells};
  const Scene scene = fluid_scene(n, h, periodic_box, nu);
  const StaggeredGrid& g = scene.grid;
  State state = state_of(scene, {}, false);
  double *u = state.fluid.velocity.component(a), *v = state.fluid.velocity.component(b);
  const auto at = [&](int p, int q) { return g.index(0, 0, 0) + p * g.stride(a) + q * g.stride(b); };
  for (int p = 0; p < cells; ++p)
    for (int q = 0; q < cells; ++q) {
      u[at(p, q)] = std::sin(k * p / cells) * std::cos(k * (q + 0.5) / cells);
      v[at(p, q)] = -std::cos(k * (p + 0.5) / cells) * std::sin(k * q / cells);
    }
  Coupler coupler(scene);
  const double duration = 0.25 / (2 * nu * k * k);
  advance(coupler, state, duration, duration / (3 * cells));
  double error = 0;
  for (int p = 0; p < cells; ++p)
    for (int q = 0; q < cells; ++q)
      error += std::abs(u[at(p, q)] - std::exp(-0.25) * std::sin(k * p / cells) * std::cos(k * (q + 0.5) / cells));
  return error / (cells * cells);
}

TEST(FluidFlows, TaylorGreenVortexDecaysWithSecondOrder) {
  for (auto [a, b] : {std::pair{0, 2}, {0, 1}, {1, 2}}) {
    const double coarse = taylor_green_error(24, a, b), fine = taylor_green_error(48, a, b);
    EXPECT_GT(std::log2(coarse / fine), 1.8) << "components " << a << " and " << b << ": " << coarse << " and " << fine;
    EXPECT_LT(fine, 0.001);
  }
}

/// Velocity along x and z in the middle of a cavity, whose lid has moved for a while: where neither vanishes.
Vec3 velocity_in_a_cavity(double dt) {
  constexpr int n = 16;
  const Scene scene =
      fluid_scene({n, 1, n}, {1.0 / n, 1.0 / n, 1.0 / n}, {Side::wall, Side::periodic, Side::wall}, 0.01);
  State state = state_of(scene, {}, false);
  state.search.lid_speed = 1;
  Coupler coupler(scene);
  advance(coupler, state, 30, dt);
  const std::size_t at = scene.grid.index(n / 4, 0, 3 * n / 4);
  return {state.fluid.velocity.x[at], 0, state.fluid.velocity.z[at]};
}

TEST(FluidFlows, ASteadyFlowDoesNotDependOnTheStep) {
  const Vec3 coarse = velocity_in_a_cavity(0.015), fine = velocity_in_a_cavity(0.005);
  EXPECT_GT(norm(fine), 0.1);
  EXPECT_LT(norm(coarse - fine), 1e-5);
}

/// Ghia, Ghia and Shin (J. Comput. Phys. 48, 1982), Re = 100: extremes on the centre lines.
TEST(FluidFlows, LidDrivenCavityAtReynolds100AgreesWithGhia) {
  constexpr int n = 32;
  Scene scene = fluid_scene({n, 1, n}, {1.0 / n, 1.0 / n, 1.0 / n}, {Side::wall, Side::periodic, Side::wall}, 0.01);
  const StaggeredGrid& g = scene.grid;
  State state = state_of(scene, {}, false);
  state.search.lid_speed = 1;
  Coupler coupler(scene);
  advance(coupler, state, 15, 0.008);
  const auto u = [&](double z) {
    return interpolated(z, 1.0 / n, 0.5, [&](int k) { return state.fluid.velocity.x[g.index(n / 2, 0, k)]; });
  };
  const auto w = [&](double x) {
    return interpolated(x, 1.0 / n, 0.5, [&](int i) { return state.fluid.velocity.z[g.index(i, 0, n / 2)]; });
  };
  EXPECT_NEAR(u(.4531), -.21090, 0.03 * .21090);
  EXPECT_NEAR(w(.2344), .17527, 0.03 * .17527);
  EXPECT_NEAR(w(.8047), -.24533, 0.03 * .24533);
}

}   // namespace
}   // namespace bedload

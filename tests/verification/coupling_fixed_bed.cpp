// Flow through and over grains that do not move, against the drag law's own answer.
#include <gtest/gtest.h>

#include <numbers>

#include "solver/coupler.hpp"
#include "solver/coupling/drag_laws.hpp"
#include "solver/fluid/face_loops.hpp"
#include "tests/support/scenes.hpp"

namespace bedload::test {
namespace {

/// Superficial velocity that a uniform bed lets through under the gradient G [m/s2] (per fluid density):
/// eps G = 18 phi nu F U_s/d^2 with F(phi, Re), Re = U_s d/nu.
double law_velocity(DragLawName name, double phi, double diameter, double viscosity, double gradient) {
  const DragLaw law = drag_law(name);
  double low = 0, high = (1 - phi) * gradient * diameter * diameter / (phi * viscosity);
  for (int i = 0; i < 200; ++i) {
    const double u = 0.5 * (low + high);
    const double f = std::visit([&](const auto& l) { return l.multiplier(1 - phi, u * diameter / viscosity); }, law);
    (18 * phi * viscosity * f * u / (diameter * diameter) < (1 - phi) * gradient ? low : high) = u;
  }
  return low;
}

double mean_superficial_velocity(const Scene& scene, const State& state) {
  const FaceFields eps = face_void_fraction(scene, state);
  const double* u = state.fluid.velocity.component(0);
  return sum_over_faces(scene.grid, 0, [e = eps.component(0), u](std::size_t n) { return e[n] * u[n]; }) /
         static_cast<double>(scene.grid.cell_count());
}

/// Runs to the steady state under the gradient G along x, at the step asked for and no shorter one.
double settle_flow(const Scene& scene, State& state, double gradient, double step, int steps) {
  Coupler coupler(scene);
  state.search.gradient = gradient;
  for (int i = 0; i < steps; ++i) {
    const StepHealth health = coupler.step(state, step);
    EXPECT_TRUE(health.finite);
    EXPECT_EQ(health.dt, step);
  }
  return mean_superficial_velocity(scene, state);
}

constexpr double micron = 1e-6;

struct DarcyBed {
  Scene scene;
  State state;
  double phi;
};

/// A lattice of 20 micron grains at about phi 0.5, cells of 2 d, in a periodic box.
DarcyBed darcy_bed(Terms terms) {
  const double d = 20 * micron;
  DarcyBed bed;
  bed.scene = fluid_scene({6, 6, 6}, {2 * d, 2 * d, 2 * d}, periodic_box, 1e-6);
  bed.scene.terms = terms;
  add_grains(bed.scene, d, 2.65, 1e-3);
  const std::array<int, 3> count = {12, 12, 12};
  bed.state = state_of(bed.scene, cubic_places(count, {}, bed.scene.grid.length(), 0, 1), true);
  const Vec3 length = bed.scene.grid.length();
  bed.phi = 12 * 12 * 12 * sphere_volume(d) / (length.x * length.y * length.z);
  return bed;
}

TEST(FixedBed, LetsThroughTheLawsOwnVelocityAtAFluidStepOfAMillisecond) {
  DarcyBed bed = darcy_bed({});
  const double gradient = 10;
  const double u = settle_flow(bed.scene, bed.state, gradient, 1e-3, 40);
  EXPECT_NEAR(u / law_velocity(DragLawName::di_felice, bed.phi, 20 * micron, 1e-6, gradient), 1, 0.01);
}

TEST(FixedBed, GivesTheSameVelocityInModelAAndModelB) {
  const double gradient = 10;
  DarcyBed a = darcy_bed({}), b = darcy_bed({true, true, false, false});
  const double ua = settle_flow(a.scene, a.state, gradient, 1e-3, 40),
               ub = settle_flow(b.scene, b.state, gradient, 1e-3, 40);
  EXPECT_NEAR(ua / ub, 1, 0.01);
}

struct RandomBed {
  double viscosity, reynolds;
  Terms terms{};
  friend void PrintTo(const RandomBed& c, std::ostream* out) {
    *out << "Re " << c.reynolds << ", viscosity " << c.viscosity << ", Model " << (c.terms.model_b() ? "B" : "A");
  }
};
class RandomFixedBed : public testing::TestWithParam<RandomBed> {};
INSTANTIATE_TEST_SUITE_P(FixedBed, RandomFixedBed,
                         testing::Values(RandomBed{1e-4, 0.01}, RandomBed{1e-6, 1}, RandomBed{1e-6, 10},
                                         RandomBed{1e-6, 100}, RandomBed{1e-6, 10, {true, true, false, false}}));

TEST_P(RandomFixedBed, ResistsWithTheLawsOwnGradient) {
  const auto [viscosity, reynolds, terms] = GetParam();
  const double d = 1e-3, phi = std::numbers::pi / 6,
               expected = reynolds * viscosity / d;   // superficial velocity wanted
  const double gradient =
      18 * phi * viscosity * DiFelice{}.multiplier(1 - phi, reynolds) * expected / ((1 - phi) * d * d);
  Scene scene = fluid_scene({6, 6, 6}, {2 * d, 2 * d, 2 * d}, periodic_box, viscosity);
  scene.terms = terms;
  add_grains(scene, d, 2.65, 1e-2);
  State state = state_of(scene, cubic_places({12, 12, 12}, {}, scene.grid.length(), 0.2 * d, 7), true);
  const double u = settle_flow(scene, state, gradient, 0.2 * d / expected, 300);
  EXPECT_NEAR(u / expected, 1, 0.02);
}

TEST(FixedBed, InStillFluidStaysExactlyStill) {
  const double d = 1e-3;
  Scene scene = fluid_scene({6, 6, 8}, {2 * d, 2 * d, d}, channel, 1e-6);
  scene.bed.gravity = {0, 0, -9.81};
  add_grains(scene, d, 2.65, 1e-2);
  State state = state_of(scene, cubic_places({12, 12, 4}, {}, {12 * d, 12 * d, 4 * d}, 0.1 * d, 3), true);
  Coupler coupler(scene);
  for (int i = 0; i < 50; ++i) coupler.step(state, 1e-3);
  EXPECT_EQ(coupler.books().on_grains, Vec3{});
  for (const Vec3& drag : coupler.drag_on_grains()) EXPECT_EQ(drag, Vec3{});
  for (int c = 0; c < 3; ++c)
    for_each_unknown_face(scene.grid, c, [&](std::size_t n) { EXPECT_EQ(state.fluid.velocity.component(c)[n], 0); });
}

class ShearedBed : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(FixedBed, ShearedBed, testing::Values(2.0, 1.0, 0.5));

TEST_P(ShearedBed, TakesTheWholeStressAndDragsNoSurfaceGrainUpstream) {
  const double d = 1e-3, nu = 1e-4, lid = 0.1;
  const double hz = GetParam() * d;
  Scene scene = fluid_scene({6, 6, static_cast<int>(12 / GetParam())}, {2 * d, 2 * d, hz}, channel, nu);
  add_grains(scene, d, 2.65, 1e-2);
  State state = state_of(scene, cubic_places({12, 12, 5}, {}, {12 * d, 12 * d, 5 * d}, 0.2 * d, 11), true);
  state.search.lid_speed = lid;
  // start from the Couette profile above the bed, then run for more than its diffusion time (7 d)^2/nu = 0.5 s
  const Scene& sc = scene;
  for_each_unknown_face(sc.grid, 0, [&](std::size_t n) {
    const double z =
        (static_cast<int>(n % static_cast<std::size_t>(sc.grid.stride(1))) - StaggeredGrid::ghosts + 0.5) * hz;
    state.fluid.velocity.component(0)[n] = lid * std::max(0.0, (z - 5 * d) / (7 * d));
  });
  Coupler coupler(scene);
  for (int i = 0; i < 400; ++i) coupler.step(state, 2e-3);
  const StepBooks& books = coupler.books();
  const double on_lid = -books.on_lid.x;   // the lid drags the fluid with this force
  EXPECT_NEAR((books.on_grains.x + books.on_bottom.x) / on_lid, 1, 0.01);
  double upstream = 0, surface_share = 0;
  for (std::size_t p = 0; p < state.grains.size(); ++p) {
    const double drag = coupler.drag_on_grains()[p].x, z = state.grains.position[p].z;
    if (drag < 0) upstream -= drag;
    if (z > 4.2 * d) {
      surface_share += drag;
      EXPECT_GT(drag, 0) << "surface grain " << p << " at z/d " << z / d;
    }
  }
  EXPECT_LE(upstream / on_lid, 0.01);
  EXPECT_GT(surface_share / on_lid, 0.5);   // most of the stress is borne at the surface, at any cell height
}

}   // namespace
}   // namespace bedload::test

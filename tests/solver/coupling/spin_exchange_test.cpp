// Torques between grains and fluid: the curl on edges, its transpose, and what a couple leaves of momentum.
#include "solver/coupling/spin_exchange.hpp"

#include <gtest/gtest.h>

#include <random>

#include "solver/coupling/void_fraction.hpp"
#include "solver/fluid/boundaries.hpp"
#include "solver/fluid/face_loops.hpp"
#include "tests/support/plain_kernel.hpp"
#include "tests/support/scenes.hpp"

namespace bedload::test {
namespace {

const Vec3 edges{1e-3, 1.5e-3, 0.7e-3};

/// Centre of a face normal to c, from its cell's indices [m].
Vec3 face_centre(int c, int i, int j, int k) {
  return {(i + (c == 0 ? 0 : 0.5)) * edges.x, (j + (c == 1 ? 0 : 0.5)) * edges.y, (k + (c == 2 ? 0 : 0.5)) * edges.z};
}

/// Visits every padded face with its centre.
template <class Visit>
void for_all_faces(const StaggeredGrid& g, Visit&& visit) {
  for (int c = 0; c < 3; ++c)
    for (int i = -2; i < g.cells[0] + 2; ++i)
      for (int j = -2; j < g.cells[1] + 2; ++j)
        for (int k = -2; k < g.cells[2] + 2; ++k) visit(c, g.index(i, j, k), face_centre(c, i, j, k));
}

double inner(const StaggeredGrid& g, const FaceFields& a, const FaceFields& b) {
  double sum = 0;
  for (int c = 0; c < 3; ++c)
    sum += sum_over_faces(g, c, [&](std::size_t n) { return a.component(c)[n] * b.component(c)[n]; });
  return sum;
}

FaceFields random_velocity(const StaggeredGrid& g, unsigned seed) {
  std::mt19937 random(seed);
  FaceFields u(g);
  for (int c = 0; c < 3; ++c)
    for_each_unknown_face(g, c, [&](std::size_t n) { u.component(c)[n] = 2.0 * random() / std::mt19937::max() - 1; });
  fill_velocity_ghosts(g, u, 0);
  return u;
}

TEST(TorqueFactor, IsStokesUpToReynolds32AndThatOfDennisBeyond) {
  EXPECT_EQ(torque_factor(0), 1);
  EXPECT_EQ(torque_factor(31), 1);
  EXPECT_NEAR(torque_factor(32), 1, 2e-3);   // where the fit begins
  // Coefficient 6.45/sqrt(Re) + 32.1/Re on rho omega^2 a^5/2, Re = a^2 omega/nu, over Stokes's 16 pi/Re.
  for (const double re : {40.0, 200.0, 4000.0}) {
    const double r = re / 4;
    EXPECT_NEAR(torque_factor(re) / ((6.45 / std::sqrt(r) + 32.1 / r) / (16 * M_PI / r)), 1, 1e-3);
  }
}

TEST(Vorticity, OfARigidRotationIsTwiceItAtEveryGrain) {
  const Scene scene = fluid_scene({5, 4, 6}, edges, periodic_box, 1e-6);
  const Vec3 omega{0.3, -1.1, 0.7};
  FaceFields u(scene.grid), vorticity(scene.grid);
  for_all_faces(scene.grid, [&](int c, std::size_t n, Vec3 x) { u.component(c)[n] = cross(omega, x)[c]; });
  find_vorticity(scene.grid, u, vorticity);
  const Vec3 sampled = sample(Stencil(scene.grid, {2.3 * edges.x, 1.9 * edges.y, 3.4 * edges.z}), Strides(scene.grid),
                              vorticity, on_x_edges);
  EXPECT_LT(norm(sampled - 2 * omega), 1e-12);
}

TEST(EdgeKernel, ReadsAConstantEverywhereAndGivesAllAway) {
  const Scene scene = fluid_scene({3, 2, 4}, edges, {Side::wall, Side::periodic, Side::wall}, 1e-6);
  const Vec3 length = scene.grid.length();
  for (const Vec3 at : {Vec3{0.01, 0.01, 0.01}, {0.99, 0.99, 0.99}, {0.5, 0.4, 0.02}}) {
    const Stencil s(scene.grid, scaled(at, length));
    FaceFields given(scene.grid), ones(scene.grid);
    deposit(s, Strides(scene.grid), {1, 2, 3}, given, on_x_edges);
    fold_deposits(scene.grid, given, on_x_edges);
    for (int t = 0; t < 3; ++t) {
      double sum = 0;
      for (int i = 0; i <= scene.grid.cells[0]; ++i)
        for (int j = 0; j < scene.grid.cells[1]; ++j)
          for (int k = 0; k <= scene.grid.cells[2]; ++k) {
            sum += given.component(t)[scene.grid.index(i, j, k)];
            ones.component(t)[scene.grid.index(i, j, k)] = 1;
          }
      EXPECT_NEAR(sum, t + 1, 1e-14);
    }
    extend_samples(scene.grid, ones, on_x_edges);
    EXPECT_LT(norm(sample(s, Strides(scene.grid), ones, on_x_edges) - Vec3{1, 1, 1}), 1e-14);
  }
}

struct SidesCase {
  std::array<Side, 3> sides;
  Top top;
  friend void PrintTo(const SidesCase& c, std::ostream* out) {
    *out << "walls " << (c.sides[0] == Side::wall) << (c.sides[1] == Side::wall) << (c.sides[2] == Side::wall)
         << (c.top == Top::free_slip ? ", free slip" : "");
  }
};
class Couples : public testing::TestWithParam<SidesCase> {};
INSTANTIATE_TEST_SUITE_P(SpinExchange, Couples,
                         testing::Values(SidesCase{periodic_box, Top::lid}, SidesCase{channel, Top::lid},
                                         SidesCase{channel, Top::free_slip}, SidesCase{closed_box, Top::lid}));

TEST_P(Couples, ActOnTheFluidAsASymmetricPositiveOperatorOfWhichTheyAreTheGradient) {
  Scene scene = fluid_scene({4, 3, 5}, edges, GetParam().sides, 1e-6);
  scene.grid.top = GetParam().top;
  const StaggeredGrid& g = scene.grid;
  const State state = state_of(scene, cubic_places({3, 3, 3}, {}, g.length(), 1e-4, 4), true);
  Stencils stencils;
  find_stencils(g, state.grains, stencils);
  const std::vector<Vec3> strength(stencils.size(), {1e-9, 1e-9, 1e-9});
  SpinExchange spin(g);
  spin.prepare(stencils, strength, std::vector<Vec3>(stencils.size()));
  const FaceFields u = random_velocity(g, 1), v = random_velocity(g, 2);
  FaceFields image_u(g), image_v(g), diagonal(g), impulse(g), vorticity(g);
  spin.add_image(u, image_u), spin.add_image(v, image_v);
  EXPECT_NEAR(inner(g, u, image_v) / inner(g, v, image_u), 1, 1e-12);
  EXPECT_GT(inner(g, u, image_u), 0);
  find_vorticity(g, u, vorticity);
  spin.add_impulse(vorticity, impulse);
  for (int c = 0; c < 3; ++c)
    for_each_unknown_face(g, c, [&](std::size_t n) {
      EXPECT_NEAR(impulse.component(c)[n], -image_u.component(c)[n], 1e-12 * std::sqrt(inner(g, image_u, image_u)));
    });
  // The diagonal: the image of one face alone.
  spin.add_diagonal(diagonal);
  for (const int c : {0, 1, 2}) {
    FaceFields one(g), image(g);
    const std::size_t n = g.index(1, 1, 1);
    one.component(c)[n] = 1;
    fill_velocity_ghosts(g, one, 0);
    spin.add_image(one, image);
    EXPECT_NEAR(image.component(c)[n] / diagonal.component(c)[n], 1, 1e-12) << c;
  }
}

TEST(Couples, LeaveLinearMomentumAndGiveTheOppositeAngularMomentum) {
  // Inside the box, away from its seams: angular momentum about any point.
  const Scene scene = fluid_scene({8, 8, 8}, edges, periodic_box, 1e-6);
  const StaggeredGrid& g = scene.grid;
  const State state = state_of(
      scene, {{4.2 * edges.x, 3.7 * edges.y, 4.9 * edges.z}, {3.1 * edges.x, 4.4 * edges.y, 3.6 * edges.z}}, true);
  Stencils stencils;
  find_stencils(g, state.grains, stencils);
  const std::vector<Vec3> strength{{2e-9, 1e-9, 4e-9}, {3e-9, 5e-9, 2e-9}};
  const std::vector<Vec3> spin_of{{5, -2, 1}, {0.5, 3, -4}};
  SpinExchange spin(g);
  spin.prepare(stencils, strength, spin_of);
  FaceFields impulse(g);
  spin.add_impulse(FaceFields(g), impulse);   // fluid at rest: each grain loses strength x spin
  Vec3 linear, angular, expected;
  double scale = 0;
  for_all_faces(g, [&](int c, std::size_t n, Vec3 x) {
    Vec3 f;
    f[c] = g.cell_volume() * impulse.component(c)[n];
    linear += f, angular += cross(x, f), scale += norm(f);
  });
  for (int p : {0, 1}) expected += scaled(strength[p], spin_of[p]);
  EXPECT_LT(norm(linear) / scale, 1e-14);
  EXPECT_LT(norm(angular - expected) / norm(expected), 1e-12);
}

}   // namespace
}   // namespace bedload::test

#include "solver/fluid/boundaries.hpp"

#include <gtest/gtest.h>

#include "fields.hpp"
#include "solver/fluid/operators.hpp"

namespace bedload {
namespace {

using namespace test;

int wrapped(int i, int n) { return ((i % n) + n) % n; }

TEST(Boundaries, CopyPeriodicallyEvenWhereTheBoxIsOneOrTwoCellsWide) {
  for (std::array<int, 3> cells : {std::array{1, 2, 3}, std::array{5, 1, 2}, std::array{2, 4, 1}}) {
    const StaggeredGrid g{cells, {1, 1, 1}, {periodic, periodic, periodic}};
    FaceFields u = random_faces(g, 1, -1, 1), flux = u;
    Field<Centre> q = random_centres(g, 2, -1, 1);
    fill_velocity_ghosts(g, u, 7);
    fill_face_ghosts(g, flux);
    fill_centre_ghosts(g, q);
    EXPECT_EQ(u, flux);
    for_each_stored(g, [&](int i, int j, int k) {
      const std::size_t n = g.index(i, j, k);
      const std::size_t source = g.index(wrapped(i, cells[0]), wrapped(j, cells[1]), wrapped(k, cells[2]));
      EXPECT_EQ(q[n], q[source]);
      for (int c = 0; c < 3; ++c) EXPECT_EQ(u.component(c)[n], u.component(c)[source]);
    });
  }
}

TEST(Boundaries, ExtendACouetteFlowLinearlyBeyondBottomAndLid) {
  for (int nz : {1, 2, 7}) {
    const StaggeredGrid g{{3, 2, nz}, {1, 1, 0.5}, {periodic, periodic, wall}, Top::lid};
    const double height = g.length().z;
    const auto couette = [&](Vec3 x) { return Vec3{3 * x.z / height, 0, 0}; };
    const FaceFields expected = on_faces(g, couette);
    FaceFields u(g);
    for_each_face_row(
        g, 0, [&](std::size_t row, int length) { std::copy_n(expected.x.data() + row, length, u.x.data() + row); });
    fill_velocity_ghosts(g, u, 3);
    for_each_stored(g, [&](int i, int j, int k) {
      EXPECT_NEAR(u.x[g.index(i, j, k)], expected.x[g.index(i, j, k)], 1e-14) << "nz " << nz << " k " << k;
    });
  }
}

TEST(Boundaries, ReflectAPlugFlowAtAFreeSlipTopAndReverseItAtTheBottom) {
  const StaggeredGrid g{{3, 2, 4}, {1, 1, 1}, {periodic, periodic, wall}, Top::free_slip};
  FaceFields u = on_faces(g, [](Vec3) { return Vec3{2, -1, 0}; });
  fill_velocity_ghosts(g, u, 5);   // the lid's speed has no say
  for (int k : {4, 5}) {
    EXPECT_EQ(u.x[g.index(1, 1, k)], 2);
    EXPECT_EQ(u.y[g.index(1, 1, k)], -1);
  }
  for (int k : {-1, -2}) {
    EXPECT_EQ(u.x[g.index(1, 1, k)], -2);
    EXPECT_EQ(u.y[g.index(1, 1, k)], 1);
  }
}

TEST(Boundaries, LetNothingPassThroughAWall) {
  const StaggeredGrid g{{4, 3, 5}, {1, 1, 1}, {wall, wall, wall}, Top::lid};
  FaceFields u = random_faces(g, 3, -1, 1);
  fill_velocity_ghosts(g, u, 2);
  for (int m = 0; m < 3; ++m) {
    EXPECT_EQ(u.x[g.index(0, m, m)], 0);
    EXPECT_EQ(u.x[g.index(4, m, m)], 0);
    EXPECT_EQ(u.y[g.index(m, 0, m)], 0);
    EXPECT_EQ(u.y[g.index(m, 3, m)], 0);
    EXPECT_EQ(u.z[g.index(m, m, 0)], 0);
    EXPECT_EQ(u.z[g.index(m, m, 5)], 0);
    EXPECT_EQ(u.x[g.index(-1, m, m)], -u.x[g.index(1, m, m)]);
    EXPECT_EQ(u.x[g.index(-2, m, m)], -u.x[g.index(2, m, m)]);
    EXPECT_EQ(u.z[g.index(m, m, 6)], -u.z[g.index(m, m, 4)]);
  }
}

TEST(Boundaries, GivePressureNoGradientAtAWall) {
  const StaggeredGrid g{{4, 3, 5}, {1, 1, 1}, {wall, periodic, wall}, Top::free_slip};
  Field<Centre> q = random_centres(g, 4, -1, 1);
  fill_centre_ghosts(g, q);
  EXPECT_EQ(q[g.index(-1, 1, 2)], q[g.index(0, 1, 2)]);
  EXPECT_EQ(q[g.index(5, 1, 2)], q[g.index(2, 1, 2)]);
  EXPECT_EQ(q[g.index(2, 1, 5)], q[g.index(2, 1, 4)]);
}

TEST(Boundaries, CloseFluxesForTheirDivergence) {
  for (const std::array sides : {std::array{periodic, periodic, periodic}, std::array{wall, periodic, wall},
                                 std::array{periodic, wall, periodic}}) {
    const StaggeredGrid g{{4, 3, 5}, {1, 2, 0.5}, sides};
    const FaceFields flux = random_faces(g, 5, -1, 1);
    FaceFields filled = flux, closed = flux;
    fill_face_ghosts(g, filled);
    close_faces(g, closed);
    Field<Centre> expected(g), div(g);
    divergence(g, filled, expected);
    divergence(g, closed, div);
    EXPECT_EQ(div, expected);
  }
}

}   // namespace
}   // namespace bedload

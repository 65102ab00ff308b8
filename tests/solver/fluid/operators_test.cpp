#include "solver/fluid/operators.hpp"

#include <gtest/gtest.h>

#include "fields.hpp"
#include "solver/fluid/boundaries.hpp"

namespace bedload {
namespace {

using namespace test;

const StaggeredGrid flat_box{{5, 4, 6}, {0.4, 0.3, 0.1}, {periodic, wall, wall}, Top::lid};

/// A function of degree two with all mixed terms; its derivatives by hand.
double quadratic(Vec3 x) { return 1 + x.x * x.x - 2 * x.y * x.y + 3 * x.z * x.z + x.x * x.y - x.y * x.z + 4 * x.z; }
Vec3 slope(Vec3 x) { return {2 * x.x + x.y, -4 * x.y + x.x - x.z, 6 * x.z - x.y + 4}; }

TEST(Operators, GradientIsExactForQuadratics) {
  FaceFields out(flat_box);
  gradient(flat_box, on_centres(flat_box, quadratic), out);
  const FaceFields exact = on_faces(flat_box, slope);
  for (int c = 0; c < 3; ++c)
    for_each_unknown_face(flat_box, c,
                          [&](std::size_t n) { EXPECT_NEAR(out.component(c)[n], exact.component(c)[n], 1e-13); });
}

TEST(Operators, GradientVanishesOnWalls) {
  FaceFields out(flat_box, 9);
  gradient(flat_box, random_centres(flat_box, 1, -1, 1), out);
  EXPECT_EQ(out.y[flat_box.index(2, 0, 3)], 0);
  EXPECT_EQ(out.y[flat_box.index(2, 4, 3)], 0);
  EXPECT_EQ(out.z[flat_box.index(2, 2, 0)], 0);
  EXPECT_EQ(out.z[flat_box.index(2, 2, 6)], 0);
}

TEST(Operators, DivergenceIsExactForFluxesOfDegreeTwoAlongTheirOwnDirection) {
  Field<Centre> out(flat_box);
  divergence(flat_box,
             on_faces(flat_box,
                      [](Vec3 x) {
                        return Vec3{x.x * x.x + x.y, x.y * x.z, -x.z * x.z + x.x};
                      }),
             out);
  const Field<Centre> exact = on_centres(flat_box, [](Vec3 x) { return 2 * x.x + x.z - 2 * x.z; });
  for_each_cell_row(flat_box, [&](std::size_t row, int length) {
    for (std::size_t n = row; n < row + length; ++n) EXPECT_NEAR(out[n], exact[n], 1e-13);
  });
}

TEST(Operators, LaplacianIsExactForQuadratics) {
  FaceFields out(flat_box);
  laplacian(flat_box,
            on_faces(flat_box,
                     [](Vec3 x) {
                       return Vec3{quadratic(x), 2 * quadratic(x), -quadratic(x)};
                     }),
            out);
  const double exact[] = {4, 8, -4};
  for (int c = 0; c < 3; ++c)
    for_each_unknown_face(flat_box, c, [&](std::size_t n) { EXPECT_NEAR(out.component(c)[n], exact[c], 1e-11); });
}

/// <a, b> over cells or unknown faces.
double product(const StaggeredGrid& g, const Field<Centre>& a, const Field<Centre>& b) {
  return sum_over_cells(g, [&](std::size_t n) { return a[n] * b[n]; });
}
double product(const StaggeredGrid& g, const FaceFields& a, const FaceFields& b) {
  double sum = 0;
  for (int c = 0; c < 3; ++c)
    sum += sum_over_faces(g, c, [&](std::size_t n) { return a.component(c)[n] * b.component(c)[n]; });
  return sum;
}

TEST(Operators, GradientIsMinusTheTransposeOfDivergence) {
  for (Side y : {periodic, wall}) {
    const StaggeredGrid g{{3, 5, 4}, {0.4, 0.3, 0.1}, {periodic, y, wall}};
    Field<Centre> q = random_centres(g, 1, -1, 1), div(g);
    FaceFields flux = random_faces(g, 2, -1, 1), grad(g);
    clear_walls(g, flux);
    fill_face_ghosts(g, flux);
    fill_centre_ghosts(g, q);
    gradient(g, q, grad);
    divergence(g, flux, div);
    const double forward = product(g, grad, flux), backward = product(g, q, div);
    EXPECT_NEAR(forward, -backward, 1e-12 * std::abs(forward));
  }
}

TEST(Operators, LaplacianBetweenWallsAtRestIsSymmetricAndDissipates) {
  const StaggeredGrid g{{4, 3, 5}, {0.4, 0.3, 0.1}, {wall, periodic, wall}};
  FaceFields a = random_faces(g, 1, -1, 1), b = random_faces(g, 2, -1, 1), lap_a(g), lap_b(g);
  fill_velocity_ghosts(g, a, 0);
  fill_velocity_ghosts(g, b, 0);
  laplacian(g, a, lap_a);
  laplacian(g, b, lap_b);
  const double forward = product(g, a, lap_b);
  EXPECT_NEAR(forward, product(g, b, lap_a), 1e-12 * std::abs(forward));
  EXPECT_LT(product(g, a, lap_a), 0);
}

/// Largest error of the Laplacian of a wave that fills a periodic box of n cells.
double laplacian_error(int n) {
  const StaggeredGrid g{{n, 1, n}, {1.0 / n, 1, 1.0 / n}, {periodic, periodic, periodic}};
  const double k = 2 * M_PI;
  FaceFields u = on_faces(g,
                          [&](Vec3 x) {
                            return Vec3{std::sin(k * x.x) * std::cos(k * x.z), 0, std::cos(k * x.x)};
                          }),
             lap(g);
  laplacian(g, u, lap);
  double worst = 0;
  for_each_unknown_face(g, 0, [&](std::size_t m) { worst = std::max(worst, std::abs(lap.x[m] + 2 * k * k * u.x[m])); });
  for_each_unknown_face(g, 2, [&](std::size_t m) { worst = std::max(worst, std::abs(lap.z[m] + k * k * u.z[m])); });
  return worst;
}

TEST(Operators, LaplacianIsOfSecondOrder) { EXPECT_GT(std::log2(laplacian_error(16) / laplacian_error(32)), 1.95); }

TEST(Operators, WallShearOfACouetteFlowDragsTheBottomAlongAndTheLidBack) {
  const StaggeredGrid g{{4, 3, 8}, {0.4, 0.3, 0.1}, {periodic, periodic, wall}, Top::lid};
  const double height = g.length().z, area = g.length().x * g.length().y, nu = 0.02;
  FaceFields u = on_faces(g, [&](Vec3 x) { return Vec3{5 * x.z / height, 0, 0}; });
  fill_velocity_ghosts(g, u, 5);
  const WallShear shear = wall_shear(g, u, nu);
  EXPECT_NEAR(shear.bottom.x, nu * 5 / height * area, 1e-14);
  EXPECT_NEAR(shear.top.x, -nu * 5 / height * area, 1e-14);
  EXPECT_EQ(shear.bottom.y, 0);
}

TEST(Operators, WallShearVanishesAtAFreeSlipTop) {
  const StaggeredGrid g{{4, 3, 8}, {0.4, 0.3, 0.1}, {periodic, periodic, wall}, Top::free_slip};
  FaceFields u = random_faces(g, 5, -1, 1);
  fill_velocity_ghosts(g, u, 5);
  EXPECT_EQ(wall_shear(g, u, 1).top, Vec3{});
}

}   // namespace
}   // namespace bedload

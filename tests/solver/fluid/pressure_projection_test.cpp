#include "solver/fluid/pressure_projection.hpp"

#include <gtest/gtest.h>

#include <fmt/core.h>

#include <limits>
#include <tuple>

#include "fields.hpp"
#include "solver/fluid/boundaries.hpp"
#include "solver/fluid/operators.hpp"
#include "tests/support/bed_coefficient.hpp"
#include "tests/support/dense_pressure.hpp"

namespace bedload {
namespace {

using namespace test;

/// |div(c grad p) - rhs| per |rhs|, with the mean of rhs removed, by the operators of the fluid.
double true_residual(const StaggeredGrid& g, const FaceFields& c, const Field<Centre>& rhs, const Field<Centre>& p) {
  FaceFields flux(g);
  Field<Centre> div(g);
  gradient(g, p, flux);
  for (int m = 0; m < 3; ++m)
    for_each_unknown_face(g, m, [&](std::size_t n) { flux.component(m)[n] *= c.component(m)[n]; });
  fill_face_ghosts(g, flux);
  divergence(g, flux, div);
  const double mean = sum_over_cells(g, [&](std::size_t n) { return rhs[n]; }) / g.cell_count();
  const double left = sum_over_cells(g, [&](std::size_t n) { return std::pow(div[n] - rhs[n] + mean, 2); });
  return std::sqrt(left / sum_over_cells(g, [&](std::size_t n) { return std::pow(rhs[n] - mean, 2); }));
}

TEST(PressureSolver, AgreesWithADenseSolveInBoxesOfEveryKind) {
  const StaggeredGrid boxes[] = {
      {{4, 4, 4}, {1, 1, 1}, {periodic, periodic, periodic}},   {{5, 3, 7}, {1, 1, 1}, {periodic, periodic, wall}},
      {{7, 5, 9}, {1, 2, 0.5}, {periodic, periodic, periodic}}, {{6, 7, 5}, {0.1, 0.2, 0.3}, {wall, wall, wall}},
      {{9, 1, 13}, {1, 1, 1}, {wall, periodic, wall}},          {{1, 1, 11}, {1, 1, 1}, {periodic, periodic, wall}},
      {{2, 3, 40}, {4, 4, 1}, {periodic, wall, periodic}},      {{1, 1, 1}, {1, 1, 1}, {periodic, periodic, wall}},
  };
  for (const StaggeredGrid& g : boxes) {
    const FaceFields c = random_faces(g, 1, 0.05, 1);
    const Field<Centre> rhs = random_centres(g, 2, -1, 1);
    Field<Centre> p(g);
    PressureSolver solver(g);
    const PressureSolve solve = solver.solve(c, rhs, p, 1e-12, 0);
    const std::string name = fmt::format("{} x {} x {}", g.cells[0], g.cells[1], g.cells[2]);
    EXPECT_TRUE(solve.converged) << name;
    const Eigen::VectorXd exact = dense_pressure(g, c, rhs);
    const double tolerance = 1e-9 * (exact.cwiseAbs().maxCoeff() + 1);
    Eigen::Index m = 0;
    for_each_cell_row(g, [&](std::size_t row, int length) {
      for (int k = 0; k < length; ++k, ++m) EXPECT_NEAR(p[row + k], exact(m), tolerance) << name;
    });
  }
}

TEST(PressureSolver, ReportsTheResidualThatIsThereAndMeetsItsTolerance) {
  const StaggeredGrid g{{12, 9, 15}, {1, 1, 0.5}, {periodic, periodic, wall}};
  const FaceFields c = random_faces(g, 1, 0.1, 1);
  const Field<Centre> rhs = random_centres(g, 2, 0, 1);
  for (double tolerance : {1e-2, 1e-5, 1e-11}) {
    Field<Centre> p(g);
    const PressureSolve solve = PressureSolver(g).solve(c, rhs, p, tolerance, 0);
    EXPECT_LE(solve.residual, tolerance);
    EXPECT_NEAR(true_residual(g, c, rhs, p), solve.residual, 1e-3 * solve.residual + 1e-14);
    EXPECT_NEAR(sum_over_cells(g, [&](std::size_t n) { return p[n]; }) / g.cell_count(), 0, 1e-14);
  }
}

TEST(PressureSolver, StopsAtTheAbsoluteToleranceToo) {
  const StaggeredGrid g{{12, 9, 15}, {1, 1, 1}, {periodic, periodic, wall}};
  const FaceFields c(g, 1);
  const Field<Centre> rhs = random_centres(g, 2, -1e-6, 1e-6);
  Field<Centre> p(g);
  PressureSolver solver(g);
  EXPECT_EQ(solver.solve(c, rhs, p, 0, 1e-5).iterations, 0);
  EXPECT_GT(solver.solve(c, rhs, p, 0, 1e-8).iterations, 0);
}

TEST(PressureSolver, LeavesFluidWithoutDivergenceExactlyAtRest) {
  const StaggeredGrid g{{8, 8, 8}, {1, 1, 1}, {periodic, periodic, wall}};
  Field<Centre> p(g);
  const PressureSolve solve = PressureSolver(g).solve(random_faces(g, 1, 0.1, 1), Field<Centre>(g), p, 1e-8, 0);
  EXPECT_TRUE(solve.converged);
  EXPECT_EQ(solve.iterations, 0);
  EXPECT_EQ(p, Field<Centre>(g));
}

TEST(PressureSolver, ReadsNoCoefficientOnWallsAndNoGhosts) {
  const StaggeredGrid g{{6, 8, 10}, {1, 1, 1}, {periodic, wall, wall}};
  FaceFields c(g, std::nan(""));
  const FaceFields plain = random_faces(g, 1, 0.1, 1);
  for (int m = 0; m < 3; ++m)
    for_each_unknown_face(g, m, [&](std::size_t n) { c.component(m)[n] = plain.component(m)[n]; });
  const Field<Centre> rhs = random_centres(g, 2, -1, 1);
  Field<Centre> p(g), again(g);
  PressureSolver(g).solve(c, rhs, p, 1e-8, 0);
  PressureSolver(g).solve(plain, rhs, again, 1e-8, 0);
  EXPECT_EQ(p, again);
}

TEST(PressureSolver, RemembersNothingOfEarlierSolvesNotEvenOfOnesThatFailed) {
  const StaggeredGrid g{{13, 8, 18}, {1, 1, 0.5}, {periodic, periodic, wall}};
  const FaceFields c = random_faces(g, 1, 0.01, 1);
  const Field<Centre> rhs = random_centres(g, 2, -1, 1);
  Field<Centre> fresh(g), used(g), other(g);
  PressureSolver(g).solve(c, rhs, fresh, 1e-9, 0);
  PressureSolver solver(g);
  solver.solve(random_faces(g, 5, 0.1, 1), random_centres(g, 6, -1, 1), other, 1e-4, 0);
  FaceFields broken = c;
  for_each_unknown_face(g, 0, [&](std::size_t n) { broken.x[n] = std::nan(""); });
  EXPECT_FALSE(solver.solve(broken, rhs, other, 1e-4, 0).converged);
  solver.solve(c, rhs, used, 1e-9, 0);
  EXPECT_EQ(fresh, used);
}

TEST(PressureSolver, SolvesWithAMatrixThatItHasAlreadyAsIfItWereNew) {
  for (const int nx : {12, 13}) {   // without and with cells of one colour that meet at a seam
    const StaggeredGrid g{{nx, 8, 18}, {1, 1, 0.5}, {periodic, periodic, wall}};
    const FaceFields c = random_faces(g, 1, 0.01, 1);
    const Field<Centre> rhs = random_centres(g, 2, -1, 1);
    Field<Centre> fresh(g), used(g), other(g), lost(g);
    PressureSolver(g).solve(c, rhs, fresh, 1e-9, 0);
    PressureSolver solver(g);
    EXPECT_TRUE(solver.solve(c, random_centres(g, 6, -3, 5), other, 1e-7, 0).converged);
    solver.solve(c, rhs, used, 1e-9, 0);
    EXPECT_EQ(fresh, used);
    Field<Centre> endless = rhs;
    endless[g.index(3, 3, 3)] = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(solver.solve(c, endless, lost, 1e-9, 0).converged);
    used = Field<Centre>(g);
    solver.solve(c, rhs, used, 1e-9, 0);
    EXPECT_EQ(fresh, used);
  }
}

TEST(PressureSolver, FindsTheSameWhateverStoodWhereTheSolutionGoes) {
  const StaggeredGrid g{{10, 8, 12}, {1, 1, 1}, {periodic, periodic, periodic}};
  const FaceFields c = random_faces(g, 1, 0.1, 1);
  const Field<Centre> rhs = random_centres(g, 2, -1, 1);
  Field<Centre> zero(g), nothing(g, std::nan(""));
  PressureSolver solver(g);
  solver.solve(c, rhs, zero, 1e-9, 0);
  solver.solve(c, rhs, nothing, 1e-9, 0);
  EXPECT_EQ(zero, nothing);
  EXPECT_EQ(solver.solve(c, rhs, nothing, 1, 0).iterations, 0);
  EXPECT_EQ(nothing, Field<Centre>(g));
}

TEST(PressureSolver, WorksAtTheScaleOfMicronsAsAtTheScaleOfMetres) {
  for (double h : {1e-6, 1.0, 1e3}) {
    const StaggeredGrid g{{16, 16, 16}, {h, h, h}, {periodic, periodic, wall}};
    for (double size : {1e-30, 1e30}) {
      Field<Centre> p(g);
      const FaceFields c = random_faces(g, 1, 0.1 * size, size);
      const PressureSolve solve = PressureSolver(g).solve(c, random_centres(g, 2, -size, size), p, 1e-8, 0);
      EXPECT_TRUE(solve.converged);
      EXPECT_LE(solve.iterations, 17);
    }
  }
}

class PressureSolverOverABed : public testing::TestWithParam<std::tuple<Bed, double, double, std::array<int, 3>>> {};

TEST_P(PressureSolverOverABed, NeedsAtMost17IterationsTo1em8) {
  const auto [bed, contrast, flatness, cells] = GetParam();
  const StaggeredGrid g{cells, {1, 1, 1 / flatness}, {periodic, periodic, wall}};
  const FaceFields c = bed_coefficient(g, bed, contrast);
  const Field<Centre> rhs = random_centres(g, 2, -1, 1);
  Field<Centre> p(g);
  const PressureSolve solve = PressureSolver(g).solve(c, rhs, p, 1e-8, 0);
  EXPECT_LE(solve.iterations, 17);
  EXPECT_TRUE(solve.converged);
  EXPECT_NEAR(true_residual(g, c, rhs, p), solve.residual, 0.01 * solve.residual);
}

INSTANTIATE_TEST_SUITE_P(Table, PressureSolverOverABed,
                         testing::Combine(testing::Values(Bed::sharp_plane, Bed::rough_surface, Bed::dunes,
                                                          Bed::random_cells),
                                          testing::Values(2.5, 1e2, 1e4), testing::Values(1.0, 4.0),
                                          testing::Values(std::array{32, 32, 40}, std::array{21, 12, 27})));
// Where poorly coupled columns run long, and where the coarse level must not be softer than the fine one.
INSTANTIATE_TEST_SUITE_P(Large, PressureSolverOverABed,
                         testing::Values(std::tuple{Bed::random_cells, 1e4, 4.0, std::array{100, 100, 60}},
                                         std::tuple{Bed::rough_surface, 1e4, 4.0, std::array{64, 64, 64}}));

TEST(PressureSolver, SolvesColumnsDirectly) {
  for (const int nz : {200, 201})
    for (const Side side : {wall, periodic}) {
      const StaggeredGrid g{{1, 1, nz}, {1, 1, 1}, {periodic, periodic, side}};
      Field<Centre> p(g);
      const PressureSolve solve =
          PressureSolver(g).solve(bed_coefficient(g, Bed::random_cells, 1e4), random_centres(g, 2, -1, 1), p, 1e-8, 0);
      EXPECT_TRUE(solve.converged);
      EXPECT_LE(solve.iterations, 5);   // single precision: 1e-4 at a time
    }
}

}   // namespace
}   // namespace bedload

#include "solver/fluid/multigrid.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "fields.hpp"
#include "solver/fluid/boundaries.hpp"

namespace bedload {
namespace {

using namespace test;

template <class Visit>
void for_each_cell(const StaggeredGrid& g, Visit&& visit) {
  for (int i = 0; i < g.cells[0]; ++i)
    for (int j = 0; j < g.cells[1]; ++j)
      for (int k = 0; k < g.cells[2]; ++k) visit(i, j, k);
}

/// z, and r.z as the cycle tells it.
std::pair<Field<Centre>, double> preconditioned(const StaggeredGrid& g, Multigrid& multigrid, const Field<Centre>& r) {
  Field<Centre> z(g);
  const SplitGrid& at = multigrid.layout();
  for_each_cell(g, [&](int i, int j, int k) {
    multigrid.right_hand_side()[at.at(i, j, k)] = static_cast<float>(r[g.index(i, j, k)]);
  });
  const double product = multigrid.cycle();
  for_each_cell(g, [&](int i, int j, int k) { z[g.index(i, j, k)] = multigrid.solution()[at.at(i, j, k)]; });
  return {z, product};
}

Field<Centre> without_mean(const StaggeredGrid& g, Field<Centre> f) {
  const double mean = sum_over_cells(g, [&](std::size_t n) { return f[n]; }) / g.cell_count();
  for (double& x : f.values) x -= mean;
  return f;
}

TEST(Multigrid, CycleIsSymmetricAndPositiveEvenAcrossOddPeriodicSeams) {
  for (std::array<int, 3> cells :
       {std::array{16, 16, 16}, std::array{11, 9, 13}, std::array{6, 17, 9}, std::array{3, 1, 50}})
    for (Side z : {wall, periodic}) {
      const StaggeredGrid g{cells, {1, 1, 0.6}, {periodic, periodic, z}};
      FaceFields w = random_faces(g, 3, 0.01, 1);
      clear_walls(g, w);
      fill_face_ghosts(g, w);
      Multigrid multigrid(g);
      multigrid.set_couplings(w, 1);
      const Field<Centre> a = without_mean(g, random_centres(g, 1, -1, 1)),
                          b = without_mean(g, random_centres(g, 2, -1, 1));
      const auto [ma, a_ma] = preconditioned(g, multigrid, a);
      const auto [mb, b_mb] = preconditioned(g, multigrid, b);
      const auto product = [&](const Field<Centre>& p, const Field<Centre>& q) {
        return sum_over_cells(g, [&](std::size_t n) { return p[n] * q[n]; });
      };
      const double size = std::sqrt(product(a, ma) * product(b, mb));
      EXPECT_GT(product(a, ma), 0);
      EXPECT_NEAR(product(a, ma), a_ma, 1e-6 * a_ma);
      EXPECT_NEAR(product(b, mb), b_mb, 1e-6 * b_mb);
      EXPECT_NEAR(product(a, mb), product(b, ma), 2e-6 * size) << cells[0] << " x " << cells[1] << " x " << cells[2];
    }
}

TEST(Multigrid, AppliesTheOperatorThatItSolves) {
  for (std::array<int, 3> cells : {std::array{8, 6, 10}, std::array{5, 7, 9}, std::array{3, 1, 12}})
    for (Side side : {wall, periodic}) {
      const StaggeredGrid g{cells, {1, 1, 0.6}, {side, side, side}};
      FaceFields w = random_faces(g, 3, 0.01, 1);
      clear_walls(g, w);
      fill_face_ghosts(g, w);
      Multigrid multigrid(g);
      multigrid.set_couplings(w, 1);
      Field<Centre> x = random_centres(g, 1, -1, 1);
      fill_centre_ghosts(g, x);
      const SplitGrid& at = multigrid.layout();
      std::vector<float> field(at.size()), image(at.size());
      for_each_cell(g, [&](int i, int j, int k) { field[at.at(i, j, k)] = static_cast<float>(x[g.index(i, j, k)]); });
      for (int i = 0; i < g.cells[0]; ++i) at.wrap_cells(field.data(), i), at.wrap_rows(field.data(), i);
      at.wrap_planes(field.data());
      double product = 0;
      for (int i = 0; i < g.cells[0]; ++i) product += multigrid.apply(i, field.data(), image.data());
      double expected = 0;
      for_each_cell(g, [&](int i, int j, int k) {
        const std::size_t n = g.index(i, j, k);
        double sum = 0;
        for (int c = 0; c < 3; ++c) {
          if (g.cells[c] == 1) continue;
          const std::size_t s = g.stride(c);
          sum += w.component(c)[n] * (x[n] - x[n - s]) + w.component(c)[n + s] * (x[n] - x[n + s]);
        }
        EXPECT_NEAR(image[at.at(i, j, k)], sum, 5e-6) << i << ", " << j << ", " << k;
        expected += x[n] * sum;
      });
      EXPECT_NEAR(product, expected, 1e-5 * expected);
    }
}

}   // namespace
}   // namespace bedload

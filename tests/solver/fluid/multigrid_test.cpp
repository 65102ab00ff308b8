#include "solver/fluid/multigrid.hpp"

#include <gtest/gtest.h>

#include "fields.hpp"
#include "solver/fluid/boundaries.hpp"

namespace bedload {
namespace {

using namespace test;

Field<Centre> preconditioned(const StaggeredGrid& g, Multigrid& multigrid, const Field<Centre>& r) {
  Field<Centre> z(g);
  for (int i = 0; i < g.cells[0]; ++i)
    for (int j = 0; j < g.cells[1]; ++j) multigrid.set_right_hand_side(i, j, r.data() + g.index(i, j, 0), 1);
  multigrid.cycle();
  for (int i = 0; i < g.cells[0]; ++i)
    for (int j = 0; j < g.cells[1]; ++j) multigrid.get_solution(i, j, &z[g.index(i, j, 0)]);
  return z;
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
      multigrid.set_couplings(w);
      const Field<Centre> a = without_mean(g, random_centres(g, 1, -1, 1)),
                          b = without_mean(g, random_centres(g, 2, -1, 1));
      const Field<Centre> ma = preconditioned(g, multigrid, a), mb = preconditioned(g, multigrid, b);
      const auto product = [&](const Field<Centre>& p, const Field<Centre>& q) {
        return sum_over_cells(g, [&](std::size_t n) { return p[n] * q[n]; });
      };
      const double size = std::sqrt(product(a, ma) * product(b, mb));
      EXPECT_GT(product(a, ma), 0);
      EXPECT_NEAR(product(a, mb), product(b, ma), 2e-6 * size) << cells[0] << " x " << cells[1] << " x " << cells[2];
    }
}

}   // namespace
}   // namespace bedload

// Woven fields against the plain kernel: the same weights, the same homes beyond the sides.
#include "solver/coupling/void_fraction.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/plain_kernel.hpp"
#include "tests/support/scenes.hpp"

namespace bedload::test {
namespace {

using Sides = std::array<Side, 3>;

struct Box {
  std::array<int, 3> cells;
  Sides sides;
  On where;
};

class WovenFields : public testing::TestWithParam<Box> {
 protected:
  WovenFields() : field(grid()), cells(grid()) {
    for (int c = 0; c < 3; ++c)
      for (double *v = field.component(c), *end = v + grid().padded_size(); v != end; ++v) *v = unit(random);
    for (double& v : cells.values) v = unit(random);
  }
  StaggeredGrid grid() const {
    StaggeredGrid g;
    g.cells = GetParam().cells, g.sides = GetParam().sides, g.h = {2e-3, 1.5e-3, 0.5e-3};
    return g;
  }
  int first() const { return static_cast<int>(GetParam().where); }
  Stencils stencils_of(std::vector<Vec3> fractions) const {
    Grains grains;
    grains.resize(fractions.size());
    for (std::size_t p = 0; p < fractions.size(); ++p) grains.position[p] = scaled(fractions[p], grid().length());
    Stencils stencils;
    find_stencils(grid(), grains, stencils);
    return stencils;
  }
  template <On where>
  Quad sampled(const Stencil& s, const Woven& woven) const {
    return sample(Weights<where>(s), Strides(grid()), woven.at(s));
  }

  std::mt19937 random{7};
  std::uniform_real_distribution<double> unit{-1, 1};
  FaceFields field;
  Field<Centre> cells;
};

constexpr Side p = Side::periodic, w = Side::wall;
INSTANTIATE_TEST_SUITE_P(Kernel, WovenFields,
                         testing::Values(Box{{5, 4, 7}, {p, p, p}, On::faces}, Box{{5, 4, 7}, {w, w, w}, On::faces},
                                         Box{{5, 4, 7}, {p, p, w}, On::faces}, Box{{3, 1, 2}, {p, p, w}, On::faces},
                                         Box{{5, 4, 7}, {p, w, w}, On::edges}, Box{{2, 5, 3}, {w, p, p}, On::edges}));

const std::vector<Vec3> everywhere = {{0, 0, 0}, {0.01, 0.99, 0.5}, {0.5, 0.5, 0.5},    {0.999, 0.999, 0.999},
                                      {1, 1, 1}, {0.3, 0.02, 0.97}, {0.62, 0.41, 0.13}, {0.5, 0.7, 0.004}};

TEST_P(WovenFields, AreReadAsThePlainKernelReads) {
  const StaggeredGrid g = grid();
  const bool edges = GetParam().where == On::edges;
  FaceFields extended = field;
  Field<Centre> extended_cells = cells;
  extend_samples(g, extended, first()), extend_samples(g, extended_cells);
  for (const Vec3 at : everywhere) {
    const Stencils alone = stencils_of({at});
    Woven woven(g, GetParam().where);
    woven.read(alone.reach, field, edges ? nullptr : &cells);
    const Quad read = edges ? sampled<On::edges>(alone[0], woven) : sampled<On::faces>(alone[0], woven);
    EXPECT_LT(norm(on_faces(read) - sample(alone[0], Strides(g), extended, first())), 1e-15);
    if (edges) continue;
    EXPECT_NEAR(in_cell(read), sample(alone[0], Strides(g), on_cells, extended_cells.data()), 1e-15);
  }
}

TEST_P(WovenFields, SettleWhereThePlainKernelFolds) {
  const StaggeredGrid g = grid();
  const Strides stride(g);
  const bool edges = GetParam().where == On::edges;
  Deposited settled(g);
  Woven woven(g, GetParam().where);
  // One deposit after the other into the same field: what the last one left must not stay.
  for (const std::vector<Vec3>& places : {everywhere, {everywhere[6]}, {everywhere[1], everywhere[5]}, {}}) {
    const Stencils stencils = stencils_of(places);
    FaceFields plain(g);
    woven.clear(stencils.reach);
    for (const Stencil& s : stencils) {
      const Vec3 amount{unit(random), unit(random), unit(random)};
      deposit(s, stride, amount, plain, first());
      if (edges) deposit(Weights<On::edges>(s), stride, quad(amount), woven.at(s));
      else deposit(Weights<On::faces>(s), stride, quad(amount), woven.at(s));
    }
    fold_deposits(g, plain, first());
    woven.settle(settled);
    for (int c = 0; c < 3; ++c)
      for_each_row(g, whole(g), [&](std::size_t row, int length) {
        for (std::size_t n = row; n < row + length; ++n)
          EXPECT_NEAR(settled.component(c)[n], plain.component(c)[n], 1e-15);
      });
  }
}

}   // namespace
}   // namespace bedload::test

#include "solver/fluid/rows.hpp"

#include <gtest/gtest.h>

#include "fields.hpp"

namespace bedload {
namespace {

using namespace test;

TEST(Rows, SumEveryCellOnceWhateverTheLengthOfARow) {
  for (int nz = 1; nz <= 20; ++nz) {
    const StaggeredGrid g{{3, 2, nz}, {1, 1, 1}, {periodic, wall, wall}};
    const Field<Centre> f(g, 1);
    EXPECT_EQ(sum_over_cells(g, [&](std::size_t n) { return f[n]; }), 6 * nz);
  }
}

TEST(Rows, VisitEveryUnknownFaceOnceAndNoFaceOnAWall) {
  const StaggeredGrid g{{3, 4, 5}, {1, 1, 1}, {periodic, wall, wall}};
  const std::size_t unknowns[] = {3 * 4 * 5, 3 * 3 * 5, 3 * 4 * 4};
  for (int c = 0; c < 3; ++c) {
    Field<Centre> visits(g);
    for_each_unknown_face(g, c, [&](std::size_t n) { visits[n] += 1; });
    std::size_t count = 0;
    for_each_stored(g, [&](int i, int j, int k) {
      const double v = visits[g.index(i, j, k)];
      const int m[] = {i, j, k};
      if (v != 0) {
        EXPECT_GE(m[c], g.first_face(c));
      }
      EXPECT_LE(v, 1);
      count += v > 0;
    });
    EXPECT_EQ(count, unknowns[c]);
    EXPECT_EQ(sum_over_faces(g, c, [](std::size_t) { return 1.0; }), double(unknowns[c]));
  }
}

}   // namespace
}   // namespace bedload

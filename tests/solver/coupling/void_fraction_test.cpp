// Grains on the grid: volumes are conserved, and the fluxes on faces fit the void fraction of cells.
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "solver/coupling/void_fraction.hpp"
#include "solver/fluid/boundaries.hpp"
#include "solver/fluid/face_loops.hpp"
#include "solver/fluid/operators.hpp"
#include "tests/support/plain_kernel.hpp"
#include "tests/support/scenes.hpp"

namespace bedload::test {
namespace {

StaggeredGrid grid_with(std::array<Side, 3> sides) {
  StaggeredGrid g;
  g.cells = {5, 4, 7};
  g.h = {2e-3, 1.5e-3, 0.5e-3};
  g.sides = sides;
  return g;
}

const std::array<Side, 3> open = {Side::periodic, Side::periodic, Side::periodic};
const std::array<Side, 3> closed = {Side::wall, Side::wall, Side::wall};

double solid_volume(const Grains& grains) {
  double sum = 0;
  for (const double d : grains.diameter) sum += sphere_volume(d);
  return sum;
}

class OnAnyBox : public testing::TestWithParam<std::array<Side, 3>> {};
INSTANTIATE_TEST_SUITE_P(VoidFraction, OnAnyBox,
                         testing::Values(open, closed, std::array{Side::periodic, Side::periodic, Side::wall}));

TEST_P(OnAnyBox, ConservesGrainVolume) {
  const StaggeredGrid g = grid_with(GetParam());
  const Grains grains = random_grains(g, 200, 1);
  Stencils stencils;
  find_stencils(g, grains, stencils);
  VoidFraction eps(g);
  deposit_void_fraction(g, grains, stencils, eps);
  double solid = 0;
  for (int i = 0; i < g.cells[0]; ++i)
    for (int j = 0; j < g.cells[1]; ++j)
      for (int k = 0; k < g.cells[2]; ++k) solid += (1 - eps.centre[g.index(i, j, k)]) * g.cell_volume();
  EXPECT_NEAR(solid / solid_volume(grains), 1, 1e-12);
}

TEST_P(OnAnyBox, ChangesOnlyByTheSweptFlux) {
  const StaggeredGrid g = grid_with(GetParam());
  const double dt = 1e-3;
  Grains grains = random_grains(g, 300, 2);
  Stencils stencils;
  find_stencils(g, grains, stencils);
  VoidFraction before(g), after(g);
  deposit_void_fraction(g, grains, stencils, before);
  const std::vector<Vec3> start = grains.position;
  std::vector<Vec3> moved(grains.size());
  std::mt19937 random(3);
  std::uniform_real_distribution<double> step(-0.9, 0.9);
  for (std::size_t p = 0; p < grains.size(); ++p)
    for (int c = 0; c < 3; ++c) {
      double& x = grains.position[p][c];
      double to = x + step(random) * g.h[c];
      if (!g.periodic(c)) to = std::clamp(to, 0.01 * g.h[c], g.length()[c] - 0.01 * g.h[c]);
      moved[p][c] = to - x;
      x = to < 0 ? to + g.length()[c] : to >= g.length()[c] ? to - g.length()[c] : to;
    }
  const Reach former = stencils.reach;
  find_stencils(g, grains, stencils);
  SolidFlux flux(g);
  deposit_swept_flux(g, grains, start, moved, united(former, stencils.reach), dt, flux);
  fill_face_ghosts(g, flux);
  deposit_void_fraction(g, grains, stencils, after);
  Field<Centre> source(g);
  divergence(g, flux, source);
  for (int i = 0; i < g.cells[0]; ++i)
    for (int j = 0; j < g.cells[1]; ++j)
      for (int k = 0; k < g.cells[2]; ++k) {
        const std::size_t n = g.index(i, j, k);
        EXPECT_NEAR(source[n] * dt, after.centre[n] - before.centre[n], 2e-14);
      }
}

TEST_P(OnAnyBox, HasARateOfChangeEqualToTheDivergenceOfTheSolidFlux) {
  const StaggeredGrid g = grid_with(GetParam());
  Grains grains = random_grains(g, 100, 4);
  for (int c = 0; c < 3; ++c)
    for (Vec3& x : grains.position) x[c] = std::clamp(x[c], 0.1 * g.h[c], g.length()[c] - 0.1 * g.h[c]);
  Stencils stencils;
  find_stencils(g, grains, stencils);
  SolidFlux flux(g);
  deposit_solid_flux(g, grains, stencils, flux);
  fill_face_ghosts(g, flux);
  Field<Centre> source(g);
  divergence(g, flux, source);
  const double dt = 1e-7;   // central difference: error O(dt^2)
  VoidFraction later(g), earlier(g);
  for (Vec3 *x = grains.position.data(), *v = grains.velocity.data(); x != grains.position.data() + grains.size();
       ++x, ++v)
    *x += dt * *v;
  find_stencils(g, grains, stencils);
  deposit_void_fraction(g, grains, stencils, later);
  for (Vec3 *x = grains.position.data(), *v = grains.velocity.data(); x != grains.position.data() + grains.size();
       ++x, ++v)
    *x -= 2 * dt * *v;
  find_stencils(g, grains, stencils);
  deposit_void_fraction(g, grains, stencils, earlier);
  double largest = 0;
  for (int i = 0; i < g.cells[0]; ++i)
    for (int j = 0; j < g.cells[1]; ++j)
      for (int k = 0; k < g.cells[2]; ++k) {
        const std::size_t n = g.index(i, j, k);
        largest = std::max(largest, std::abs(source[n]));
        EXPECT_NEAR(source[n], (later.centre[n] - earlier.centre[n]) / (2 * dt), 1e-3);
      }
  EXPECT_GT(largest, 1);   // the fluxes compared are not all zero
}

TEST(Kernel, SamplesALinearFieldExactlyInTheInterior) {
  const StaggeredGrid g = grid_with(open);
  FaceFields u(g);
  for_each_unknown_face(g, 0, [&](std::size_t n) {
    u.component(0)[n] = static_cast<double>(n % (g.cells[2] + 4)) - 2;
  });   // k of the cell
  const Stencil s(g, {4.3e-3, 2.2e-3, 1.61e-3});
  extend_samples(g, u);
  EXPECT_NEAR(sample(s, Strides(g), u).x, 1.61e-3 / g.h.z - 0.5, 1e-12);
}

TEST(Kernel, DepositIsTheTransposeOfSample) {
  const StaggeredGrid g = grid_with({Side::periodic, Side::wall, Side::wall});
  const Grains grains = random_grains(g, 20, 5);
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(-1, 1);
  FaceFields field(g), spread(g);
  for (int c = 0; c < 3; ++c) for_each_unknown_face(g, c, [&](std::size_t n) { field.component(c)[n] = unit(random); });
  for (std::size_t p = 0; p < grains.size(); ++p) {
    const Stencil s(g, grains.position[p]);
    clear(spread);
    const Vec3 f{unit(random), unit(random), unit(random)};
    deposit(s, Strides(g), f, spread);
    fold_deposits(g, spread);
    extend_samples(g, field);
    double pairing = 0;
    for (int c = 0; c < 3; ++c)
      pairing += sum_over_faces(g, c, [&](std::size_t n) { return field.component(c)[n] * spread.component(c)[n]; });
    EXPECT_NEAR(pairing, dot(f, sample(s, Strides(g), field)), 1e-13);
  }
}

/// A flat layer of touching spheres on the bottom, with their centres in the plane of the faces of flat cells.
Grains flat_layer(const StaggeredGrid& g, double d) {
  Grains grains;
  const Vec3 length = g.length();
  const int across = static_cast<int>(std::round(length.x / d)), deep = static_cast<int>(std::round(length.y / d));
  grains.resize(static_cast<std::size_t>(across * deep));
  for (std::size_t p = 0; p < grains.size(); ++p) {
    const auto i = static_cast<int>(p) / deep, j = static_cast<int>(p) % deep;
    grains.position[p] = {(i + 0.5) * d, (j + 0.5) * d, d / 2};
    grains.diameter[p] = d, grains.density[p] = 2650;
  }
  return grains;
}

TEST(VoidFraction, OfAnOverfilledFaceIsWhatSpheresLeaveAndItsGrainsShareTheRest) {
  StaggeredGrid g;
  const double d = 1e-3;
  g.cells = {4, 4, 6}, g.h = {2 * d, 2 * d, 0.45 * d};
  g.sides = {Side::periodic, Side::periodic, Side::wall};
  Grains grains = flat_layer(g, d);
  for (Vec3& x : grains.position) x.z = g.h.z;   // pi/6 d^3 in a cell's height d^2 h_z: more than fits
  Stencils stencils;
  find_stencils(g, grains, stencils);
  VoidFraction eps(g);
  deposit_void_fraction(g, grains, stencils, eps);
  const double solid = std::numbers::pi / 6 * d / g.h.z;
  ASSERT_GT(solid, 1);
  ASSERT_EQ(eps.overfilled.size(), 16u);   // the faces of that plane, and no others
  for (const OverfilledFace& f : eps.overfilled) {
    EXPECT_EQ(f.direction, 2);
    EXPECT_EQ(eps.face.z[f.face], least_face_void);
    EXPECT_NEAR(eps.face.z[f.face] + f.grain_share * solid, 1, 1e-12);
  }

  for (std::size_t p = 0; p < grains.size(); ++p)   // half of it on either face
    grains.position[p].z = 1.5 * g.h.z, grains.diameter[p] = 0.9 * d;
  find_stencils(g, grains, stencils);
  deposit_void_fraction(g, grains, stencils, eps);
  EXPECT_TRUE(eps.overfilled.empty());
  EXPECT_NEAR(eps.face.z[g.index(1, 1, 1)], 1 - 0.729 * solid / 2, 1e-12);
}

}   // namespace
}   // namespace bedload::test

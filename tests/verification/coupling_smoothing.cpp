// A kernel of fixed width: the bed that it shows does not depend on the cells, and the coupled step stands as without it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "solver/coupler.hpp"
#include "solver/coupling/void_fraction.hpp"
#include "solver/fluid/face_loops.hpp"
#include "tests/support/scenes.hpp"

namespace bedload::test {
namespace {

constexpr double d = 1e-3;

/// phi of the planes of cells of height h, for a bed of layers 8 d deep in a box 16 d high.
std::vector<double> plane_means(double h, double sigma) {
  const int n = static_cast<int>(std::lround(16 * d / h));
  const Scene scene = fluid_scene({4, 4, n}, {2 * d, 2 * d, h}, channel, 1e-6);
  const State state = state_of(scene, cubic_places({8, 8, 8}, {}, {8 * d, 8 * d, 8 * d}, 0.1 * d, 3), true);
  Stencils stencils;
  find_stencils(scene.grid, state.grains, stencils);
  VoidFraction eps(scene.grid);
  deposit_void_fraction(scene.grid, state.grains, stencils, eps, KernelSmoothing(scene.grid, {.xy = 0, .z = sigma}));
  std::vector<double> phi(n);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      for (int k = 0; k < n; ++k) phi[k] += (1 - eps.centre[scene.grid.index(i, j, k)]) / 16;
  return phi;
}

/// Largest difference between the profile on cells of h and the mean of two cells of h/2.
double change_by_halving(double h, double sigma) {
  const auto coarse = plane_means(h, sigma), fine = plane_means(h / 2, sigma);
  double most = 0;
  for (std::size_t k = 0; k < coarse.size(); ++k)
    most = std::max(most, std::abs(coarse[k] - 0.5 * (fine[2 * k] + fine[2 * k + 1])));
  return most;
}

TEST(SmoothedBed, LooksTheSameOnAnyCells) {
  // Halving the cells takes h^2/4 - h^2/16 of variance away, averaging a pair gives h^2/16 back: h^2/8 in all, which moves phi
  // by half of that times phi''. phi'' is that of the surface, at most phi max|G'| = 0.24 phi/sigma^2, of two passes 0.37, and that of
  // the layers, k = 2 pi/d, of which (1 + sigma^2 k^2/4)^-2 is left.
  const double sigma = d, phi = std::numbers::pi / 6, k = 2 * std::numbers::pi / d;
  const double layers = 2 * phi * k * k / std::pow(1 + sigma * sigma * k * k / 4, 2);
  for (const double h : {0.8 * d, 0.4 * d, 0.2 * d})
    EXPECT_LT(change_by_halving(h, sigma), h * h / 16 * (0.37 * phi / (sigma * sigma) + layers)) << h;
  EXPECT_GT(change_by_halving(0.4 * d, 0), 0.1);   // without it layers come out
}

TEST(SmoothedBed, DrivesNoFlowWhereNothingMoves) {
  Scene scene = fluid_scene({5, 4, 12}, {2 * d, 2 * d, d}, channel, 1e-6);
  scene.bed.gravity = {1, 0, -9.7};
  scene.smoothing = {.xy = 2 * d, .z = 0.8 * d};
  scene.terms.viscous_torque = scene.terms.added_mass = true;
  add_grains(scene, d, 2.65, 0.1);
  State state = state_of(scene, cubic_places({9, 7, 6}, {}, {10 * d, 8 * d, 6 * d}, 0.2 * d, 3), true);
  Coupler coupler(scene);
  for (int i = 0; i < 20; ++i) coupler.step(state, scene.steps.fluid_interval);
  for (int c = 0; c < 3; ++c)
    for_each_unknown_face(scene.grid, c, [&](std::size_t n) { EXPECT_EQ(state.fluid.velocity.component(c)[n], 0); });
}

/// Mean velocity through a periodic lattice, a grain in every cell, after some steps under a gradient.
double flux_through_lattice(Smoothing smoothing) {
  Scene scene = fluid_scene({6, 5, 8}, {1.2 * d, 1.2 * d, 1.2 * d}, periodic_box, 1e-5);
  scene.smoothing = smoothing;
  add_grains(scene, d, 2.65, 0.01);
  std::vector<Vec3> places;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 5; ++j)
      for (int k = 0; k < 8; ++k) places.push_back({1.2 * d * (i + 0.3), 1.2 * d * (j + 0.6), 1.2 * d * (k + 0.8)});
  State state = state_of(scene, places, true);
  state.search.gradient = 1;
  Coupler coupler(scene);
  for (int i = 0; i < 50; ++i) coupler.step(state, 1e-4);
  double sum = 0;
  for_each_unknown_face(scene.grid, 0, [&](std::size_t n) { sum += state.fluid.velocity.x[n]; });
  return sum / double(scene.grid.cell_count());
}

TEST(SmoothedBed, OfUniformPackingIsAsWithout) {
  const double plain = flux_through_lattice({});
  EXPECT_GT(plain, 0);
  EXPECT_NEAR(flux_through_lattice({.xy = 1.5 * d, .z = 2 * d}) / plain, 1, 1e-9);
}

}   // namespace
}   // namespace bedload::test

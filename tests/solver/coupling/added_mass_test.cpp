// The coefficient of added mass, and what a grain must not see of itself.
#include "solver/coupling/added_mass.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/support/plain_kernel.hpp"
#include "tests/support/scenes.hpp"

namespace bedload::test {
namespace {

constexpr double d = 1e-3;

/// C_A of every grain of a state.
std::vector<double> coefficients(const Scene& scene, const State& state, bool model_b = false) {
  Stencils stencils;
  find_stencils(scene.grid, state.grains, stencils);
  VoidFraction eps(scene.grid);
  deposit_void_fraction(scene.grid, state.grains, stencils, eps);
  extend_samples(scene.grid, eps.centre);
  std::vector<double> sampled, added;
  for (const Stencil& s : stencils) sampled.push_back(sample(s, Strides(scene.grid), on_cells, eps.centre.data()));
  GrainPacking packing;
  find_packing(scene.grid, state.grains, eps.centre, sampled, packing);
  find_added_mass(state.grains, sampled, packing, model_b, added);
  for (std::size_t p = 0; p < added.size(); ++p) added[p] /= sphere_volume(state.grains.diameter[p]);
  return added;
}

TEST(AddedMassCoefficient, IsZubers) {
  EXPECT_EQ(added_mass_coefficient(0), 0.5);
  EXPECT_NEAR(added_mass_coefficient(0.1), 0.5 * 1.2 / 0.9, 1e-15);
  EXPECT_NEAR(added_mass_coefficient(0.6), 2.75, 1e-14);
  EXPECT_NEAR((added_mass_coefficient(1e-6) - 0.5) / 1e-6, 1.5,
              1e-4);   // 1/2 (1 + 3 phi): van Wijngaarden's 2.78, nearly
}

TEST(AddedMassCoefficient, OfALoneGrainIsOneHalfWhereverItIs) {
  const Scene scene = fluid_scene({4, 2, 3}, {1.5 * d, 2 * d, d}, {Side::wall, Side::periodic, Side::wall}, 1e-6);
  for (const Vec3 place : {Vec3{3 * d, 2 * d, 1.5 * d}, {0.5 * d, 0.1 * d, 0.5 * d}, {5.9 * d, 3.9 * d, 2.9 * d}}) {
    State state = state_of(scene, {place}, false);
    EXPECT_NEAR(coefficients(scene, state)[0], 0.5, 1e-12);
  }
}

TEST(AddedMassCoefficient, OfALatticeIsThatOfItsPackingWhateverTheCells) {
  const double phi = 1000 * sphere_volume(1) / 1728;
  for (const int n : {6, 10, 20}) {   // cells of 2, 1.2 and 0.6 d
    const Scene scene = fluid_scene({n, n, n}, 12 * d / n * Vec3{1, 1, 1}, periodic_box, 1e-6);
    const State state = state_of(scene, cubic_places({10, 10, 10}, {}, scene.grid.length(), 0, 1), false);
    const auto c = coefficients(scene, state);
    EXPECT_NEAR(std::accumulate(c.begin(), c.end(), 0.0) / 1000, added_mass_coefficient(phi), 0.01) << n;
  }
  const Scene scene = fluid_scene({6, 6, 6}, {2 * d, 2 * d, 2 * d}, periodic_box, 1e-6);
  const State state = state_of(scene, cubic_places({10, 10, 10}, {}, scene.grid.length(), 0, 1), false);
  // In Model B all that passes between the phases is divided by eps.
  EXPECT_NEAR(coefficients(scene, state, true)[0] / coefficients(scene, state)[0], 1 / (1 - phi), 0.01);
}

}   // namespace
}   // namespace bedload::test

// The coefficient of added mass, and what a grain must not see of itself.
#include "solver/coupling/added_mass.hpp"

#include <gtest/gtest.h>

#include "tests/support/scenes.hpp"

namespace bedload::test {
namespace {

constexpr double d = 1e-3;

/// C_A of every grain of a state.
std::vector<double> coefficients(const Scene& scene, const State& state, bool model_b = false) {
  std::vector<Stencil> stencils;
  find_stencils(scene.grid, state.grains, stencils);
  VoidFraction eps(scene.grid);
  deposit_void_fraction(scene.grid, state.grains, stencils, eps);
  extend_samples(scene.grid, eps.centre);
  std::vector<double> sampled, own, added;
  for (const Stencil& s : stencils) sampled.push_back(sample<on_cells>(s, Strides(scene.grid), eps.centre.data()));
  find_own_packing(scene.grid, state.grains, own);
  find_added_mass(state.grains, sampled, own, model_b, added);
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

TEST(AddedMassCoefficient, OfALatticeIsThatOfItsPackingLessTheGrainsOwnShare) {
  const Scene scene = fluid_scene({6, 6, 6}, {2 * d, 2 * d, 2 * d}, periodic_box, 1e-6);
  const State state = state_of(scene, cubic_places({10, 10, 10}, {}, scene.grid.length(), 0, 1), false);
  const double phi = 1000 * sphere_volume(d) / (1728 * d * d * d), own = sphere_volume(1) / 8;   // per cell of 2 d
  for (const double c : coefficients(scene, state)) {
    EXPECT_LT(c, added_mass_coefficient(phi));
    EXPECT_GT(c, added_mass_coefficient(phi - own));
  }
  // In Model B all that passes between the phases is divided by eps.
  EXPECT_NEAR(coefficients(scene, state, true)[0] / coefficients(scene, state)[0], 1 / (1 - phi), 0.01);
}

}   // namespace
}   // namespace bedload::test

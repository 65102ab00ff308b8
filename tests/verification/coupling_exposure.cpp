// Exposure in the coupled step: a grain that stands out of a layer is dragged more, with the flow whichever way it goes.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "solver/coupler.hpp"
#include "solver/coupling/exposure.hpp"
#include "solver/fluid/face_loops.hpp"
#include "tests/support/scenes.hpp"

namespace bedload::test {
namespace {

constexpr double d = 1e-3;

/// A fixed square layer with one grain in a pocket of it, in a linear shear from the bottom to the lid.
struct ShearedLayer {
  explicit ShearedLayer(double shear) : rate(shear) {
    scene = fluid_scene({4, 4, 16}, {2 * d, 2 * d, 0.5 * d}, channel, 1e-5);
    scene.bed.grains.diameter = d;
    scene.terms.pressure_gradient = scene.terms.viscous_stress = false;
    std::vector<Vec3> places = cubic_places({8, 8, 1}, {}, {8 * d, 8 * d, d}, 0, 1);
    places.push_back({4 * d, 4 * d, (0.5 + std::sqrt(0.5)) * d});
    state = state_of(scene, places, true);
    state.search.lid_speed = rate * scene.grid.length().z;
    for_each_unknown_face(scene.grid, 0, [&](std::size_t n) {
      const auto k = static_cast<std::ptrdiff_t>(n) % scene.grid.stride(1) - StaggeredGrid::ghosts;
      state.fluid.velocity.x[n] = rate * (static_cast<double>(k) + 0.5) * scene.grid.h.z;
    });
  }
  struct Forces {
    double all, drag_on_top;   // along x, on all grains; drag on the one that stands out [N]
  };
  Forces force(bool exposure) const {
    Scene one = scene;
    one.terms.exposure = exposure;
    State flow = state;
    Coupler coupler(one);
    coupler.step(flow, 1e-7);
    return {coupler.books().on_grains.x, coupler.drag_on_grains().back().x};
  }
  double rate;
  Scene scene;
  State state;
};

TEST(Exposure, DragsAGrainThatStandsOutByItsOwnFlowAndNoOther) {
  // The flow at the exposed slices exceeds that at the centre by moment x radius x shear; a linear shear is read exactly, and
  // a step of 1e-7 s changes it by beta T/V_c, some 1e-4. Model B: the pressure that answers the reaction on the fluid
  // pushes no grain.
  const ShearedLayer layer(3), reversed(-3);
  Sheltering sheltering;
  const auto level = sheltering.find(PeriodicBox(layer.scene.bed), layer.state.grains);
  EXPECT_EQ(level.front(), 1);
  ASSERT_LT(level.back(), 0.5);
  const auto with = layer.force(true), without = layer.force(false);
  const double height = layer.state.grains.position.back().z;
  EXPECT_GT(without.drag_on_top, 0);
  EXPECT_NEAR((with.all - without.all) / without.drag_on_top / (exposed_moment(level.back()) * 0.5 * d / height), 1,
              1e-3);
  EXPECT_NEAR((reversed.force(true).all - reversed.force(false).all) / (with.all - without.all), -1, 1e-6);
}

/// Fastest flow along x [m/s], of one field or of the difference of two.
double fastest(const Scene& scene, const State& flow, const State* less = nullptr) {
  double most = 0;
  for_each_unknown_face(scene.grid, 0, [&](std::size_t n) {
    most = std::max(most, std::abs(flow.fluid.velocity.x[n] - (less ? less->fluid.velocity.x[n] : 0)));
  });
  return most;
}

TEST(Exposure, IsBoundedInAFixedBedThatHoldsTheFluidFast) {
  // Grains of all heights, flat cells, a syrup and long steps: all that the fluid keeps of a flow among the grains is what
  // exposure gives back to it, at most 2 a m/h_z of the flow before (docs/physics_coupling.md, section 8). The flow begins as
  // noise from face to face.
  for (const bool model_b : {false, true}) {
    Scene scene = fluid_scene({4, 4, 16}, {2 * d, 2 * d, 0.25 * d}, channel, 1e-4);
    scene.bed.grains.diameter = d;
    scene.terms.pressure_gradient = scene.terms.viscous_stress = !model_b;
    std::mt19937_64 random(1);
    const auto share = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    std::vector<Vec3> places = cubic_places({8, 8, 1}, {}, {8 * d, 8 * d, d}, 0, 1);
    for (Vec3& place : places) place.z += d * share();
    const double step = 0.5, noise = 1e-3;
    const double held =
        3 * std::numbers::pi * scene.bed.fluid.viscosity * step / (2 * d * d);   // B of Stokes's law alone
    ASSERT_GT(held, 200);
    State with = state_of(scene, places, true);
    for_each_unknown_face(scene.grid, 0, [&](std::size_t n) { with.fluid.velocity.x[n] = noise * (2 * share() - 1); });
    State without = with;
    Scene exposed = scene;
    exposed.terms.exposure = true;
    Coupler one(exposed), other(scene);
    ASSERT_EQ(one.step(with, step).dt, step);
    ASSERT_EQ(other.step(without, step).dt, step);
    const double gain = 2 * 0.5 * d * exposed_moment(0) / scene.grid.h.z, given = fastest(scene, with, &without);
    EXPECT_GT(given, 1e-3 * gain * noise) << model_b;   // that it is there at all
    EXPECT_LT(given, gain * noise) << model_b;
    for (int n = 1; n < 100; ++n) {
      ASSERT_TRUE(one.step(with, step).finite);
      ASSERT_LT(fastest(scene, with), 1.1 * noise) << "step " << n << ", Model " << (model_b ? "B" : "A");
    }
    EXPECT_LT(fastest(scene, with), 0.1 * noise) << model_b;   // nothing drives it
  }
}

}   // namespace
}   // namespace bedload::test

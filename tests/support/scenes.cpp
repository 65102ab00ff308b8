#include "tests/support/scenes.hpp"

#include <random>

#include "solver/coupling/void_fraction.hpp"
#include "solver/fluid/face_loops.hpp"
#include "solver/grains/grain_dynamics.hpp"

namespace bedload::test {

Scene fluid_scene(std::array<int, 3> cells, Vec3 h, std::array<Side, 3> sides, double viscosity) {
  Scene scene;
  scene.grid.cells = cells, scene.grid.h = h, scene.grid.sides = sides;
  scene.bed.length = scene.grid.length(), scene.bed.sides = sides;
  scene.bed.fluid = {1000, viscosity};
  scene.bed.grains = {1e-3, 2650, 0, 0.4, 0.6, 0.3, 1e6};
  scene.bed.dem_step = 1;
  scene.steps.fluid_interval = 1;
  return scene;
}

void add_grains(Scene& scene, double diameter, double density_ratio, double speed) {
  GrainProperties& g = scene.bed.grains;
  g.diameter = diameter, g.density = density_ratio * scene.bed.fluid.density;
  // overlap/d = [0.98 (1 - nu^2) rho v^2/Y]^0.4 for a Hertz collision, set to 1 %
  g.young_modulus = 0.98 * (1 - g.poisson * g.poisson) * g.density * speed * speed / std::pow(0.01, 2.5);
  scene.bed.dem_step = 0.2 * rayleigh_time(diameter, g.density, g.young_modulus, g.poisson);
  scene.steps.fluid_interval = 10 * scene.bed.dem_step;
}

State state_of(const Scene& scene, const std::vector<Vec3>& places, bool fixed) {
  State state;
  state.fluid = FluidState(scene.grid);
  state.search.phase = Search::holding;
  state.grains.resize(places.size());
  state.grains.position = places;
  for (std::size_t p = 0; p < places.size(); ++p) {
    state.grains.diameter[p] = scene.bed.grains.diameter;
    state.grains.density[p] = scene.bed.grains.density;
    state.grains.fixed[p] = fixed;
  }
  return state;
}

std::vector<Vec3> cubic_places(std::array<int, 3> count, Vec3 low, Vec3 high, double jitter, unsigned seed) {
  std::mt19937_64 random(seed);
  const auto shift = [&] { return jitter * (2 * (static_cast<double>(random() >> 11) * 0x1p-53) - 1); };
  std::vector<Vec3> places;
  for (int i = 0; i < count[0]; ++i)
    for (int j = 0; j < count[1]; ++j)
      for (int k = 0; k < count[2]; ++k) {
        const Vec3 f{(i + 0.5) / count[0], (j + 0.5) / count[1], (k + 0.5) / count[2]};
        Vec3 x;
        for (int c = 0; c < 3; ++c) x[c] = low[c] + f[c] * (high[c] - low[c]) + shift();
        places.push_back(x);
      }
  return places;
}

FaceFields face_void_fraction(const Scene& scene, const State& state) {
  Stencils stencils;
  find_stencils(scene.grid, state.grains, stencils);
  VoidFraction eps(scene.grid);
  deposit_void_fraction(scene.grid, state.grains, stencils, eps, KernelSmoothing(scene.grid, scene.smoothing));
  return eps.face;
}

Grains random_grains(const StaggeredGrid& g, std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  Grains grains;
  grains.resize(count);
  for (std::size_t p = 0; p < count; ++p) {
    for (int c = 0; c < 3; ++c)
      grains.position[p][c] = g.length()[c] * unit(random), grains.velocity[p][c] = unit(random) - 0.5;
    grains.diameter[p] = 3e-4 * (1 + 0.2 * unit(random));
    grains.density[p] = 2650;
  }
  return grains;
}

Vec3 fluid_momentum(const Scene& scene, const State& state) {
  const FaceFields eps = face_void_fraction(scene, state);
  Vec3 sum;
  for (int c = 0; c < 3; ++c)
    sum[c] = scene.bed.fluid.density * scene.grid.cell_volume() *
             sum_over_faces(
                 scene.grid, c,
                 [e = eps.component(c), u = state.fluid.velocity.component(c)](std::size_t n) { return e[n] * u[n]; });
  return sum;
}

Vec3 total_momentum(const Scene& scene, const State& state) {
  Vec3 sum = fluid_momentum(scene, state);
  for (std::size_t p = 0; p < state.grains.size(); ++p)
    sum += state.grains.density[p] * sphere_volume(state.grains.diameter[p]) * state.grains.velocity[p];
  return sum;
}

double kinetic_energy(const Scene& scene, const State& state) {
  const FaceFields eps = face_void_fraction(scene, state);
  double sum = 0;
  for (int c = 0; c < 3; ++c)
    sum += 0.5 * scene.bed.fluid.density * scene.grid.cell_volume() *
           sum_over_faces(scene.grid, c, [e = eps.component(c), u = state.fluid.velocity.component(c)](std::size_t n) {
             return e[n] * u[n] * u[n];
           });
  const Grains& g = state.grains;
  for (std::size_t p = 0; p < g.size(); ++p) {
    const double mass = g.density[p] * sphere_volume(g.diameter[p]);
    sum += 0.5 * mass * norm2(g.velocity[p]) + 0.5 * sphere_inertia(mass, g.diameter[p]) * norm2(g.spin[p]);
  }
  return sum;
}

}   // namespace bedload::test

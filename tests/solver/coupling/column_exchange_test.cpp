// Slices as weights: they hold the grain, sample what they deposit, and keep the momentum of fluid and grains.
#include "solver/coupling/column_exchange.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "solver/grains/slice_volume.hpp"

namespace bedload {
namespace {

constexpr double area = 4e-6;
const Column column{.layers = 64, .thickness = 5e-5, .viscosity = 1e-6};

/// Grains of 0.3 to 0.6 mm at random heights, some through bottom and top, the first ones fixed.
Grains random_grains(std::size_t count, std::size_t fixed, unsigned seed) {
  std::mt19937 bits(seed);
  std::uniform_real_distribution<double> any(0, 1);
  Grains g;
  g.resize(count);
  for (std::size_t p = 0; p < count; ++p) {
    g.diameter[p] = 3e-4 * (1 + any(bits)), g.density[p] = 2500, g.fixed[p] = p < fixed;
    g.position[p] = {1e-3 * any(bits), 1e-3 * any(bits), column.layers * column.thickness * any(bits)};
    g.velocity[p] = {0.1 * any(bits), 0, 0.05 * (any(bits) - 0.5)};
  }
  return g;
}

TEST(GrainSlices, AddUpToTheGrainForAnyPlaceAndAnyLayers) {
  const Grains g = random_grains(200, 0, 1);
  for (const double thickness : {1e-6, 3.3e-5, 1e-4, 1e-3, 1.0}) {
    const Column c{.layers = std::max(1, int(std::lround(3.2e-3 / thickness))), .thickness = thickness};
    GrainSlices slices;
    find_slices(c, g, slices);
    SolidLayers solid;
    average_grains(c, g, slices, area, solid);
    double volume = 0;
    for (std::size_t p = 0; p < g.size(); ++p) {
      EXPECT_NEAR(std::accumulate(&slices.part[slices.begin[p]],
                                  &slices.part[slices.begin[p]] + (slices.begin[p + 1] - slices.begin[p]), 0.0),
                  1, 1e-13);
      volume += sphere_volume(g.diameter[p]);
    }
    for (const double part : slices.part) EXPECT_GE(part, 0);
    const double held = std::accumulate(solid.fraction.begin(), solid.fraction.end(), 0.0) * area * thickness;
    EXPECT_NEAR(held, volume, 1e-13 * volume) << thickness;
  }
}

TEST(GrainSlices, CarryTheFluxOfAllGrainsThatMove) {
  const Grains g = random_grains(100, 30, 12);
  GrainSlices slices;
  SolidLayers solid;
  find_slices(column, g, slices), average_grains(column, g, slices, area, solid);
  double flux = 0;
  for (std::size_t p = 30; p < g.size(); ++p) flux += sphere_volume(g.diameter[p]) * g.velocity[p].x;
  const double held = std::accumulate(solid.flux.begin(), solid.flux.end(), 0.0) * area * column.thickness;
  EXPECT_NEAR(held, flux, 1e-13 * flux);
}

TEST(GrainSlices, AreTheVolumesBetweenTheLayersEdges) {
  Grains g = random_grains(1, 0, 2);
  g.position[0].z = 1.23e-3, g.diameter[0] = 5e-4;
  GrainSlices slices;
  find_slices(column, g, slices);
  for (std::size_t k = 0; k < 64; ++k) {   // pi (R^2 - s^2) integrated by the midpoint rule
    const int points = 2000;
    double volume = 0;
    for (int n = 0; n < points; ++n) {
      const double s = (double(k) + (n + 0.5) / points) * column.thickness - 1.23e-3;
      volume += std::max(0.0, std::numbers::pi * (2.5e-4 * 2.5e-4 - s * s)) * column.thickness / points;
    }
    const std::size_t n = k - slices.first[0];   // far beyond the last below the first
    const double part = k >= slices.first[0] && n < slices.part.size() ? slices.part[n] : 0;
    EXPECT_NEAR(part * sphere_volume(5e-4), volume, 1e-6 * sphere_volume(5e-4)) << k;
  }
}

TEST(GrainSlices, SampleALinearProfileAtTheGrainsOwnHeight) {
  Grains g = random_grains(100, 0, 3);
  std::vector<double> shear(64), parabola(64);
  for (std::size_t k = 0; k < 64; ++k) {
    const double z = (double(k) + 0.5) * column.thickness;
    shear[k] = 2 + 30 * z, parabola[k] = z * z;
  }
  for (Vec3& x : g.position) x.z = 4e-4 + 0.7 * x.z;   // clear of bottom and top
  GrainSlices slices;
  find_slices(column, g, slices);
  for (std::size_t p = 0; p < g.size(); ++p) {
    const double z = g.position[p].z, radius = 0.5 * g.diameter[p], h = column.thickness;
    // A layer has one velocity, so that a slice sees the profile to a part of the layer.
    EXPECT_NEAR(sample(slices, p, shear), 2 + 30 * z, 30 * h * h / radius);
    EXPECT_NEAR(sample(slices, p, parabola), z * z + radius * radius / 5, 2 * z * h * h / radius + h * h);
  }
}

struct Grown {   // what the coupled step knows of its grains
  std::vector<Vec3> drag, relaxation, ballistic, force;
  GrainResponse response() const { return {drag, relaxation, ballistic, force}; }
};

Grown response_of(const Grains& g, double dt, unsigned seed) {
  std::mt19937 bits(seed);
  std::uniform_real_distribution<double> any(-1, 1);
  Grown r;
  for (std::size_t p = 0; p < g.size(); ++p) {
    const double beta = 20 * 3 * std::numbers::pi * 1e-6 * g.diameter[p];
    const double mass = sphere_volume(g.diameter[p]) * g.density[p] / 1000;
    r.drag.push_back({beta, 0, 0});
    r.relaxation.push_back({g.fixed[p] ? 0 : beta * dt / mass, 0, 0});
    r.ballistic.push_back({g.fixed[p] ? 0 : g.velocity[p].x, 0, 0});
    r.force.push_back({1e-2 * beta * any(bits), 0, 0});
  }
  return r;
}

TEST(ColumnExchange, GivesGrainsWhatItTakesFromTheLayers) {
  const Grains g = random_grains(300, 50, 4);
  for (const double dt : {1e-5, 1e-1}) {
    const Grown r = response_of(g, dt, 5);
    GrainSlices slices;
    find_slices(column, g, slices);
    LayerExchange exchange;
    find_exchange(column, slices, r.response(), area, exchange);
    std::vector<double> u(64), forces;
    for (std::size_t k = 0; k < 64; ++k) u[k] = std::sin(0.3 * double(k));
    find_forces(slices, r.response(), u, forces);
    double taken = 0, given = 0, size = 0;
    for (std::size_t k = 0; k < 64; ++k)
      taken += (exchange.rate[k] * u[k] - exchange.pull[k]) * area * column.thickness;
    for (const double f : forces) given += f, size += std::abs(f);
    EXPECT_NEAR(taken, given, 1e-13 * size);
  }
}

TEST(ColumnExchange, DragsAGrainByItsVelocityAtTheEndOfTheStep) {   // whatever the step: beta (u - v')
  const Grains g = random_grains(20, 0, 13);
  for (const double dt : {1e-6, 1e-3, 1.0}) {
    const Grown r = response_of(g, dt, 14);
    GrainSlices slices;
    find_slices(column, g, slices);
    std::vector<double> u(64, 0.2), forces;
    find_forces(slices, {r.drag, r.relaxation, r.ballistic, {}}, u, forces);
    for (std::size_t p = 0; p < g.size(); ++p) {
      const double mass = sphere_volume(g.diameter[p]) * g.density[p] / 1000;
      const double end = r.ballistic[p].x + dt * forces[p] / mass;
      EXPECT_NEAR(forces[p], r.drag[p].x * (0.2 - end), 1e-12 * r.drag[p].x);
    }
  }
}

TEST(ColumnExchange, SamplesAndDepositsWithTheSameWeights) {   // <S u, f> of grains = <u, S^T f> of layers
  const Grains g = random_grains(50, 0, 6);
  Grown r = response_of(g, 0, 7);
  GrainSlices slices;
  find_slices(column, g, slices);
  std::vector<double> u(64);
  for (std::size_t k = 0; k < 64; ++k) u[k] = std::cos(0.2 * double(k));
  double of_grains = 0, of_layers = 0;
  for (std::size_t p = 0; p < g.size(); ++p) of_grains += sample(slices, p, u) * r.force[p].x, r.drag[p] = {};
  LayerExchange exchange;
  find_exchange(column, slices, r.response(), area, exchange);
  for (std::size_t k = 0; k < 64; ++k) of_layers -= u[k] * exchange.pull[k] * area * column.thickness;
  EXPECT_NEAR(of_grains, of_layers, 1e-13 * 50 * 1e-2 * 20 * 3 * std::numbers::pi * 1e-6 * 6e-4);
}

/// Fluid and grains in a column for some steps; grains move up and down through the layers, pushed by drag along x, until
/// some have sunk so far into bottom and top that these layers are clamped.
void expect_closed_book(double dt, bool turbulent, Top top) {
  Column c = column;
  c.top = top, c.packing = turbulent ? 0.6 : 0;
  Grains g = random_grains(60, 10, 8);
  ColumnFlow flow(c);
  std::vector<double> u(64, 0.05), forces;
  GrainSlices slices;
  SolidLayers solid, after;
  LayerExchange exchange;
  const auto momentum = [&](const SolidLayers& s) {   // per rho_f
    double sum = 0;
    for (std::size_t k = 0; k < 64; ++k)
      sum += std::max(1 - s.fraction[k], ColumnFlow::least_void) * u[k] * area * c.thickness;
    for (std::size_t p = 0; p < g.size(); ++p)
      if (!g.fixed[p]) sum += sphere_volume(g.diameter[p]) * g.density[p] / 1000 * g.velocity[p].x;
    return sum;
  };
  for (int n = 0; n < 20; ++n) {
    find_slices(c, g, slices), average_grains(c, g, slices, area, solid);
    const Grown r = response_of(g, dt, 9);
    find_exchange(c, slices, r.response(), area, exchange);
    const double had = momentum(solid);
    flow.step(u, solid, exchange, {0.2, 0.1}, dt);
    find_forces(slices, r.response(), u, forces);
    double on_fixed = 0, size = std::abs(had);
    for (std::size_t p = 0; p < g.size(); ++p) {
      const double volume = sphere_volume(g.diameter[p]);
      const double force = forces[p] + volume * sample(slices, p, flow.stress_divergence());
      size += std::abs(force) * dt;
      if (g.fixed[p]) on_fixed += force;
      else g.velocity[p].x += dt * force / (volume * g.density[p] / 1000), g.position[p] += dt * g.velocity[p];
    }
    find_slices(c, g, slices), average_grains(c, g, slices, area, after);
    flow.carry(u, solid.fraction, after.fraction);
    const ColumnBooks& b = flow.books();
    const double impulse = dt * (area * (b.driving - b.on_bottom - b.on_lid) - on_fixed);
    EXPECT_NEAR(momentum(after) - had, impulse, 1e-12 * size) << n;
  }
}

TEST(ColumnExchange, KeepsTheMomentumOfFluidAndMovingGrains) {
  for (const double dt : {1e-5, 2e-3})
    for (const bool turbulent : {false, true})
      for (const Top top : {Top::lid, Top::free_slip}) expect_closed_book(dt, turbulent, top);
}

TEST(ColumnExchange, SlowsFastGrainsAsMuchAsTheySpeedTheFluid) {   // grains that outrun the fluid give momentum back
  Grains g = random_grains(20, 0, 10);
  for (Vec3& v : g.velocity) v = {1, 0, 0};
  const Grown r = response_of(g, 1e-4, 11);
  const GrainResponse drag_alone{r.drag, r.relaxation, r.ballistic, {}};
  GrainSlices slices;
  SolidLayers solid;
  LayerExchange exchange;
  find_slices(column, g, slices), average_grains(column, g, slices, area, solid);
  find_exchange(column, slices, drag_alone, area, exchange);
  ColumnFlow flow(column);
  std::vector<double> u(64), forces;
  flow.step(u, solid, exchange, {}, 1e-4);
  find_forces(slices, drag_alone, u, forces);
  for (const double f : forces) EXPECT_LT(f, 0);
  EXPECT_GT(flow.books().gained, 0);
}

}   // namespace
}   // namespace bedload

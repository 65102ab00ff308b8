#include "solver/fluid/turbulence.hpp"

#include <gtest/gtest.h>

#include "fields.hpp"
#include "solver/fluid/boundaries.hpp"
#include "solver/fluid/wall_law.hpp"

namespace bedload {
namespace {

using namespace test;

constexpr double nu = 1e-6;
const StaggeredGrid periodic_grid{{5, 6, 7}, {0.4, 0.3, 0.1}, {periodic, periodic, periodic}};
const StaggeredGrid channel_grid{{5, 6, 7}, {0.4, 0.3, 0.1}, {periodic, periodic, wall}, Top::lid};
const StaggeredGrid closed_grid{{5, 6, 7}, {0.4, 0.3, 0.1}, {wall, wall, wall}, Top::lid};

/// Without wall laws, by the definition of the closure.
constexpr double filter_length = 0.17 * 0.4;

FaceFields random_flow(const StaggeredGrid& g, unsigned seed, double lid_speed = 0, Vec3 wind = {}) {
  FaceFields u = random_faces(g, seed, -1, 1);
  for (int c = 0; c < 3; ++c)
    for_each_stored(g, [&](int i, int j, int k) { u.component(c)[g.index(i, j, k)] += wind[c]; });
  fill_velocity_ghosts(g, u, lid_speed);
  return u;
}

FaceFields force_of(const Turbulence& turbulence, const StaggeredGrid& g, const FaceFields& u) {
  FaceFields force(g);
  turbulence.add_force(u, 1, force);
  return force;
}

double inner(const StaggeredGrid& g, const FaceFields& a, const FaceFields& b) {
  double sum = 0;
  for (int c = 0; c < 3; ++c)
    sum += sum_over_faces(g, c, [&](std::size_t n) { return a.component(c)[n] * b.component(c)[n]; });
  return sum;
}

/// An affine flow x -> A x, ghosts too: the closure sees no boundary between interior cells.
FaceFields affine(const StaggeredGrid& g, std::array<Vec3, 3> rows) {
  return on_faces(g, [=](Vec3 x) { return Vec3{dot(rows[0], x), dot(rows[1], x), dot(rows[2], x)}; });
}

TEST(Turbulence, IsNotMadeByUniformFlowOrPureRotation) {
  const FaceFields flows[] = {FaceFields(periodic_grid, 3),
                              affine(periodic_grid, {Vec3{0, -2, 1}, {2, 0, -3}, {-1, 3, 0}})};
  for (const FaceFields& u : flows) {
    Turbulence turbulence(periodic_grid, nu);
    turbulence.find(u, 0, 0, 0);
    EXPECT_LT(turbulence.largest(), 1e-13);
  }
}

TEST(Turbulence, OfUniformStrainIsSmagorinskysLengthSquaredTimesIt) {
  const struct {
    std::array<Vec3, 3> rows;
    double strain;   // sqrt(2 S_ij S_ij)
  } flows[] = {{{Vec3{0, 0, 3}, {}, {}}, 3},
               {{Vec3{0, 1, 0}, {2, 0, 0}, {}}, 3},
               {{Vec3{2, 0, 0}, {0, -2, 0}, {}}, std::sqrt(2.0 * (4 + 4))},
               {{Vec3{1, 1, 0}, {0, 1, -2}, {3, 0, -2}}, std::sqrt(2.0 * (1 + 1 + 4) + 1 + 4 + 9)}};
  for (const auto& flow : flows) {
    const StaggeredGrid& g = periodic_grid;
    Turbulence turbulence(g, nu);
    turbulence.find(affine(g, flow.rows), 0, 0, 0);
    const double expected = filter_length * filter_length * flow.strain;
    EXPECT_NEAR(turbulence.at_centres()[g.index(2, 3, 3)], expected, 1e-13);
    for (int t = 0; t < 3; ++t) EXPECT_NEAR(turbulence.at_edges().component(t)[g.index(2, 3, 3)], expected, 1e-13);
  }
}

TEST(Turbulence, DoesNotSeeAWindAlongPeriodicDirections) {
  for (const auto& [g, lid] : {std::pair{periodic_grid, 0.0}, {channel_grid, 7.0}}) {
    Turbulence still(g, nu), windy(g, nu);
    // In a channel, walls and fluid at once move against the observer only if both walls do: compare eddies off the walls.
    const FaceFields u = random_flow(g, 1, lid), v = random_flow(g, 1, lid, {5, -3, g.periodic(2) ? 2.0 : 0.0});
    still.find(u, lid, 0, 0), windy.find(v, lid, 0, 0);
    for (int c = 0; c < 3; ++c)
      for (int k = 3; k < 5; ++k) {
        const std::size_t n = g.index(2, 2, k);
        if (g.periodic(2)) {
          EXPECT_NEAR(force_of(still, g, u).component(c)[n], force_of(windy, g, v).component(c)[n], 1e-12);
        } else {   // the damping of a wall knows how fast the flow passes it, and here that is nowhere near unity
          EXPECT_NEAR(force_of(still, g, u).component(c)[n], force_of(windy, g, v).component(c)[n], 1e-9);
        }
      }
  }
}

TEST(Turbulence, KeepsMomentumAndGivesTheRestToTheWalls) {
  for (const StaggeredGrid& g : {periodic_grid, channel_grid}) {
    const double lid = g.periodic(2) ? 0 : 2;
    const FaceFields u = random_flow(g, 2, lid);
    Turbulence turbulence(g, nu);
    turbulence.find(u, lid, 0, 0.01);
    const FaceFields force = force_of(turbulence, g, u);
    const WallShear shear = turbulence.wall_shear(u);
    for (int c = 0; c < (g.periodic(2) ? 3 : 2); ++c) {
      const double* f = force.component(c);
      const double gained = g.cell_volume() * sum_over_faces(g, c, [&](std::size_t n) { return f[n]; });
      const double size = g.cell_volume() * sum_over_faces(g, c, [&](std::size_t n) { return std::abs(f[n]); });
      EXPECT_NEAR(gained, -shear.bottom[c] - shear.top[c], 1e-14 * size) << c;
      EXPECT_EQ(std::abs(shear.top[c]) > 1e-6 * size, !g.periodic(2)) << c;
    }
  }
}

TEST(Turbulence, IsSymmetricAndTakesEnergy) {
  for (const StaggeredGrid& g : {periodic_grid, channel_grid, closed_grid}) {
    Turbulence turbulence(g, nu);
    turbulence.find(random_flow(g, 3), 0, 0, 0.01);
    const FaceFields x = random_flow(g, 4), y = random_flow(g, 5);
    const double xy = inner(g, x, force_of(turbulence, g, y)), yx = inner(g, y, force_of(turbulence, g, x));
    const double xx = inner(g, x, force_of(turbulence, g, x));
    EXPECT_LT(xx, 0);
    EXPECT_NEAR(xy, yx, -1e-13 * xx);
  }
}

TEST(Turbulence, KnowsItsDiagonal) {
  const StaggeredGrid& g = periodic_grid;
  Turbulence turbulence(g, nu);
  turbulence.find(random_flow(g, 6), 0, 0, 0);
  FaceFields diagonal(g);
  turbulence.add_diagonal(2, diagonal);
  for (int c = 0; c < 3; ++c) {
    const std::size_t n = g.index(3, 2, 4);
    FaceFields unit(g);
    unit.component(c)[n] = 1;
    EXPECT_NEAR(diagonal.component(c)[n], -2 * force_of(turbulence, g, unit).component(c)[n], 1e-13);
  }
}

/// A channel whose cells are so wide that only the walls bound the eddies.
StaggeredGrid wide_channel(int layers) {
  return {{3, 3, layers}, {1e6, 1e6, 1.0 / layers}, {periodic, periodic, wall}, Top::free_slip};
}

TEST(Turbulence, CarriesAConstantStressThroughALogLaw) {   // the discrete equations have the log law as exact solution
  const StaggeredGrid g = wide_channel(16);
  const double friction_speed = 0.05, roughness = 0.03, z0 = roughness / 30, stress = friction_speed * friction_speed;
  FaceFields u = on_faces(g, [&](Vec3 x) {
    return Vec3{friction_speed / von_karman * std::log((std::max(x.z, 0.0) + z0) / z0), 0, 0};
  });
  fill_velocity_ghosts(g, u, 0);
  Turbulence turbulence(g, nu);
  turbulence.find(u, 0, 0, roughness);
  for (int k = 1; k < 16; ++k) {
    const std::size_t n = g.index(1, 1, k);
    const double slope = (u.x[n] - u.x[n - 1]) / g.h.z;
    EXPECT_NEAR(turbulence.at_edges().y[n] * slope, stress, 1e-9 * stress) << k;
  }
  const double wall = turbulence.wall_shear(u).bottom.x / (g.length().x * g.length().y);
  const std::size_t n = g.index(1, 1, 0);
  EXPECT_NEAR(wall + nu * (u.x[n] - u.x[n - 1]) / g.h.z, stress, 1e-9 * stress);
}

TEST(Turbulence, HasNoEddiesInABedAndItsWallLawAtItsSurface) {
  const StaggeredGrid g = wide_channel(16);
  const double surface = 0.33, roughness = 0.0625, z0 = roughness / 30, friction_speed = 0.05;
  const auto speed_at = [&](double z) {
    return z > surface ? friction_speed / von_karman * std::log((z - surface + z0) / z0) : 0.0;
  };
  FaceFields u = on_faces(g, [&](Vec3 x) { return Vec3{speed_at(x.z), 0, 0}; });
  fill_velocity_ghosts(g, u, 0);
  Turbulence turbulence(g, nu);
  turbulence.find(u, 0, surface, roughness);
  for (int k = 0; k < 16; ++k) {
    const std::size_t n = g.index(1, 1, k);
    const double nu_t = turbulence.at_edges().y[n], slope = (u.x[n] - u.x[n - 1]) / g.h.z;
    const bool in_bed = (k + 0.5) * g.h.z < surface;
    EXPECT_NEAR(nu_t * slope, in_bed ? 0 : friction_speed * friction_speed, 1e-9) << k;
    EXPECT_EQ(nu_t == 0, in_bed) << k;
    EXPECT_EQ(turbulence.at_centres()[n] == 0, in_bed) << k;
  }
}

TEST(Turbulence, IsDampedBesideASmoothWall) {   // u+ = y+: the eddies of the sublayer carry next to nothing
  const StaggeredGrid g = wide_channel(64);
  const double friction_speed = 1e-4, h = g.h.z;   // h+ = 1.6
  FaceFields u = on_faces(g, [&](Vec3 x) { return Vec3{friction_speed * friction_speed * x.z / nu, 0, 0}; });
  fill_velocity_ghosts(g, u, 0);
  Turbulence turbulence(g, nu);
  turbulence.find(u, 0, 0, 0);
  for (int k = 1; k < 4; ++k) {   // kappa^2 y+^2 (1 - exp(-y+/26))^2, l by the mean between the centres
    const double y_plus = k * h * friction_speed / nu, d = 1 - std::exp(-y_plus / 26);
    const double l_plus = von_karman * (h * friction_speed / nu) / std::log((k + 0.5) / (k - 0.5)) * d;
    EXPECT_NEAR(turbulence.at_edges().y[g.index(1, 1, k)] / nu, l_plus * l_plus, 1e-6 * l_plus * l_plus) << k;
    EXPECT_LT(turbulence.at_edges().y[g.index(1, 1, k)], 0.15 * nu);
  }
  EXPECT_EQ(turbulence.wall_shear(u).bottom, Vec3{});
}

TEST(Turbulence, OfSlowShearIsTheFiltersReynoldsNumberTimesItsConstant) {
  const StaggeredGrid& g = channel_grid;   // Couette: nu_t/nu <= C_s^2 S Delta^2/nu, less beside walls
  for (double shear : {1e-8, 1e-6}) {
    FaceFields u = on_faces(g, [=](Vec3 x) { return Vec3{shear * x.z, 0, 0}; });
    fill_velocity_ghosts(g, u, shear * 0.7);
    Turbulence turbulence(g, nu);
    turbulence.find(u, shear * 0.7, 0, 0);
    EXPECT_GT(turbulence.largest(), 0);
    EXPECT_LE(turbulence.largest() / nu, filter_length * filter_length * shear / nu);
    EXPECT_EQ(turbulence.wall_shear(u).bottom, Vec3{});
    EXPECT_EQ(turbulence.wall_shear(u).top, Vec3{});
  }
}

}   // namespace
}   // namespace bedload

#include "solver/fluid/momentum.hpp"

#include <gtest/gtest.h>

#include "moving_volumes.hpp"
#include "solver/fluid/operators.hpp"

namespace bedload {
namespace {

using namespace test;

/// A step in which volumes move and the fluid makes way: void fractions before and after, and a flux F with
/// div F = -(eps' - eps)/dt on every cell, made of minus the volumes' own flux and any flux without divergence.
struct Step {
  FaceFields before, after, flux;
  double dt;
};

/// F without divergence: the discrete curl of random numbers on edges, zero on walls, plus a uniform wind along
/// periodic sides.
FaceFields random_solenoidal(const StaggeredGrid& g, unsigned seed, double size, Vec3 wind) {
  FaceFields edges =
      random_faces(g, seed, -size, size);   // component c: on the edges along c, at the lower corner of the others
  for (int c = 0; c < 3; ++c)
    for_each_stored(g, [&](int i, int j, int k) {
      const int m[] = {i, j, k};
      for (int d = 0; d < 3; ++d)
        if (d != c && !g.periodic(d) && (m[d] == 0 || m[d] == g.cells[d])) edges.component(c)[g.index(i, j, k)] = 0;
    });
  fill_face_ghosts(g, edges);
  FaceFields flux(g);
  for (int c = 0; c < 3; ++c) {
    const int d = (c + 1) % 3, e = (c + 2) % 3;
    const double *ad = edges.component(d), *ae = edges.component(e);
    for_each_unknown_face(g, c, [&](std::size_t n) {
      flux.component(c)[n] = wind[c] + (ae[n + g.stride(d)] - ae[n]) / g.h[d] - (ad[n + g.stride(e)] - ad[n]) / g.h[e];
    });
  }
  return flux;
}

Step step_of_moving_volumes(const StaggeredGrid& g, Vec3 wind) {
  std::mt19937 random(5);
  const auto uniform = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
  Step step{{}, {}, random_solenoidal(g, 11, 0.02, wind), 0.05};
  MovingVolumes volumes;
  for (std::size_t p = 0; p < 5 * g.cell_count(); ++p)
    volumes.position.push_back({uniform(0, g.cells[0]), uniform(0, g.cells[1]), uniform(0, g.cells[2])});
  step.before = volumes.void_on_faces(g);
  FaceFields swept(g);
  for (std::size_t p = 0; p < volumes.position.size(); ++p)
    for (int c = 0; c < 3; ++c) {
      double travel = uniform(-0.3, 0.3);
      const double x = volumes.position[p][c];
      if (!g.periodic(c) && (x + travel < 0 || x + travel > g.cells[c])) travel = -travel;
      volumes.move(g, p, c, travel, step.dt, swept);
    }
  step.after = volumes.void_on_faces(g);
  for (int c = 0; c < 3; ++c)
    for_each_unknown_face(g, c, [&](std::size_t n) { step.flux.component(c)[n] -= swept.component(c)[n]; });
  fill_face_ghosts(g, step.flux);
  return step;
}

Vec3 momentum(const StaggeredGrid& g, const FaceFields& eps, const FaceFields& u, Vec3* size = nullptr) {
  Vec3 sum;
  for (int c = 0; c < 3; ++c) {
    const double *e = eps.component(c), *v = u.component(c);
    sum[c] = sum_over_faces(g, c, [&](std::size_t n) { return e[n] * v[n]; });
    if (size) (*size)[c] = sum_over_faces(g, c, [&](std::size_t n) { return std::abs(e[n] * v[n]); });
  }
  return sum;
}

const StaggeredGrid periodic_grid{{6, 5, 7}, {0.4, 0.3, 0.1}, {periodic, periodic, periodic}};
const StaggeredGrid channel_grid{{6, 5, 7}, {0.4, 0.3, 0.1}, {periodic, periodic, wall}, Top::lid};

TEST(MovingVolumes, CarryAFluxThatClosesOnEveryCell) {   // what the tests below stand on
  for (const StaggeredGrid& g : {periodic_grid, channel_grid}) {
    MovingVolumes volumes{{{0.3, 4.9, 0.2}, {5.9, 0.1, 6.8}, {3, 2.5, 3.5}}};
    const Field<Centre> before = volumes.void_on_centres(g);
    FaceFields flux(g);
    for (std::size_t p = 0; p < 3; ++p)
      for (int c = 0; c < 3; ++c) volumes.move(g, p, c, c == 2 && p == 1 ? -0.4 : 0.35, 0.1, flux);
    const Field<Centre> after = volumes.void_on_centres(g);
    fill_face_ghosts(g, flux);
    Field<Centre> div(g);
    divergence(g, flux, div);
    for_each_cell_row(g, [&](std::size_t row, int length) {
      for (std::size_t n = row; n < row + length; ++n) EXPECT_NEAR(div[n], (after[n] - before[n]) / 0.1, 1e-14);
    });
  }
}

TEST(Transport, KeepsTheMomentumOfAPeriodicBoxWhileTheVoidFractionChanges) {
  const Step s = step_of_moving_volumes(periodic_grid, {0.3, -0.2, 0.1});
  FaceFields u = random_faces(periodic_grid, 1, -1, 1);
  fill_velocity_ghosts(periodic_grid, u, 0);
  Vec3 size;
  const Vec3 before = momentum(periodic_grid, s.before, u, &size);
  TransportScratch scratch;
  transport(periodic_grid, s.flux, s.before, s.after, s.dt, FaceFields(u), u, scratch);
  const Vec3 after = momentum(periodic_grid, s.after, u);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(after[c], before[c], 1e-15 * size[c]);
}

TEST(Transport, KeepsMomentumEvenWhenTheFluxDoesNotClose) {
  const Step s = step_of_moving_volumes(periodic_grid, {0.3, -0.2, 0.1});
  FaceFields u = random_faces(periodic_grid, 1, -1, 1), flux = random_faces(periodic_grid, 2, -0.1, 0.1);
  fill_velocity_ghosts(periodic_grid, u, 0);
  fill_face_ghosts(periodic_grid, flux);
  Vec3 size;
  const Vec3 before = momentum(periodic_grid, s.before, u, &size);
  TransportScratch scratch;
  transport(periodic_grid, flux, s.before, s.after, s.dt, FaceFields(u), u, scratch);
  const Vec3 after = momentum(periodic_grid, s.after, u);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(after[c], before[c], 1e-15 * size[c]);
}

TEST(Transport, KeepsAUniformFlowUniformWhileTheVoidFractionChanges) {
  const Step s = step_of_moving_volumes(periodic_grid, {0.3, -0.2, 0.1});
  const Vec3 speed{0.7, -0.4, 0.2};
  FaceFields u = on_faces(periodic_grid, [&](Vec3) { return speed; });
  TransportScratch scratch;
  transport(periodic_grid, s.flux, s.before, s.after, s.dt, FaceFields(u), u, scratch);
  for (int c = 0; c < 3; ++c)
    for_each_unknown_face(periodic_grid, c, [&](std::size_t n) { EXPECT_NEAR(u.component(c)[n], speed[c], 3e-15); });
}

TEST(Transport, KeepsAUniformFlowAlongWallsUniformToTheLastCell) {
  const Step s = step_of_moving_volumes(channel_grid, {0.3, -0.2, 0});
  const Vec3 speed{0.7, -0.4, 0};
  FaceFields u = on_faces(channel_grid, [&](Vec3) { return speed; });
  fill_velocity_ghosts(channel_grid, u, 3);
  TransportScratch scratch;
  const Vec3 before = momentum(channel_grid, s.before, u);
  transport(channel_grid, s.flux, s.before, s.after, s.dt, FaceFields(u), u, scratch);
  const Vec3 after = momentum(channel_grid, s.after, u);
  for (int c = 0; c < 2; ++c) {
    for_each_unknown_face(channel_grid, c, [&](std::size_t n) { EXPECT_NEAR(u.component(c)[n], speed[c], 3e-15); });
    EXPECT_NEAR(after[c], before[c], 1e-12 * std::abs(before[c]));   // nothing passes through the walls
  }
}

/// Towards a wall the flow cannot be uniform, but two faces away from it the flux must close on the control volume:
/// this holds only if the correction is carried from wall to wall through the half volumes of the walls' own faces.
TEST(Transport, ClosesTheFluxTowardsWallsToo) {
  const StaggeredGrid g{{5, 4, 12}, {0.4, 0.3, 0.1}, {wall, periodic, wall}, Top::lid};
  const Step s = step_of_moving_volumes(g, {0, 0.2, 0});
  FaceFields u = on_faces(g, [](Vec3) { return Vec3{0, 0, 0.3}; });
  TransportScratch scratch;
  transport(g, s.flux, s.before, s.after, s.dt, FaceFields(u), u, scratch);   // ghosts hold 0.3 as well
  for_each_unknown_face(g, 2, [&](std::size_t n) { EXPECT_NEAR(u.z[n], 0.3, 3e-15); });
}

TEST(Transport, LeavesFluidAtRestAtRest) {
  const Step s = step_of_moving_volumes(channel_grid, {0.3, -0.2, 0});
  FaceFields u(channel_grid);
  TransportScratch scratch;
  transport(channel_grid, s.flux, s.before, s.after, s.dt, FaceFields(u), u, scratch);
  for (int c = 0; c < 3; ++c)
    for_each_unknown_face(channel_grid, c, [&](std::size_t n) { EXPECT_EQ(u.component(c)[n], 0); });
}

/// Carries the component `c` of u along `t` with flux 1 m/s, once around a periodic line of n cells; returns u on that
/// line.
std::vector<double> once_around(int c, int t, int n, double courant, double (*profile)(double)) {
  StaggeredGrid g{{1, 1, 1}, {1, 1, 1}, {periodic, periodic, periodic}};
  g.cells[t] = n;
  g.h[t] = 1.0 / n;
  FaceFields u = on_faces(g, [&](Vec3 x) { return Vec3{profile(x[t]), profile(x[t]), profile(x[t])}; });
  FaceFields flux(g), one(g, 1);
  std::fill_n(flux.component(t), g.padded_size(), 1.0);
  TransportScratch scratch;
  const int steps = static_cast<int>(std::lround(n / courant));
  for (int m = 0; m < steps; ++m) {
    fill_velocity_ghosts(g, u, 0);
    transport(g, flux, one, one, 1.0 / steps, FaceFields(u), u, scratch);
  }
  std::vector<double> line;
  for (int m = 0; m < n; ++m) line.push_back(u.component(c)[g.index(0, 0, 0) + m * g.stride(t)]);
  return line;
}

TEST(Transport, CarriesAWaveWithSecondOrderInL1) {
  const auto wave = [](double x) { return std::sin(2 * M_PI * x); };
  for (int t : {0, 1, 2})
    for (int c : {t, (t + 1) % 3}) {
      double error[2];
      for (int level : {0, 1}) {
        const int n = 64 << level;
        const std::vector<double> line = once_around(c, t, n, 8.0 / n, wave);   // dt ~ h^2: the error in space shows
        error[level] = 0;
        for (int m = 0; m < n; ++m) error[level] += std::abs(line[m] - wave((m + (c == t ? 0 : 0.5)) / n)) / n;
      }
      EXPECT_GT(std::log2(error[0] / error[1]), 1.8) << "component " << c << " along " << t;
    }
}

TEST(Transport, MakesNoNewExtremaUpToACourantNumberOfOneHalf) {
  const auto step = [](double x) { return x > 0.25 && x < 0.75 ? 1.0 : 0.0; };
  for (int t : {0, 1, 2}) {
    const std::vector<double> line = once_around((t + 1) % 3, t, 40, 0.5, step);
    double variation = 0;
    for (int m = 0; m < 40; ++m) {
      EXPECT_GE(line[m], -1e-15);
      EXPECT_LE(line[m], 1 + 1e-15);
      variation += std::abs(line[m] - line[(m + 39) % 40]);
    }
    EXPECT_LE(variation, 2 + 1e-13);
  }
}

TEST(Transport, DoesTheSameWhicheverWayTheWindBlows) {
  const auto mirrored = [](const FaceFields& f, const StaggeredGrid& g, double sign) {   // x -> -x; u changes sign
    FaceFields out(g);
    const int nx = g.cells[0];
    for (int c = 0; c < 3; ++c)
      for (int i = 0; i < nx; ++i)
        for (int j = 0; j < g.cells[1]; ++j)
          for (int k = 0; k < g.cells[2]; ++k)
            out.component(c)[g.index(i, j, k)] =
                (c == 0 ? sign : 1) * f.component(c)[g.index(c == 0 ? (nx - i) % nx : nx - 1 - i, j, k)];
    return out;
  };
  const StaggeredGrid& g = periodic_grid;
  const Step s = step_of_moving_volumes(g, {0.3, -0.2, 0.1});
  FaceFields u = random_faces(g, 1, -1, 1), v = mirrored(u, g, -1), flux = mirrored(s.flux, g, -1);
  fill_velocity_ghosts(g, u, 0);
  fill_velocity_ghosts(g, v, 0);
  fill_face_ghosts(g, flux);
  TransportScratch scratch;
  transport(g, s.flux, s.before, s.after, s.dt, FaceFields(u), u, scratch);
  transport(g, flux, mirrored(s.before, g, 1), mirrored(s.after, g, 1), s.dt, FaceFields(v), v, scratch);
  v = mirrored(v, g, -1);
  for (int c = 0; c < 3; ++c)
    for_each_unknown_face(g, c, [&](std::size_t n) { EXPECT_NEAR(u.component(c)[n], v.component(c)[n], 1e-13); });
}

}   // namespace
}   // namespace bedload

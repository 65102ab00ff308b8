// Further smoothing of the kernel: conservative, positive, of the width asked for, and its pieces fit each other.
#include "solver/coupling/smoothing.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "solver/coupling/packing_of_others.hpp"
#include "solver/fluid/boundaries.hpp"
#include "solver/fluid/face_loops.hpp"
#include "solver/fluid/operators.hpp"
#include "tests/support/plain_kernel.hpp"
#include "tests/support/scenes.hpp"

namespace bedload::test {
namespace {

constexpr Vec3 edges{2e-3, 1.5e-3, 0.5e-3};
constexpr Smoothing widths{.xy = 2.5e-3, .z = 1.2e-3};

StaggeredGrid grid_with(std::array<Side, 3> sides) { return fluid_scene({6, 4, 9}, edges, sides, 1e-6).grid; }

/// Indices of every place of a field, those on walls too.
std::vector<std::size_t> places(const StaggeredGrid& g, int place) {
  std::array<int, 3> count = g.cells;
  for (int c = 0; c < 3; ++c) count[c] += !g.periodic(c) && has_hat(place, c);
  std::vector<std::size_t> all;
  for (int i = 0; i < count[0]; ++i)
    for (int j = 0; j < count[1]; ++j)
      for (int k = 0; k < count[2]; ++k) all.push_back(g.index(i, j, k));
  return all;
}

std::vector<double> values(const std::vector<std::size_t>& at, const double* field) {
  std::vector<double> v;
  for (const std::size_t n : at) v.push_back(field[n]);
  return v;
}
double sum(const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0); }
double product(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

void fill(FaceFields& f, unsigned seed, double low = -1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(low, 1);
  for (int c = 0; c < 3; ++c)
    for (std::size_t n = 0; n < f.x.values.size(); ++n) f.component(c)[n] = number(random);
}

class SmoothedKernel : public testing::TestWithParam<std::array<Side, 3>> {};
INSTANTIATE_TEST_SUITE_P(Smoothing, SmoothedKernel, testing::Values(periodic_box, channel, closed_box));

TEST(Smoothing, HasTheVarianceAskedForOnAnyCells) {
  for (const auto& [cells, h] : {std::pair{96, 1e-3}, {192, 5e-4}, {48, 2e-3}}) {
    const StaggeredGrid g = fluid_scene({3, 3, cells}, {1, 1, h}, channel, 1e-6).grid;
    const double sigma = 2.3e-3;
    Field<Centre> f(g);
    f[g.index(1, 2, cells / 2)] = 1;
    KernelSmoothing(g, {.xy = 0, .z = sigma}).spread(f);
    double mass = 0, square = 0;
    for (int k = 0; k < cells; ++k) {
      const double value = f[g.index(1, 2, k)], z = (k - cells / 2) * h;
      EXPECT_GT(value, 0);
      mass += value, square += value * z * z;
    }
    EXPECT_NEAR(mass, 1, 1e-13);
    EXPECT_NEAR(square / (sigma * sigma), 1, 1e-9);   // the tails are 20 widths off
    EXPECT_EQ(f[g.index(0, 2, cells / 2)], 0);        // nothing across
  }
}

TEST_P(SmoothedKernel, KeepsSumsAndSigns) {
  const StaggeredGrid g = grid_with(GetParam());
  const KernelSmoothing smoothing(g, widths);
  FaceFields f(g), e(g), before(g);
  fill(f, 1, 0), fill(e, 2, 0);
  const FaceFields f0 = f, e0 = e;
  smoothing.spread(f), smoothing.spread_on_edges(e);
  for (int c = 0; c < 3; ++c) {
    const auto on_faces = places(g, c), on_edges = places(g, on_x_edges + c);
    EXPECT_NEAR(sum(values(on_faces, f.component(c))) / sum(values(on_faces, f0.component(c))), 1, 1e-13);
    EXPECT_NEAR(sum(values(on_edges, e.component(c))) / sum(values(on_edges, e0.component(c))), 1, 1e-13);
    for (const std::size_t n : on_faces) EXPECT_GT(f.component(c)[n], 0);
  }
}

TEST_P(SmoothedKernel, ReadsByTheTranspose) {
  const StaggeredGrid g = grid_with(GetParam());
  const KernelSmoothing smoothing(g, widths);
  FaceFields given(g), field(g), scratch;
  fill(given, 1), fill(field, 2);
  const FaceFields amounts = given;
  const FaceFields seen = smoothing.seen(field, scratch), seen_on_edges = smoothing.edges_seen(field, scratch);
  FaceFields spread = amounts, spread_on_edges = amounts;
  smoothing.spread(spread), smoothing.spread_on_edges(spread_on_edges);
  for (int c = 0; c < 3; ++c) {
    const auto faces = places(g, c), edge = places(g, on_x_edges + c);
    EXPECT_NEAR(product(values(faces, spread.component(c)), values(faces, field.component(c))),
                product(values(faces, amounts.component(c)), values(faces, seen.component(c))), 1e-12);
    EXPECT_NEAR(product(values(edge, spread_on_edges.component(c)), values(edge, field.component(c))),
                product(values(edge, amounts.component(c)), values(edge, seen_on_edges.component(c))), 1e-12);
  }
}

TEST_P(SmoothedKernel, LeavesUniformFieldsAlone) {
  const StaggeredGrid g = grid_with(GetParam());
  const KernelSmoothing smoothing(g, widths);
  FaceFields uniform(g, 0.7), amounts(g, 0.7), scratch;
  for (int c = 0; c < 3; ++c)   // half a control volume on walls
    for (const std::size_t n : places(g, c))
      if (const auto i = static_cast<std::ptrdiff_t>(n) / g.stride(c) % (g.cells[c] + 2 * StaggeredGrid::ghosts) - 2;
          !g.periodic(c) && (i == 0 || i == g.cells[c]))
        amounts.component(c)[n] *= 0.5;
  const FaceFields before = amounts;
  smoothing.spread(amounts);
  const FaceFields seen = smoothing.seen(uniform, scratch);
  for (int c = 0; c < 3; ++c)
    for (const std::size_t n : places(g, c)) {
      EXPECT_NEAR(seen.component(c)[n], 0.7, 1e-14);
      EXPECT_NEAR(amounts.component(c)[n], before.component(c)[n], 1e-14);
    }
}

TEST_P(SmoothedKernel, CommutesWithTheDivergence) {
  const StaggeredGrid g = grid_with(GetParam());
  const KernelSmoothing smoothing(g, widths);
  FaceFields flux(g);
  fill(flux, 3);
  clear_walls(g, flux);
  fill_face_ghosts(g, flux);
  Field<Centre> first(g), then(g);
  divergence(g, flux, first);
  smoothing.spread(first);
  smoothing.spread_flux(flux);
  fill_face_ghosts(g, flux);
  divergence(g, flux, then);
  const double scale = 1 / edges.z;
  for (const std::size_t n : places(g, on_cells)) EXPECT_NEAR(then[n] / scale, first[n] / scale, 1e-12);
}

TEST_P(SmoothedKernel, VoidFractionChangesOnlyByTheSweptFlux) {
  const StaggeredGrid g = grid_with(GetParam());
  const KernelSmoothing smoothing(g, widths);
  Grains grains = random_grains(g, 200, 5);
  Stencils stencils;
  VoidFraction before(g), after(g);
  find_stencils(g, grains, stencils);
  deposit_void_fraction(g, grains, stencils, before, smoothing);
  const std::vector<Vec3> start = grains.position;
  std::vector<Vec3> moved(grains.size());
  for (std::size_t p = 0; p < grains.size(); ++p)
    for (int c = 0; c < 3; ++c) {
      double& x = grains.position[p][c];
      double to = x + 1.5 * grains.velocity[p][c] * g.h[c];
      if (!g.periodic(c)) to = std::clamp(to, 0.01 * g.h[c], g.length()[c] - 0.01 * g.h[c]);
      moved[p][c] = to - x;
      x = g.periodic(c) ? to - g.length()[c] * std::floor(to / g.length()[c]) : to;
    }
  const double dt = 1e-3;
  const Reach former = stencils.reach;
  find_stencils(g, grains, stencils);
  SolidFlux flux(g);
  deposit_swept_flux(g, grains, start, moved, united(former, stencils.reach), dt, flux, smoothing);
  deposit_void_fraction(g, grains, stencils, after, smoothing);
  fill_face_ghosts(g, flux);
  Field<Centre> change(g);
  divergence(g, flux, change);
  for (const std::size_t n : places(g, on_cells))
    EXPECT_NEAR(dt * change[n], after.centre[n] - before.centre[n], 1e-12);
}

TEST_P(SmoothedKernel, GivesTheFacesOfALineWhatItGivesItsCells) {
  // What the transport of momentum needs: of every line along c, walls' faces with their half control volumes included.
  const StaggeredGrid g = grid_with(GetParam());
  const Grains grains = random_grains(g, 100, 5);
  Stencils stencils;
  find_stencils(g, grains, stencils);
  VoidFraction eps(g);
  deposit_void_fraction(g, grains, stencils, eps, KernelSmoothing(g, widths));
  for (int c = 0; c < 3; ++c) {
    const int a = (c + 1) % 3, b = (c + 2) % 3;
    for (int m = 0; m < g.cells[a]; ++m)
      for (int n = 0; n < g.cells[b]; ++n) {
        const std::size_t row = g.index(0, 0, 0) + m * g.stride(a) + n * g.stride(b);
        double cells = 0, faces = 0;
        for (int i = 0; i < g.cells[c]; ++i) cells += 1 - eps.centre[row + i * g.stride(c)];
        for (int i = 0; i < g.cells[c] + !g.periodic(c); ++i) faces += 1 - eps.face.component(c)[row + i * g.stride(c)];
        EXPECT_NEAR(faces, cells, 1e-12);
      }
  }
}

TEST_P(SmoothedKernel, ALoneGrainSeesNoOthers) {
  const StaggeredGrid g = grid_with(GetParam());
  const KernelSmoothing smoothing(g, widths);
  for (Grains grains = random_grains(g, 20, 5); grains.size() > 0; grains.resize(grains.size() - 1)) {
    Grains one;
    one.resize(1);
    one.position[0] = grains.position.back(), one.diameter[0] = 1e-3;
    Stencils stencils;
    find_stencils(g, one, stencils);
    VoidFraction eps(g);
    deposit_void_fraction(g, one, stencils, eps, smoothing);
    Field<Centre> scratch;
    Field<Centre> seen = smoothing.seen(eps.centre, scratch);
    extend_samples(g, seen);
    const double sampled = sample(stencils[0], Strides(g), on_cells, seen.data());
    GrainPacking packing;
    find_packing(g, one, seen, std::vector{sampled}, packing, smoothing);
    EXPECT_NEAR(1 - sampled, packing.own[0], 1e-13);
    EXPECT_NEAR(packing.others[0], 0, 1e-13);
  }
}

TEST(Smoothing, OfNoWidthChangesNoBit) {
  const StaggeredGrid g = grid_with(channel);
  const KernelSmoothing none(g, {});
  EXPECT_FALSE(none);
  FaceFields f(g), scratch;
  fill(f, 1);
  const FaceFields before = f;
  none.spread(f), none.spread_flux(f), none.spread_on_edges(f);
  EXPECT_EQ(f, before);
  EXPECT_EQ(&none.seen(f, scratch), &f);
}

}   // namespace
}   // namespace bedload::test

// The terms beside drag, on whole sets of grains: which terms act where, and that they add up as written.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "solver/coupling/explicit_forces.hpp"
#include "solver/coupling/lateral_forces.hpp"
#include "solver/coupling/wall_effects.hpp"
#include "tests/support/plain_kernel.hpp"

namespace bedload {
namespace {

constexpr double pi = std::numbers::pi, d = 1e-3, nu = 1e-4, h = 2e-3;

/// Grains in a channel 12 x 12 x 12 cells in a shear flow u = rate z, felt by a lone grain's Stokes drag.
struct Channel {
  explicit Channel(std::vector<Vec3> places, double rate = 10) {
    grid.cells = {12, 12, 12}, grid.h = {h, h, h}, grid.sides = {Side::periodic, Side::periodic, Side::wall};
    bed.length = grid.length(), bed.sides = grid.sides;
    grains.resize(places.size());
    grains.position = std::move(places);
    std::fill(grains.diameter.begin(), grains.diameter.end(), d);
    find_stencils(grid, grains, stencils);
    VoidFraction eps(grid);
    deposit_void_fraction(grid, grains, stencils, eps);
    test::extend_samples(grid, eps.centre);
    const double beta = 3 * pi * nu * d;
    for (std::size_t p = 0; p < grains.size(); ++p) {
      flow.velocity.push_back({rate * grains.position[p].z, 0, 0});
      flow.vorticity.push_back({0, rate, 0});
      flow.void_fraction.push_back(test::sample(stencils[p], Strides(grid), on_cells, eps.centre.data()));
      flow.drag.push_back({beta, beta, beta});
      flow.force.push_back({});
    }
    find_packing(grid, grains, eps.centre, flow.void_fraction, flow.packing);
  }
  void add(const Terms& terms, double lid_speed = 0) {
    const PeriodicBox box(bed);
    add_explicit_forces({grid, box, nu, lid_speed}, grains, terms, sheltering, flow);
  }

  StaggeredGrid grid;
  BedScene bed;
  Grains grains;
  Stencils stencils;
  FlowAtGrains flow;
  Sheltering sheltering;
};

TEST(ExplicitForces, AreNoneUnlessATermAsksForThem) {
  Channel channel({{5 * h, 5 * h, 0.5 * d}});
  const FlowAtGrains before = channel.flow;
  channel.add({});
  EXPECT_EQ(channel.flow.force[0], Vec3{});
  EXPECT_EQ(channel.flow.drag[0], before.drag[0]);
  EXPECT_FALSE(any_explicit({}));
  Terms no_drag{.drag = false};
  no_drag.shear_lift = true;
  channel.add(no_drag);
  EXPECT_EQ(channel.flow.force[0], Vec3{});   // a lift is measured by the drag
}

TEST(ExplicitForces, LiftIsSaffmanMeiFarFromWallsAndDividedByEpsInModelB) {
  const Vec3 middle{5 * h, 5 * h, 6 * h};
  Channel a({middle}), b({middle});
  Terms terms;
  terms.shear_lift = true;
  a.add(terms);
  const Vec3 slip = a.flow.velocity[0];
  EXPECT_EQ(a.flow.force[0], cross(slip, saffman_mei(slip, {0, 10, 0}, d, nu)));
  EXPECT_GT(a.flow.force[0].z, 0);
  terms.pressure_gradient = terms.viscous_stress = false;
  b.add(terms);
  EXPECT_NEAR(b.flow.force[0].z * b.flow.void_fraction[0] / a.flow.force[0].z, 1, 1e-12);
}

TEST(ExplicitForces, MagnusTakesTheSpinRelativeToTheFluids) {
  Channel channel({{5 * h, 5 * h, 6 * h}});
  Terms terms;
  terms.magnus = true;
  channel.grains.spin[0] = {0, 5, 0};   // as the fluid turns
  channel.add(terms);
  EXPECT_EQ(channel.flow.force[0], Vec3{});
  channel.grains.spin[0] = {0, -50, 0};
  channel.add(terms);
  EXPECT_LT(channel.flow.force[0].z, 0);   // lags the flow: moves along -x through it, with topspin
}

TEST(ExplicitForces, AreThoseOfAGrainWhateverItsId) {
  // Six: four at a time, and two. Near the wall and far from it, each in cells of its own.
  std::vector<Vec3> places;
  for (int p = 0; p < 6; ++p)
    places.push_back({(2 + 4 * (p % 3)) * h, (3 + 5 * (p / 3)) * h, p % 2 == 0 ? 0.5 * d : 6 * h});
  Channel one_way(places), other_way({places.rbegin(), places.rend()});
  Terms terms;
  terms.shear_lift = terms.magnus = terms.wall_forces = true;
  for (std::size_t p = 0; p < 6; ++p)
    one_way.grains.spin[p] = other_way.grains.spin[5 - p] = {0, -50.0 - 10 * double(p), 3};
  one_way.add(terms), other_way.add(terms);
  for (std::size_t p = 0; p < 6; ++p) {
    EXPECT_EQ(one_way.flow.force[p], other_way.flow.force[5 - p]) << p;
    EXPECT_NE(one_way.flow.force[p], Vec3{});
  }
}

TEST(ExplicitForces, ATouchingGrainAtRestGetsWallDragAndWallLift) {
  const Vec3 touching{5 * h, 5 * h, 0.5 * d};
  Channel channel({touching});
  const Vec3 beta = channel.flow.drag[0];
  Terms terms;
  terms.wall_forces = true;
  channel.add(terms);
  // On a fixed grain drag x slip + force is what it feels: that of (C39) without a correction of kappa.
  const Vec3 felt = scaled(channel.flow.drag[0], channel.flow.velocity[0]) + channel.flow.force[0];
  const double reflected = resolved_reflection(true, 0.5 * d, d, mean_response(true, d, h, h), h, h);
  EXPECT_NEAR(felt.x / (beta.x * channel.flow.velocity[0].x), 1 / (1 / 1.7005 + reflected), 2e-4);
  EXPECT_EQ(felt.z, 0);   // the wall's lift belongs to the term shear_lift
  Channel lifted({touching});
  lifted.flow.velocity[0] =
      (1 + 1.7005 * reflected) * channel.flow.velocity[0];   // as the grid shows it, reflection included
  terms.shear_lift = true;
  lifted.add(terms);
  const double re = 10 * 0.5 * d * d / nu, wanted = pi / 32 * wall_lift_coefficient(0, re) * 100 * std::pow(d, 4);
  const double upwards = resolved_reflection(false, 0.5 * d, d, mean_response(false, d, h, h), h, h);
  EXPECT_NEAR(lifted.flow.force[0].z * (1 + (1 + 9.0 / 8) * upwards) / wanted, 1, 2e-4);
}

TEST(ExplicitForces, AWallIsNoneAmongOtherGrains) {
  std::vector<Vec3> places;
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 12; ++j) places.push_back({(i + 0.5) * 2 * d, (j + 0.5) * 2 * d, 0.5 * d});
  Channel channel(places);   // packing at them 0.09
  const Vec3 beta = channel.flow.drag[0];
  Terms terms;
  terms.wall_forces = true;
  channel.add(terms);
  for (std::size_t p = 0; p < places.size(); ++p) {
    EXPECT_EQ(channel.flow.drag[p], beta);
    EXPECT_EQ(channel.flow.force[p], Vec3{});
  }
}

TEST(ExplicitForces, AGrainThatGoesAlongWithTheLidFeelsNoDragOfIt) {
  Channel channel({{5 * h, 5 * h, 12 * h - 0.8 * d}});
  channel.flow.velocity[0] = channel.grains.velocity[0] = {0.3, 0, 0};
  Terms terms;
  terms.wall_forces = true;
  channel.add(terms, 0.3);
  EXPECT_EQ(channel.flow.force[0], Vec3{});
  EXPECT_GT(channel.flow.drag[0].z, channel.flow.drag[0].x);   // harder to leave than to slide
}

TEST(ExplicitForces, ExposureAddsDragAlongTheFlowToGrainsThatStandOut) {
  std::vector<Vec3> places;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) places.push_back({8 * d + i * d, 8 * d + j * d, 0.5 * d});
  places.push_back({9.5 * d, 9.5 * d, (0.5 + std::sqrt(0.5)) * d});   // in the pocket between four of them
  Channel channel(places);
  Terms terms;
  terms.exposure = true;
  channel.add(terms);
  const double beta = 3 * pi * nu * d;
  EXPECT_NEAR(channel.flow.force[16].x, beta * 0.5 * d * 10 * exposed_moment(1 - std::sqrt(2)), 1e-9 * beta * d * 10);
  EXPECT_EQ(channel.flow.force[5].x, 0);   // one of the four
}

/// All that can act at once besides drag.
Terms every_term() {
  Terms terms;
  terms.self_disturbance = terms.added_mass = terms.shear_lift = terms.magnus = terms.viscous_torque = true;
  terms.wall_forces = terms.exposure = true;
  return terms;
}

TEST(ExplicitForces, AGrainThatGoesAlongWithTheFluidFeelsNothingUnderAnyLaw) {
  // Ergun's drag vanishes with the slip of a lone grain: nothing may be divided by it.
  Channel channel({{5 * h, 5 * h, 0.5 * d}, {5 * h, 5 * h, 6 * h}});   // at a wall, and far from any
  FaceFields velocity(channel.grid), acceleration(channel.grid);
  Field<Centre> eps(channel.grid, 1);
  for (const DragLawName name : drag_law_names)
    for (const bool model_b : {false, true})
      for (const double vorticity : {0.0, 10.0}) {
        SCOPED_TRACE(fmt::format("{}, Model {}, vorticity {}", name_of(name), model_b ? 'B' : 'A', vorticity));
        Terms terms = every_term();
        terms.pressure_gradient = terms.viscous_stress = !model_b;
        sample_flow(channel.grid, channel.grains, channel.stencils, velocity, acceleration, eps, drag_law(name), nu,
                    terms, channel.flow);
        channel.flow.vorticity.assign(2, {0, vorticity, 0});
        channel.add(terms);
        for (std::size_t p = 0; p < 2; ++p) {
          EXPECT_EQ(channel.flow.force[p], Vec3{});
          for (int c = 0; c < 3; ++c) {
            EXPECT_TRUE(std::isfinite(channel.flow.drag[p][c]) && channel.flow.drag[p][c] >= 0) << p << " along " << c;
            EXPECT_TRUE(std::isfinite(channel.flow.removed[p][c])) << p << " along " << c;
          }
        }
      }
}

}   // namespace
}   // namespace bedload

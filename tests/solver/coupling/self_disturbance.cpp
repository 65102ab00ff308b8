// What a grain samples of its own making, against the program's own operators, and published limits.
#include "solver/coupling/self_disturbance.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "solver/coupling/hydrodynamic_forces.hpp"
#include "solver/coupling/implicit_drag.hpp"
#include "solver/fluid/boundaries.hpp"
#include "solver/fluid/face_loops.hpp"
#include "solver/fluid/operators.hpp"
#include "solver/fluid/pressure_projection.hpp"
#include "tests/support/plain_kernel.hpp"

namespace bedload::test {
namespace {

using std::numbers::pi;
constexpr std::array<Side, 3> periodic_box = {Side::periodic, Side::periodic, Side::periodic};

StaggeredGrid grid_of(std::array<int, 3> cells, Vec3 h) { return {cells, h, periodic_box}; }

/// Mean over the positions in a cell of a function of the position.
template <class Value>
double mean_over_cell(const StaggeredGrid& g, Value&& value) {
  constexpr int n = 6;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k)
        sum += value(Vec3{(2 + (i + 0.5) / n) * g.h.x, (2 + (j + 0.5) / n) * g.h.y, (2 + (k + 0.5) / n) * g.h.z});
  return sum / (n * n * n);
}

/// Velocity along the force over the faces that bear it, by the grain's weights.
struct AtForce {
  double mean, variance;
};

/// Steady Stokes flow (nu = 1) under a unit force along `axis` at x, deposited with the grains' weights and balanced by a
/// uniform gradient, in a periodic box: the program's viscous solve and pressure solve in turn until nothing changes.
AtForce velocity_at_its_own_force(const StaggeredGrid& g, Vec3 x, int axis) {
  const Stencil stencil(g, x);
  FaceFields force(g), u(g), grad(g), lap(g), impulse(g), kick(g);
  const FaceFields one(g, 1);
  Vec3 unit;
  unit[axis] = 1 / g.cell_volume();
  deposit(stencil, Strides(g), unit, force);
  fold_deposits(g, force);
  for_each_unknown_face(g, axis, [&](std::size_t n) {
    force.component(axis)[n] -= 1 / (g.cell_volume() * static_cast<double>(g.cell_count()));
  });
  Field<Centre> q(g), dq(g), rhs(g);
  ImplicitDrag viscous(g);
  PressureSolver pressure(g);
  const double step = 20 * g.h.x * g.h.x;
  DragProblem problem;
  problem.implicit_viscosity = step;
  double before = 0;
  for (int iteration = 0; iteration < 200; ++iteration) {
    fill_velocity_ghosts(g, u, 0), fill_centre_ghosts(g, q);
    gradient(g, q, grad), laplacian(g, u, lap);
    for (int c = 0; c < 3; ++c)
      for_each_unknown_face(g, c, [&](std::size_t n) {
        impulse.component(c)[n] = step * (force.component(c)[n] - grad.component(c)[n] + lap.component(c)[n]);
      });
    viscous.solve(g, problem, one, impulse, u, {});
    fill_face_ghosts(g, u);
    divergence(g, u, rhs);
    for (double& r : rhs.values) r /= step;
    std::fill(dq.values.begin(), dq.values.end(), 0.0);
    pressure.solve(one, rhs, dq, 1e-6, 1e-14);
    gradient(g, dq, kick);
    for (int c = 0; c < 3; ++c)
      for_each_unknown_face(g, c, [&](std::size_t n) { u.component(c)[n] -= step * kick.component(c)[n]; });
    for (std::size_t n = 0; n < q.values.size(); ++n) q[n] += dq[n];
    extend_samples(g, u);
    const double own = sample(stencil, Strides(g), u)[axis];
    if (std::abs(own - before) < 1e-6 * std::abs(own)) {
      FaceFields square = u;
      for (double *v = square.component(axis), *end = v + g.padded_size(); v != end; ++v) *v *= *v;
      return {own, sample(stencil, Strides(g), square)[axis] - own * own};
    }
    before = own;
  }
  ADD_FAILURE() << "no steady flow";
  return {};
}

TEST(SelfDisturbance, IsTheProgramsOwnSteadyFlowAtAForce) {
  // A cubic array of equal forces slows their own flow by 2.837297/(6 pi L) (Hasimoto 1959, J. Fluid Mech. 5, 317).
  const StaggeredGrid g = grid_of({20, 20, 20}, {1, 1, 1});
  const SelfDisturbance table(g);
  for (const Vec3 x : {Vec3{10.5, 10.5, 10}, Vec3{10, 10, 10}, Vec3{10.5, 10.5, 10.5}, Vec3{10.2, 10.9, 10.35}}) {
    const AtForce flow = velocity_at_its_own_force(g, x, 2);
    const double alone = flow.mean + 2.837297 / (6 * pi * 20);
    EXPECT_NEAR(table.at(x, {}, 1).drag.z / alone, 1, 0.002) << x.x << " " << x.y << " " << x.z;
    const double unevenness = flow.variance / (alone * alone);   // the array's part is even
    EXPECT_NEAR(table.at(x, {}, 1).unevenness.z, unevenness, 0.01 * unevenness + 1e-6)
        << x.x << " " << x.y << " " << x.z;
  }
}

TEST(SelfDisturbance, KnowsFlatCells) {
  // The same cubic box of flat cells; forces along and across the short edge.
  const StaggeredGrid g = grid_of({10, 10, 40}, {2, 2, 0.5});
  const SelfDisturbance table(g);
  const Vec3 x{10.7, 9.4, 10.1};
  for (const int axis : {0, 2}) {
    const AtForce flow = velocity_at_its_own_force(g, x, axis);
    const double alone = flow.mean + 2.837297 / (6 * pi * 20);
    EXPECT_NEAR(table.at(x, {}, 1).drag[axis] / alone, 1, 0.005) << "axis " << axis;
    EXPECT_NEAR(table.at(x, {}, 1).unevenness[axis] / (flow.variance / (alone * alone)), 1, 0.02) << "axis " << axis;
  }
}

TEST(SelfDisturbance, HasTheMeanOfTheseWeightsOnCubes) {
  const StaggeredGrid g = grid_of({8, 8, 8}, {1, 1, 1});
  const SelfDisturbance table(g);
  EXPECT_NEAR(mean_over_cell(g, [&](Vec3 x) { return table.at(x, {}, 1).drag.z; }), 0.069, 0.0005);
  for (int c = 0; c < 3; ++c) {   // all directions are alike
    Vec3 x{2.3, 2.3, 2.3}, y = x;
    x.x = 2.1, y[c] = 2.1;
    EXPECT_NEAR(table.at(x, {}, 1).drag.x, table.at(y, {}, 1).drag[c], 1e-12);
  }
}

TEST(SelfDisturbance, ScalesWithTheCellAndFadesWithItsReynoldsNumber) {
  const StaggeredGrid g = grid_of({8, 8, 8}, {1, 1, 1}), half = grid_of({8, 8, 8}, {0.5, 0.5, 0.5});
  const SelfDisturbance coarse(g), fine(half);
  const Vec3 x{2.3, 2.1, 2.6};
  EXPECT_NEAR(fine.at(0.5 * x, {}, 1).drag.z, 2 * coarse.at(x, {}, 1).drag.z, 1e-12);
  double before = coarse.at(x, {}, 1).drag.z;
  for (const double re : {0.01, 0.1, 1.0, 10.0, 100.0, 1000.0, 1e4}) {
    const double now = coarse.at(x, {0, 0, -re}, 1).drag.z;
    EXPECT_LT(now, before) << "Re of the cell " << re;
    before = now;
  }
  // Fast: the force passes each wave before viscosity acts, so that what is left is proportional to 1/Re.
  EXPECT_NEAR(10 * coarse.at(x, {0, 0, -1e4}, 1).drag.z / coarse.at(x, {0, 0, -1e3}, 1).drag.z, 1, 0.02);
}

TEST(SelfDisturbance, FadesAtFirstAsOseensFlow) {
  // Lattice or not, far waves decide the first fall: u(0) - u(U) = 3 U/(8 nu) F/(6 pi mu), Oseen 1910, against the force's motion.
  const StaggeredGrid g = grid_of({8, 8, 8}, {1, 1, 1});
  const SelfDisturbance table(g);
  const double re = 0.01, slow = mean_over_cell(g, [&](Vec3 x) { return table.at(x, {}, 1).drag.z; }),
               moving = mean_over_cell(g, [&](Vec3 x) {
                 return table.at(x, {0, 0, re}, 1).drag.z;
               });
  EXPECT_NEAR((slow - moving) / (3.0 / 8 * re / (6 * pi)), 1, 0.05);
}

TEST(SelfDisturbance, LagsBehindTheMotion) {
  const StaggeredGrid g = grid_of({8, 8, 8}, {1, 1, 1});
  const SelfDisturbance table(g);
  const Vec3 just_past{2.5, 2.5, 2.2}, mirrored{2.5, 2.5, 2.8};
  EXPECT_NEAR(table.at(just_past, {0, 0, -2}, 1).drag.z, table.at(mirrored, {0, 0, 2}, 1).drag.z, 1e-12);
  EXPECT_GT(table.at(just_past, {0, 0, -2}, 1).drag.z, table.at(mirrored, {0, 0, -2}, 1).drag.z);
  EXPECT_NEAR(table.at(just_past, {}, 1).drag.z, table.at(mirrored, {}, 1).drag.z, 1e-12);
}

TEST(SelfDisturbance, SplitsTheOwnStressBetweenPressureAndViscosity) {
  // Along each axis the sum of w^2; a third of it is pressure on cubes, all of it when the flow has no time for viscosity.
  const StaggeredGrid g = grid_of({8, 8, 8}, {1, 1, 1});
  const SelfDisturbance table(g);
  const Vec3 centre{2.5, 2.5, 2.5};
  const double squares = 0.5 * std::pow(0.75 * 0.75 + 2.0 / 64, 2);   // hat in the middle, splines at their centres
  EXPECT_NEAR(table.at(centre, {}, 1).stress.z, squares, 1e-12);
  double displaced = 0, sum = 0;
  for (int c = 0; c < 3; ++c)
    displaced += mean_over_cell(g, [&](Vec3 x) { return table.at(x, {}, 1).displacement[c]; }),
        sum += mean_over_cell(g, [&](Vec3 x) { return table.at(x, {}, 1).stress[c]; });
  EXPECT_NEAR(displaced / sum, 0.375, 0.005);
  EXPECT_NEAR(table.at(centre, {0, 0, -1e5}, 1).stress.z / table.at(centre, {}, 1).displacement.z, 1, 0.01);
}

TEST(SelfDisturbance, IsTheSameEveryTime) {
  const StaggeredGrid g = grid_of({8, 8, 8}, {2, 2, 0.5});
  const SelfDisturbance a(g), b(g);
  const OwnFlow x = a.at({3, 4, 1.1}, {1, 2, 3}, 1), y = b.at({3, 4, 1.1}, {1, 2, 3}, 1);
  EXPECT_TRUE(x.drag == y.drag && x.displacement == y.displacement && x.stress == y.stress);
}

Grains grains_at(std::vector<Vec3> places, double diameter) {
  Grains grains;
  grains.resize(places.size());
  grains.position = std::move(places);
  std::fill(grains.diameter.begin(), grains.diameter.end(), diameter);
  std::fill(grains.density.begin(), grains.density.end(), 2650.0);
  return grains;
}

GrainPacking packing_of(const StaggeredGrid& g, const Grains& grains) {
  Stencils stencils;
  find_stencils(g, grains, stencils);
  VoidFraction eps(g);
  deposit_void_fraction(g, grains, stencils, eps);
  extend_samples(g, eps.centre);
  std::vector<double> sampled;
  for (const Stencil& s : stencils) sampled.push_back(sample(s, Strides(g), on_cells, eps.centre.data()));
  GrainPacking packing;
  find_packing(g, grains, eps.centre, sampled, packing);
  return packing;
}

TEST(PackingOfOthers, IsZeroForALoneGrainAnywhere) {
  StaggeredGrid g = grid_of({4, 5, 6}, {1, 1, 0.5});
  for (const Side side : {Side::periodic, Side::wall}) {
    g.sides = {side, side, side};
    for (const Vec3 x : {Vec3{2, 2, 1.5}, Vec3{0, 0, 0}, Vec3{0.1, 4.9, 2.99}, Vec3{4, 5, 3}, Vec3{1.5, 0.3, 0.4}}) {
      const GrainPacking packing = packing_of(g, grains_at({x}, 0.6));
      EXPECT_NEAR(packing.others[0], 0, 1e-12);
      EXPECT_GT(packing.own[0], 0);
    }
  }
}

TEST(PackingOfOthers, CountsNeighboursAndTheirPlane) {
  const StaggeredGrid g = grid_of({8, 8, 8}, {1, 1, 1});
  const double volume = sphere_volume(0.5);
  const GrainPacking near = packing_of(g, grains_at({{4.5, 4.5, 4.5}, {4.5, 4.5, 4.5}}, 0.5));
  EXPECT_NEAR(near.others[0], near.own[0], 1e-15);   // the other one stands where it stands itself
  const GrainPacking far = packing_of(g, grains_at({{1.5, 1.5, 4.5}, {5.5, 5.5, 4.5}}, 0.5));
  const double in_plane = 0.75 * 0.75 + 2.0 / 64;   // spline against spline
  EXPECT_NEAR(far.others[0], volume / 64 * in_plane, 1e-15);
  const GrainPacking apart = packing_of(g, grains_at({{1.5, 1.5, 1.5}, {1.5, 1.5, 5.5}}, 0.5));
  EXPECT_NEAR(apart.others[0], 0, 1e-15);
}

TEST(PackingOfOthers, MakesALoneGrainAndABedWithAllBetween) {
  EXPECT_EQ(loneness(0, 0.04), 1);
  EXPECT_EQ(loneness(0.01, 0.04), 1);
  EXPECT_EQ(loneness(0.04, 0.04), 0);
  EXPECT_EQ(loneness(0.6, 0.04), 0);
  EXPECT_EQ(loneness(0.07, 0.3), 1);
  EXPECT_EQ(loneness(0.3, 0.3), 0);
  EXPECT_EQ(loneness(0.1875, 0.3), 0.5);   // half-way
  for (double phi = 0.011; phi < 0.039; phi += 0.001) EXPECT_GT(loneness(phi, 0.04), loneness(phi + 0.001, 0.04));
}

/// Drag of a still grain in a uniform stream along x, alone or amid 26 others of its kind that touch; cells of h diameters.
Vec3 drag_of_a_grain(double h, bool lone, Terms terms) {
  const StaggeredGrid g = grid_of({8, 8, 8}, {h, h, h});
  std::vector<Vec3> places{{4.3 * h, 4.1 * h, 4.6 * h}};
  for (int n = 0; n < 27 && !lone; ++n)
    if (n != 13) places.push_back(places[0] + Vec3{n / 9 - 1.0, n / 3 % 3 - 1.0, n % 3 - 1.0});
  const Grains grains = grains_at(places, 1);
  Stencils stencils;
  find_stencils(g, grains, stencils);
  VoidFraction eps(g);
  deposit_void_fraction(g, grains, stencils, eps);
  FaceFields u(g), a(g);
  for_each_unknown_face(g, 0, [&](std::size_t n) { u.component(0)[n] = 1e-3; });
  FlowAtGrains flow;
  sample_flow(g, grains, stencils, u, a, eps.centre, DiFelice{}, 1, terms, flow);
  return flow.drag[0];
}

TEST(LoneGrain, DoesNotSeeItsOwnVolume) {
  // 3 pi nu d F(1, Re) however small the cell; in company F(eps) eps with the volume of all.
  const double law = 3 * pi * DiFelice{}.multiplier(1, 1e-3);
  EXPECT_NEAR(drag_of_a_grain(2.5, true, {}).x / law, 1, 1e-12);
  EXPECT_NEAR(drag_of_a_grain(1, true, {}).x / law, 1, 1e-12);
  EXPECT_GT(drag_of_a_grain(2, false, {}).x / law, 1.5);
}

TEST(LoneGrain, IsLoneInTheCompanyThatTheSceneCallsSo) {
  const double law = 3 * pi * DiFelice{}.multiplier(1, 1e-3);
  const double in_company = drag_of_a_grain(2, false, {}).x;
  const auto with_crowded = [&](double packing) {
    Terms terms;
    terms.crowded = packing;
    return drag_of_a_grain(2, false, terms).x;
  };
  EXPECT_EQ(with_crowded(0.04), in_company);
  EXPECT_LT(with_crowded(1), in_company);   // its own volume is left out, that of the others is not
  EXPECT_GT(with_crowded(1), law);
}

Terms model_b_without_own_flow() {
  Terms terms;
  terms.self_disturbance = true, terms.pressure_gradient = terms.viscous_stress = false;
  return terms;
}

TEST(LoneGrain, IsGivenSoMuchLessDragInModelAAsTheStressOfItsOwnDragBrings) {
  // A slow flow passes on as stress what it gets: -grad q + nu lap u = -w f/V_c, of which the grain samples sum w^2.
  const double h = 1.25;
  const StaggeredGrid g = grid_of({8, 8, 8}, {h, h, h});
  const Stencil stencil(g, {4.3 * h, 4.1 * h, 4.6 * h});
  FaceFields weights(g);
  deposit(stencil, Strides(g), Vec3{1, 1, 1}, weights);
  const double squares = sample(stencil, Strides(g), weights).x, volume = sphere_volume(1) / g.cell_volume();
  EXPECT_GT(volume * squares, 0.03);
  Terms a;
  a.self_disturbance = true;
  const double ratio = drag_of_a_grain(h, true, model_b_without_own_flow()).x / drag_of_a_grain(h, true, a).x;
  EXPECT_NEAR(ratio, 1 + volume * squares, 0.001);
}

TEST(LoneGrain, IsFreedOfTheFlowThatGetsOutOfItsWay) {
  // A grain that moves through still fluid and hardly drags on it (Ergun's law): u = -grad q with div(u + J) = 0.
  const double h = 1.25, speed = 1e-3;
  const StaggeredGrid g = grid_of({16, 16, 16}, {h, h, h});
  Grains grains = grains_at({{8.3 * h, 8.1 * h, 8.6 * h}}, 1);
  grains.velocity[0] = {0, 0, speed};
  Stencils stencils;
  find_stencils(g, grains, stencils);
  FaceFields flux(g), u(g), still(g);
  deposit(stencils[0], Strides(g), sphere_volume(1) / g.cell_volume() * grains.velocity[0], flux);
  fold_deposits(g, flux), fill_face_ghosts(g, flux);
  Field<Centre> q(g), rhs(g), eps(g, 1);
  divergence(g, flux, rhs);
  PressureSolver(g).solve(FaceFields(g, 1), rhs, q, 1e-10, 0);
  gradient(g, q, u);
  for (int c = 0; c < 3; ++c) for_each_unknown_face(g, c, [&](std::size_t n) { u.component(c)[n] *= -1; });
  FlowAtGrains flow;
  sample_flow(g, grains, stencils, u, still, eps, Ergun{}, 1, model_b_without_own_flow(), flow);
  EXPECT_LT(flow.velocity[0].z / speed, -0.01);
  const double law = 3 * pi * Ergun{}.multiplier(1, speed) * speed;
  EXPECT_NEAR(flow.drag[0].z * (speed - flow.velocity[0].z) / law, 1, 0.003);
}

TEST(LoneGrain, IsFreedOfItsOwnFlowAndAGrainInCompanyIsNot) {
  Terms with;
  with.self_disturbance = true;
  const double h = 2.5, law = 3 * pi * DiFelice{}.multiplier(1, 1e-3);
  const StaggeredGrid g = grid_of({8, 8, 8}, {h, h, h});
  const double k = law * SelfDisturbance(g).at({4.3 * h, 4.1 * h, 4.6 * h}, {1e-3, 0, 0}, 1).drag.x;
  EXPECT_NEAR(drag_of_a_grain(h, true, with).x / law, 1 / (1 - k), 0.05);
  EXPECT_GT(drag_of_a_grain(h, true, with).x / law, 1.2);
  EXPECT_EQ(drag_of_a_grain(2, false, with), drag_of_a_grain(2, false, {}));
}

}   // namespace
}   // namespace bedload::test

// The fluid as profile, column and box: the same grains, drag and outputs; what each conserves, and where they agree.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "solver/bed/bed_profiles.hpp"
#include "solver/experiment.hpp"
#include "solver/mixture_momentum.hpp"
#include "solver/step_judgement.hpp"
#include "tests/support/scenes.hpp"

namespace bedload::test {
namespace {

constexpr double d = 0.467e-3, nu = 1e-5, density_ratio = 1.5;   // Ga^2 = 5

/// 7.2 x 5.2 x 12 d with cells of 1.8 x 1.7 x 0.5 d, or layers as high; grains of a table, under a lid.
Scene sheared(FluidRung rung, double shields, const std::string& csv, std::uint64_t count) {
  const bool box = rung == FluidRung::box;
  const std::array<int, 3> cells = {box ? 4 : 1, box ? 3 : 1, 24};
  Scene scene = fluid_scene(cells, {7.2 * d / cells[0], 5.2 * d / cells[1], 0.5 * d}, channel, nu);
  scene.fluid = rung;
  scene.bed.gravity = {0, 0, -9.81};
  add_grains(scene, d, density_ratio, 0.02);
  scene.bed.source = {.kind = BedSource::Kind::file, .count = count, .csv = csv};
  scene.drive = {FlowRamp::Kind::lid, FlowRamp::Quantity::shields, {shields}, 0};
  scene.onset.method = Onset::Method::none;
  scene.record.every = 10 * scene.steps.fluid_interval;
  return scene;
}

/// Five layers of grains, nearly a cubic lattice, each moved a little at random.
std::string fixed_bed(int fixed) {
  std::string csv = "x,y,z,diameter,density,fixed\n";
  const std::vector<Vec3> places = cubic_places({7, 5, 5}, {0, 0, 0.05 * d}, {7.2 * d, 5.2 * d, 5.2 * d}, 0.01 * d, 11);
  for (const Vec3& x : places)
    csv += std::to_string(x.x * 1e3) + "e-3," + std::to_string(x.y * 1e3) + "e-3," + std::to_string(x.z * 1e3) +
           "e-3," + std::to_string(d * 1e3) + "e-3,1500," + std::to_string(fixed) + "\n";
  return csv;
}
constexpr std::uint64_t in_bed = 7 * 5 * 5;

struct Steady {
  double lid_stress;             // [Pa]
  double lid_speed;              // [m/s]
  std::vector<double> profile;   // mean over planes [m/s]
  double shields_measured;
};

/// The flow over a fixed bed after it has gone three times through the gap.
Steady steady_over_fixed_bed(FluidRung rung) {
  Scene scene = sheared(rung, 0.05, fixed_bed(1), in_bed);
  const double height = scene.bed.length.z;
  scene.drive.dwell = 0.6 * height * height / nu;   // six times H^2/(pi^2 nu)
  scene.steps.fluid_interval = scene.drive.dwell / 400;
  scene.record.every = scene.drive.dwell / 10;
  Experiment experiment(scene);
  State state = experiment.begin();
  while (!Experiment::finished(state)) {
    const StepHealth health = experiment.step(state);
    EXPECT_EQ(ailment(health), "");
    if (testing::Test::HasFailure()) break;
  }
  return {-experiment.coupler().books().on_lid.x / (scene.bed.length.x * scene.bed.length.y),
          state.record.holds.lid_speed.at(0), plane_means(state.fluid.velocity.x, scene.grid),
          state.record.holds.shields_measured.at(0)};
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (std::size_t k = 0; k < a.size(); ++k) largest = std::max(largest, std::abs(a[k] - b[k]));
  return largest;
}

TEST(FluidRungs, ColumnAndBoxAgreeOverAFixedBedInLaminarFlow) {
  const Steady box = steady_over_fixed_bed(FluidRung::box), column = steady_over_fixed_bed(FluidRung::column),
               profile = steady_over_fixed_bed(FluidRung::profile);
  EXPECT_NEAR(column.lid_stress / box.lid_stress, 1, 0.02);
  EXPECT_LT(largest_difference(column.profile, box.profile), 0.02 * box.lid_speed);
  EXPECT_NEAR(column.shields_measured / box.shields_measured, 1, 0.02);
  const auto report = [&](const std::string& name, const Steady& rung) {   // the profile's is a number, no verdict
    RecordProperty(name + "_lid_stress_per_box", std::to_string(rung.lid_stress / box.lid_stress));
    RecordProperty(name + "_profile_per_lid_speed",
                   std::to_string(largest_difference(rung.profile, box.profile) / box.lid_speed));
    RecordProperty(name + "_shields_per_box", std::to_string(rung.shields_measured / box.shields_measured));
    std::printf("%s: lid stress / box %.4f, profile off by %.4f lid speeds, measured Shields / box %.4f\n",
                name.c_str(), rung.lid_stress / box.lid_stress,
                largest_difference(rung.profile, box.profile) / box.lid_speed,
                rung.shields_measured / box.shields_measured);
  };
  report("column", column), report("profile", profile);
}

/// A hold in a column begins with its own steady flow: over grains that do not move it stays, and a gradient's stress is the nominal one.
TEST(FluidRungs, AColumnBeginsItsHoldsWithItsOwnSteadyFlow) {
  for (const bool turbulence : {false, true})
    for (const FlowRamp::Kind kind : {FlowRamp::Kind::lid, FlowRamp::Kind::pressure}) {
      Scene scene = sheared(FluidRung::column, 0.05, fixed_bed(1), in_bed);
      scene.terms.turbulence = turbulence;
      scene.terms.added_mass = scene.terms.viscous_torque = scene.terms.shear_lift = true;
      scene.drive.kind = kind;
      scene.drive.levels = {0.05, 0.08};   // the second is the first and an increment
      if (kind == FlowRamp::Kind::pressure) scene.bed.top = scene.grid.top = Top::free_slip;
      scene.drive.dwell = 100 * scene.steps.fluid_interval;
      Experiment experiment(scene);
      State state = experiment.begin();
      for (const int hold : {0, 1}) {
        ASSERT_EQ(ailment(experiment.step(state)), "");
        const FluidState begun = state.fluid;
        while (!Experiment::finished(state) && state.search.hold == std::uint64_t(hold))
          ASSERT_EQ(ailment(experiment.step(state)), "");
        const auto u = plane_means(state.fluid.velocity.x, scene.grid),
                   before = plane_means(begun.velocity.x, scene.grid);
        EXPECT_GT(u.back(), 0);
        EXPECT_LT(largest_difference(u, before), 1e-8 * u.back()) << turbulence << int(kind) << hold;
        const BedRecord::Holds& row = state.record.holds;
        const auto n = static_cast<std::size_t>(hold);
        EXPECT_LT(row.stress_residual.at(n), 1e-6);
        if (kind == FlowRamp::Kind::pressure) {
          EXPECT_NEAR(row.shields_measured.at(n), scene.drive.levels[n], 1e-6 * scene.drive.levels[n]);
        }
      }
    }
}

struct Drive {
  FlowRamp::Kind kind;
  bool added_mass, viscous_torque;
};
class MomentumOfAColumn : public testing::TestWithParam<Drive> {};
INSTANTIATE_TEST_SUITE_P(FluidRungs, MomentumOfAColumn,
                         testing::Values(Drive{FlowRamp::Kind::lid, false, false},
                                         Drive{FlowRamp::Kind::pressure, false, false},
                                         Drive{FlowRamp::Kind::lid, true, false},
                                         Drive{FlowRamp::Kind::lid, false, true},
                                         Drive{FlowRamp::Kind::pressure, true, true}));

/// Free grains that collide in a flow that throws them about: every step's books close.
TEST_P(MomentumOfAColumn, IsThatOfItsGrainsAndWallsToo) {
  Scene scene = sheared(FluidRung::column, 1.5, fixed_bed(0), in_bed);
  scene.drive.kind = GetParam().kind;
  scene.terms.shear_lift = scene.terms.turbulence = true;
  scene.terms.added_mass = GetParam().added_mass, scene.terms.viscous_torque = GetParam().viscous_torque;
  scene.drive.dwell = 200 * scene.steps.fluid_interval;
  Experiment experiment(scene);
  State state = experiment.begin();
  MixtureMomentum momentum(scene);
  experiment.step(state);   // imposes the flow
  double moved = 0, size = 0, worst = 0;
  while (!Experiment::finished(state)) {
    const double before = momentum(state, 0).total, time = state.clock.time;
    const auto x = state.grains.position;
    ASSERT_EQ(ailment(experiment.step(state)), "");
    const StepBooks& books = experiment.coupler().books();
    const double force = books.driving.x - books.on_bottom.x - books.on_lid.x - books.contact_on_walls.x;
    const double after = momentum(state, 0).total;
    worst = std::max(worst, std::abs(after - before - (state.clock.time - time) * force));
    size = std::max({size, std::abs(before), std::abs(after)});
    for (std::size_t p = 0; p < x.size(); ++p) moved = std::max(moved, std::abs(state.grains.position[p].z - x[p].z));
  }
  EXPECT_GT(moved, 1e-4 * d);
  EXPECT_LT(worst, 1e-11 * size);
  ASSERT_FALSE(state.record.holds.momentum_residual.empty());
  EXPECT_GE(state.record.holds.momentum_residual[0], 0);
  EXPECT_LT(state.record.holds.momentum_residual[0], 1e-8);
}

TEST(FluidRungs, AProfileDoesNotAnswerToGrainsAndSaysThatItsMomentumIsNotKnown) {
  Scene scene = sheared(FluidRung::profile, 0.3, fixed_bed(0), in_bed);
  scene.drive.dwell = 60 * scene.steps.fluid_interval;
  Experiment experiment(scene);
  State state = experiment.begin();
  experiment.step(state);
  const auto imposed = state.fluid;
  EXPECT_GT(experiment.coupler().books().on_grains.x, 0);   // they are dragged nevertheless
  while (!Experiment::finished(state)) ASSERT_EQ(ailment(experiment.step(state)), "");
  EXPECT_EQ(state.fluid, imposed);
  EXPECT_LT(state.record.holds.momentum_residual.at(0), 0);
  EXPECT_DOUBLE_EQ(plane_means(state.fluid.velocity.x, scene.grid).front(), 0);   // deep in the bed
}

/// Near the bed the profiles of a lid and of a gradient are alike, and so must be what their beds measure: the gradient's fluid in the bed stands
/// still and hands nothing on, the volume of the grains feels it in Model A.
TEST(FluidRungs, AProfilesBedMeasuresTheSameUnderALidAndAGradient) {
  const auto measured = [](bool model_a, FlowRamp::Kind kind) {
    Scene scene = sheared(FluidRung::profile, 0.05, fixed_bed(1), in_bed);
    scene.terms.pressure_gradient = scene.terms.viscous_stress = model_a;
    scene.drive.kind = kind;
    if (kind == FlowRamp::Kind::pressure) scene.bed.top = scene.grid.top = Top::free_slip;
    scene.drive.dwell = 20 * scene.steps.fluid_interval;
    Experiment experiment(scene);
    State state = experiment.begin();
    while (!Experiment::finished(state)) EXPECT_EQ(ailment(experiment.step(state)), "");
    return state.record.holds.shields_measured.at(0);
  };
  for (const bool model_a : {true, false})
    EXPECT_NEAR(measured(model_a, FlowRamp::Kind::pressure) / measured(model_a, FlowRamp::Kind::lid), 1, 0.05)
        << model_a;
}

/// One weightless grain in the middle of 20 x 20 x 20 d of layers of d/5.
struct Alone {
  Alone(FluidRung rung, Top top, double viscosity)
      : scene(fluid_scene({1, 1, 100}, {20 * d, 20 * d, 0.2 * d}, channel, viscosity)) {
    scene.fluid = rung;
    scene.bed.top = scene.grid.top = top;
    add_grains(scene, d, density_ratio, 0.02);
    state = state_of(scene, {{10 * d, 10 * d, 10.03 * d}}, false);
  }
  double& u(int k) { return state.fluid.velocity.x[scene.grid.index(0, 0, k)]; }
  void run(double time, double step) {
    Coupler coupler(scene);
    while (state.clock.time < time * (1 - 1e-12))
      ASSERT_EQ(ailment(coupler.step(state, std::min(step, time - state.clock.time))), "");
  }
  Scene scene;
  State state;
};

TEST(FluidRungs, AGrainInALinearShearTurnsWithHalfOfIt) {
  for (const FluidRung rung : {FluidRung::column, FluidRung::profile}) {
    Alone one(rung, Top::lid, nu);
    one.scene.terms.viscous_torque = true;
    const double shear = 10, relaxation = density_ratio * d * d / (60 * nu);   // I/(pi mu d^3)
    one.state.search.lid_speed = shear * 20 * d;
    for (int k = 0; k < 100; ++k) one.u(k) = shear * (k + 0.5) * 0.2 * d;
    one.state.grains.velocity[0].x = shear * 10.03 * d;
    one.run(relaxation, relaxation / 100);
    EXPECT_NEAR(one.state.grains.spin[0].y, 0.5 * shear * (1 - std::exp(-1)), 0.02 * 0.5 * shear);
    one.run(30 * relaxation, relaxation);
    EXPECT_NEAR(one.state.grains.spin[0].y, 0.5 * shear, 1e-3 * 0.5 * shear);
    EXPECT_LT(std::abs(one.state.grains.spin[0].x) + std::abs(one.state.grains.spin[0].z), 1e-12 * shear);
  }
}

/// dv/dt = (s - 1) g/(s + 1/2) of a lone grain let go, and (1 + 1/2) G/(s + 1/2) of one in a fluid that G drives: before drag tells.
TEST(FluidRungs, AGrainLetGoCarriesHalfItsVolumeOfLiquid) {
  for (const FluidRung rung : {FluidRung::column, FluidRung::profile})
    for (const bool added : {false, true}) {
      Alone one(rung, Top::free_slip, 1e-9);
      one.scene.terms.added_mass = added;
      one.scene.bed.gravity = {0, 0, -9.81};
      if (rung == FluidRung::column) one.state.search.gradient = 2;
      const double time = 2e-3, carried = added ? 0.5 : 0;
      one.run(time, time / 100);
      const Vec3 v = one.state.grains.velocity[0];
      EXPECT_NEAR(v.z, -(density_ratio - 1) * 9.81 * time / (density_ratio + carried), 0.02 * std::abs(v.z)) << added;
      if (rung == FluidRung::profile) continue;
      EXPECT_NEAR(v.x, (1 + carried) * 2 * time / (density_ratio + carried), 0.02 * v.x);
    }
}

/// The liquid of grains at rest in it neither stirs nor smooths it: noise within a grain's height does not grow, whatever its wave.
TEST(FluidRungs, AddedMassLetsNoNoiseOfAColumnGrow) {
  for (const double s : {1.05, 2.65}) {
    Scene scene = fluid_scene({1, 1, 60}, {5 * d, 5 * d, 0.1 * d}, channel, 1e-12);
    scene.fluid = FluidRung::column;
    add_grains(scene, d, s, 0.02);
    scene.terms.added_mass = true;
    State state = state_of(scene, cubic_places({5, 5, 6}, {0, 0, 0}, {5 * d, 5 * d, 6 * d}, 0, 1), false);
    for (int k = 0; k < 60; ++k) state.fluid.velocity.x[scene.grid.index(0, 0, k)] = k % 2 ? 1e-6 : -1e-6;
    Coupler coupler(scene);
    for (int n = 0; n < 300; ++n) ASSERT_EQ(ailment(coupler.step(state, scene.steps.fluid_interval)), "");
    for (int k = 0; k < 60; ++k) EXPECT_LE(std::abs(state.fluid.velocity.x[scene.grid.index(0, 0, k)]), 1.1e-6) << k;
  }
}

TEST(FluidRungs, RefuseWhatTheyCannotCarry) {
  const Scene good = sheared(FluidRung::column, 0.1, fixed_bed(0), in_bed);
  const auto refused = [](Scene scene, const char* key) {
    const auto problems = problems_of(scene);
    return std::ranges::any_of(problems, [&](const auto& p) {
      return p.parameter == key && p.message.starts_with("models.fluid = \"") && !p.hint.empty();
    });
  };
  EXPECT_TRUE(
      std::ranges::none_of(problems_of(good), [](const auto& p) { return p.message.starts_with("models.fluid"); }));
  for (const int c : {0, 1}) {
    Scene walled = good;
    walled.bed.sides[c] = walled.grid.sides[c] = Side::wall;
    EXPECT_TRUE(refused(walled, c == 0 ? "box.x" : "box.y"));
  }
  Scene bottomless = good;
  bottomless.bed.sides[2] = bottomless.grid.sides[2] = Side::periodic;
  EXPECT_TRUE(refused(bottomless, "box.z"));
  Scene vortices = good;
  vortices.fluid_start = FluidStart::taylor_green;
  EXPECT_TRUE(refused(vortices, "fluid.start"));
  Scene smoothed = good;
  smoothed.smoothing.z = d;
  EXPECT_TRUE(refused(smoothed, "models.smoothing"));
  for (const auto term : {&Terms::self_disturbance, &Terms::wall_forces}) {
    Scene more = good;
    more.terms.*term = true;
    EXPECT_TRUE(refused(more, "models.terms"));
  }
  Scene model_b = good;
  model_b.terms.pressure_gradient = model_b.terms.viscous_stress = false;
  EXPECT_TRUE(refused(model_b, "models.terms"));
  model_b.fluid = FluidRung::profile;
  EXPECT_FALSE(refused(model_b, "models.terms"));
  model_b.developed = false;
  EXPECT_TRUE(refused(model_b, "drive.start"));
}

}   // namespace
}   // namespace bedload::test

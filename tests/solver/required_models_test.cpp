// Which models a scene requires, against the numbers of scenes that were worked out by hand.
#include "solver/required_models.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "solver/scene_range.hpp"

namespace bedload {
namespace {

/// 20 000 grains of 1 mm and 3000 kg/m3 in water, a gap of about 10 mm below a lid.
Scene erosion_in_water() {
  Scene scene;
  scene.bed.fluid = {1000, 1e-6};
  scene.bed.grains = {
      .diameter = 1e-3, .density = 3000, .friction = 0.4, .restitution = 0.6, .poisson = 0.3, .young_modulus = 1.2e7};
  scene.bed.source = {.kind = BedSource::Kind::poured, .count = 20000};
  scene.bed.length = {0.06, 0.03, 0.02};
  scene.bed.sides = {Side::periodic, Side::periodic, Side::wall};
  scene.bed.gravity = {0, 0, -9.81};
  scene.bed.dem_step = 1e-5;
  scene.grid = {.cells = {30, 15, 40}, .h = {2e-3, 2e-3, 0.5e-3}, .sides = scene.bed.sides};
  scene.drive = {
      .kind = FlowRamp::Kind::lid, .quantity = FlowRamp::Quantity::shields, .levels = {0.03, 0.06, 0.12}, .dwell = 2};
  scene.steps.fluid_interval = 1e-4;
  scene.record.every = 0.01;
  scene.terms = wanted_terms(scene);
  return scene;
}

/// The same in a liquid a hundred times as viscous: laminar.
Scene laminar_bed() {
  auto scene = erosion_in_water();
  scene.bed.fluid.viscosity = 1e-4;
  scene.terms = wanted_terms(scene);
  return scene;
}

/// Free spheres of 0.1 mm and 3000 kg/m3 in water, in a closed box of 1 x 1 x 5 mm; rows "x,y,z" in mm.
Scene spheres_in_a_column(std::initializer_list<const char*> rows) {
  Scene scene = erosion_in_water();
  scene.bed.grains.diameter = 1e-4;
  std::string csv = "x,y,z,diameter,density,fixed\n";
  for (const char* row : rows) csv += std::string(row) + ",1e-4,3000,0\n";
  scene.bed.source = {.kind = BedSource::Kind::file, .count = rows.size(), .csv = csv};
  scene.bed.length = {1e-3, 1e-3, 5e-3};
  scene.bed.sides = {Side::wall, Side::wall, Side::wall};
  scene.grid = {.cells = {4, 4, 20}, .h = {0.25e-3, 0.25e-3, 0.25e-3}, .sides = scene.bed.sides};
  scene.drive = {.levels = {0}, .dwell = 0.1};
  scene.onset.method = Onset::Method::none;
  scene.terms = wanted_terms(scene);
  return scene;
}
Scene settling_sphere() { return spheres_in_a_column({"0.5e-3,0.5e-3,4e-3"}); }

/// Sand of 0.1 mm in water, 20 mm below a lid: at theta = 0.2 u* = 18 mm/s, Re* = 1.8, a lid at 6.5 m/s, gap Re 1.3e5.
void become_fine_sand(Scene& scene) {
  scene.bed.fluid.viscosity = 1e-6;
  scene.bed.grains.diameter = 1e-4, scene.bed.grains.density = 2650;
  scene.bed.length = {4e-3, 2e-3, 0.0206};   // some 6 d of bed
  scene.bed.source.count = 5200;
  scene.grid = {.cells = {20, 10, 412}, .h = {0.2e-3, 0.2e-3, 0.05e-3}, .sides = scene.bed.sides};
}

ModelChoice choice(const Scene& scene, const std::string& term) {
  const auto models = required_models(scene);
  const auto found = std::ranges::find(models, term, &ModelChoice::term);
  return found == models.end() ? ModelChoice{} : *found;
}

bool warns(const Scene& scene, const std::string& of) {
  return std::ranges::any_of(warnings_of(scene), [&](const std::string& w) { return w.find(of) != w.npos; });
}

// theta = 0.2: tau_b = 3.924 Pa, u*^2 = 3.924e-3 m2/s2, Re* = 62.6; 3924 1/s over 10 mm is a lid at 39 m/s, Re 3.9e5.
TEST(RequiredModels, QuoteTheFlowAtTheShieldsNumberOfOnset) {
  const auto n = numbers_of(erosion_in_water());
  EXPECT_NEAR(n.friction_reynolds, 62.64, 0.01);
  EXPECT_NEAR(n.shear_reynolds, 3924, 1);
  EXPECT_NEAR(n.gap, 0.010, 1e-4);
  EXPECT_NEAR(n.flow_speed / n.gap, 3924, 1);
  EXPECT_NEAR(n.gap_reynolds, 3.9e5, 0.05e5);
  EXPECT_NEAR(n.lowest_shields, 0.03, 1e-12);
}

// A ramp may go down, or turn round.
TEST(RequiredModels, QuoteTheWeakestAndTheStrongestFlowInWhateverOrder) {
  auto scene = laminar_bed();
  scene.drive.levels = {1, 2};
  const auto up = numbers_of(scene);
  scene.drive.levels = {2, 1};
  const auto down = numbers_of(scene);
  EXPECT_NEAR(down.lowest_shields, 1, 1e-12);
  EXPECT_NEAR(down.highest_shields, 2, 1e-12);
  scene.drive.levels = {1, -2, 1.5};
  const auto reversed = numbers_of(scene);
  EXPECT_NEAR(reversed.lowest_shields, 1, 1e-12);
  EXPECT_NEAR(reversed.highest_shields, 2, 1e-12);
  EXPECT_EQ(reversed.grain_reynolds, up.grain_reynolds);
}

TEST(RequiredModels, CallALaminarSceneInWaterUnphysical) {
  auto scene = erosion_in_water();
  EXPECT_TRUE(choice(scene, "turbulence").wanted);
  EXPECT_FALSE(warns(scene, "not physical"));
  scene.terms.turbulence = false;
  EXPECT_TRUE(warns(scene, "not physical"));
  EXPECT_TRUE(warns(scene, "leaves out"));
}

// A sublayer of 5 nu/u* = 0.28 mm covers grains of 0.1 mm: they do not ask for the term, but the flow above is not laminar.
TEST(RequiredModels, SayThatTheFlowAboveASmoothBedIsTurbulent) {
  auto scene = laminar_bed();
  become_fine_sand(scene);
  EXPECT_NEAR(numbers_of(scene).friction_reynolds, 1.80, 0.01);
  EXPECT_NEAR(numbers_of(scene).gap_reynolds, 1.3e5, 0.02e5);
  const auto turbulence = choice(scene, "turbulence");
  EXPECT_FALSE(turbulence.wanted);
  EXPECT_NE(turbulence.reason.find("the sublayer covers the grains, the flow above is turbulent"), std::string::npos);
  EXPECT_TRUE(warns(scene, "gap Reynolds number of 1.3e+05"));
  scene.terms.turbulence = true;
  EXPECT_FALSE(warns(scene, "gap Reynolds number"));
}

// The limits of channels say nothing of a flow with walls across it.
TEST(RequiredModels, CallNoCavityTurbulent) {
  auto scene = erosion_in_water();
  scene.bed.sides[0] = scene.grid.sides[0] = Side::wall;
  scene.terms.turbulence = false;
  const auto turbulence = choice(scene, "turbulence");
  EXPECT_FALSE(turbulence.wanted);
  EXPECT_NE(turbulence.reason.find("laminar assumed: walls across the flow"), std::string::npos);
  EXPECT_FALSE(warns(scene, "gap Reynolds number"));
  scene.bed.fluid.viscosity = 1e-4;
  EXPECT_TRUE(choice(scene, "turbulence").reason.ends_with(": laminar"));
}

TEST(RequiredModels, AcceptALaminarSceneInAViscousLiquid) {
  EXPECT_FALSE(choice(laminar_bed(), "turbulence").wanted);
  EXPECT_EQ(warnings_of(laminar_bed()), std::vector<std::string>());
}

// Ga = 1.4, theta = 0.2: Re_g = 0.39 is slow shear, so neither lift nor Magnus force.
TEST(RequiredModels, OfALaminarBed) {
  const Terms wanted = wanted_terms(laminar_bed());
  Terms expected{.self_disturbance = true, .added_mass = true, .viscous_torque = true, .wet_restitution = true};
  EXPECT_EQ(wanted, expected);
}

TEST(RequiredModels, OfASphereThatSettlesInAClosedBox) {
  const Terms wanted = wanted_terms(settling_sphere());
  Terms expected{.self_disturbance = true, .added_mass = true, .wall_forces = true, .wet_restitution = true};
  EXPECT_EQ(wanted, expected);
  EXPECT_NEAR(numbers_of(settling_sphere()).settling_reynolds, 0.8981, 1e-4);   // Di Felice's own
  EXPECT_EQ(choice(settling_sphere(), "viscous_torque").ratio, 0);
  EXPECT_EQ(warnings_of(settling_sphere()), std::vector<std::string>());
}

TEST(RequiredModels, OfABoxWithoutGrains) {
  auto scene = erosion_in_water();
  scene.bed.source = {};
  scene.drive.quantity = FlowRamp::Quantity::lid_speed;
  scene.drive.levels = {0.05};   // over 20 mm of water: Re 1000
  EXPECT_FALSE(choice(scene, "turbulence").wanted);
  EXPECT_NEAR(numbers_of(scene).gap_reynolds, 1000, 1e-9);
  scene.drive.levels = {0.1};
  EXPECT_TRUE(choice(scene, "turbulence").wanted);
  for (const auto& m : required_models(scene)) EXPECT_EQ(m.wanted, m.term == "turbulence") << m.term;
}

TEST(RequiredModels, DoNotDependOnTheEndOfTheRamp) {
  for (const auto& scene : {erosion_in_water(), laminar_bed()}) {
    auto longer = scene;
    longer.drive.levels.push_back(2.4);
    EXPECT_EQ(wanted_terms(longer), wanted_terms(scene));
    const auto a = required_models(scene), b = required_models(longer);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t n = 0; n < a.size(); ++n) {
      EXPECT_EQ(a[n].wanted, b[n].wanted) << a[n].term;
      EXPECT_EQ(std::isnan(a[n].ratio), std::isnan(b[n].ratio)) << a[n].term;
      EXPECT_TRUE(a[n].ratio == b[n].ratio || std::isnan(a[n].ratio)) << a[n].term;
    }
  }
}

TEST(RequiredModels, CountTheFirstLevelWhereItIsAboveOnset) {
  auto scene = laminar_bed();
  scene.drive.levels = {1, 2};
  EXPECT_NEAR(numbers_of(scene).shields, 1, 1e-12);
  EXPECT_TRUE(choice(scene, "shear_lift").wanted);   // Re_g = 1.96, 1.10 theta Re_g = 2.2
  EXPECT_NEAR(choice(scene, "shear_lift").ratio, 1.10 * 1 * 1.962, 1e-9);
}

TEST(RequiredModels, AreWantedWhateverTheTermsAre) {
  auto none = laminar_bed();
  for (const auto& named : named_terms) none.terms.*named.term = false;
  EXPECT_EQ(wanted_terms(none), wanted_terms(laminar_bed()));
}

TEST(RequiredModels, ReportATermThatIsLeftOutButDoNotAddIt) {
  auto scene = laminar_bed();
  scene.terms.pressure_gradient = scene.terms.viscous_stress = false;
  const auto left_out = choice(scene, "pressure_gradient");
  EXPECT_TRUE(left_out.wanted);
  EXPECT_FALSE(left_out.on);
  EXPECT_EQ(warnings_of(scene).size(), 1u);
  EXPECT_TRUE(warns(scene, "pressure_gradient (0.5), viscous_stress (0.5)"));
}

TEST(RequiredModels, SayThatGrainsWithoutTermsAreDry) {
  auto scene = laminar_bed();
  for (const auto& named : named_terms) scene.terms.*named.term = false;
  EXPECT_TRUE(warns(scene, "the grains are dry"));
  EXPECT_FALSE(warns(scene, "leaves out"));
}

// Air pushes sand with 1/(s - 1) = 5e-4 of its weight, and adds as little to its inertia.
TEST(RequiredModels, WantNeitherModelANorAddedMassInAir) {
  auto scene = laminar_bed();
  scene.bed.fluid = {1.2, 1.5e-5};
  EXPECT_FALSE(choice(scene, "pressure_gradient").wanted);
  EXPECT_FALSE(choice(scene, "viscous_stress").wanted);
  EXPECT_FALSE(choice(scene, "added_mass").wanted);
}

// s = 3: weight over submerged weight is 3/2. What floats has none to compare with.
TEST(RequiredModels, SayWhatIsWrongWithoutBuoyancy) {
  auto scene = laminar_bed();
  EXPECT_NE(choice(scene, "buoyancy").reason.find("grains weigh 1.5 times too much"), std::string::npos);
  scene.bed.grains.density = 1000;
  EXPECT_NE(choice(scene, "buoyancy").reason.find("grains sink where they should float"), std::string::npos);
  scene.bed.grains.density = 500;
  EXPECT_NE(choice(scene, "buoyancy").reason.find("grains sink where they should rise"), std::string::npos);
}

// C_A/(s + C_A) with C_A = 1/2: 16 % of the inertia of quartz, 33 % of a grain that barely sinks.
TEST(RequiredModels, GiveTheShareOfTheAddedMass) {
  auto scene = erosion_in_water();
  scene.bed.grains.density = 2650;
  EXPECT_NEAR(choice(scene, "added_mass").ratio, 0.16, 0.005);
  scene.bed.grains.density = 1010;
  EXPECT_NEAR(choice(scene, "added_mass").ratio, 0.33, 0.005);
}

// Exposed grain in laminar shear: torque per weight and radius 6 theta.
TEST(RequiredModels, WantTheViscousTorqueInEveryLaminarOnset) {
  EXPECT_NEAR(choice(laminar_bed(), "viscous_torque").ratio, 1.2, 1e-12);
  EXPECT_TRUE(choice(laminar_bed(), "viscous_torque").wanted);
}

TEST(RequiredModels, WantOneModelOfTheFilmNeverBoth) {
  auto scene = laminar_bed();
  EXPECT_TRUE(choice(scene, "wet_restitution").wanted);
  EXPECT_FALSE(choice(scene, "lubrication").wanted);
  scene.terms.wet_restitution = false;   // neither is on: nothing stands for the other
  EXPECT_EQ(choice(scene, "lubrication").reason.find("stands for it"), std::string::npos);
  EXPECT_NE(choice(scene, "lubrication").reason.find("wet_restitution would do"), std::string::npos);
  EXPECT_TRUE(choice(scene, "wet_restitution").wanted);
  scene.terms.lubrication = true;
  EXPECT_NE(choice(scene, "wet_restitution").reason.find("lubrication stands for it"), std::string::npos);
  EXPECT_FALSE(choice(scene, "wet_restitution").wanted);
  EXPECT_TRUE(choice(scene, "lubrication").wanted);
  EXPECT_FALSE(warns(scene, "leaves out"));
}

TEST(RequiredModels, WantNoWallForcesWithoutAWallOrAmongManyGrains) {
  auto periodic = settling_sphere();
  periodic.bed.sides = periodic.grid.sides = {Side::periodic, Side::periodic, Side::periodic};
  EXPECT_FALSE(choice(periodic, "wall_forces").wanted);
  EXPECT_FALSE(choice(laminar_bed(), "wall_forces").wanted);
  EXPECT_FALSE(choice(settling_sphere(), "exposure").wanted || choice(laminar_bed(), "exposure").wanted);
}

TEST(RequiredModels, SayNothingOfShearWhereNothingDrivesTheFluid) {
  auto scene = erosion_in_water();
  scene.drive = {.levels = {0}, .dwell = 1};
  EXPECT_TRUE(std::isnan(numbers_of(scene).shields));
  EXPECT_EQ(choice(scene, "viscous_torque").ratio, 0);
  EXPECT_FALSE(choice(scene, "turbulence").wanted);
}

// The seed of self-disturbance is d/h; a fast grain leaves its own flow behind.
TEST(RequiredModels, WantNoSelfDisturbanceOfFastGrainsOrInLargeCells) {
  auto scene = settling_sphere();
  EXPECT_TRUE(choice(scene, "self_disturbance").wanted);
  const double slow = choice(scene, "self_disturbance").ratio;
  scene.bed.fluid.viscosity = 1e-7;
  EXPECT_LT(choice(scene, "self_disturbance").ratio, 0.5 * slow);
  scene = settling_sphere();
  scene.grid = {.cells = {3, 3, 3}, .h = {1e-2, 1e-2, 1e-2}, .sides = scene.bed.sides};
  EXPECT_LT(choice(scene, "self_disturbance").ratio, 0.01);
  EXPECT_FALSE(choice(scene, "self_disturbance").wanted);
}

TEST(RequiredModels, OfOnePouredGrainAreThoseOfALoneOne) {
  auto scene = laminar_bed();
  scene.bed.source.count = 1;
  EXPECT_FALSE(census_of(scene).bed);
  EXPECT_TRUE(choice(scene, "wall_forces").wanted);
  EXPECT_NEAR(numbers_of(scene).shields, 0.03, 1e-12);   // no bed to move: the first level counts
}

// Without gravity only the speed that the table gives brings them to the wall: St = (3 + 1/2) 1e-4 0.1/(9 1e-6) = 3.9.
TEST(RequiredModels, ReadTheSpeedsOfATable) {
  auto scene = settling_sphere();
  scene.bed.gravity = {};
  EXPECT_FALSE(choice(scene, "wet_restitution").wanted);
  scene.bed.source.csv =
      "x,y,z,diameter,density,fixed,vx,vy,vz,wx,wy,wz\n0.5e-3,0.5e-3,4e-3,1e-4,3000,0,0,0,-0.1,0,0,0\n";
  EXPECT_TRUE(choice(scene, "wet_restitution").wanted);
  EXPECT_NEAR(numbers_of(scene).impact_stokes, 3.5 * 1e-4 * 0.1 / 9e-6, 1e-9);
}

/// The settling sphere, thrown along x at 0.1 m/s (Re 10) with a spin about z [rad/s].
Scene thrown_sphere(const std::string& spin) {
  auto scene = settling_sphere();
  scene.bed.source.csv =
      "x,y,z,diameter,density,fixed,vx,vy,vz,wx,wy,wz\n0.5e-3,0.5e-3,4e-3,1e-4,3000,0,0.1,0,0,0,0," + spin + "\n";
  return scene;
}

// omega d/(2 w) = 1; 3/4 omega w/((s - 1) g) = 7.65 of the weight by Rubinow & Keller, 0.757 of that at Re 10, Re_r 20.
// Torque 12 nu omega/((s - 1) g d) = 12.2 of the weight times radius.
TEST(RequiredModels, WantForceAndTorqueOfTheSpinThatATableGives) {
  const auto scene = thrown_sphere("2000");
  EXPECT_EQ(census_of(scene).fastest_spin, 2000);
  EXPECT_TRUE(choice(scene, "magnus").wanted);
  EXPECT_NEAR(choice(scene, "magnus").ratio, 0.757 * 7.645, 0.01);
  EXPECT_TRUE(choice(scene, "viscous_torque").wanted);
  EXPECT_NEAR(choice(scene, "viscous_torque").ratio, 12.23, 0.01);
  EXPECT_EQ(choice(scene, "magnus").reason.find("no shear"), std::string::npos);
  EXPECT_TRUE(wanted_terms(scene).magnus && wanted_terms(scene).viscous_torque);
}

// omega d/(2 w) = 0.05 bends no path, though the force would be a third of the weight; without spin there is none.
TEST(RequiredModels, WantNoMagnusForceOfASpinThatIsSlowAgainstTheSlip) {
  const auto slow = choice(thrown_sphere("100"), "magnus");
  EXPECT_FALSE(slow.wanted);
  EXPECT_GT(slow.ratio, 0.05);
  EXPECT_NE(slow.reason.find("omega d/(2 w) = 0.05 (<= 0.1)"), std::string::npos);
  EXPECT_EQ(choice(thrown_sphere("0"), "magnus").ratio, 0);
  EXPECT_EQ(choice(thrown_sphere("0"), "viscous_torque").ratio, 0);
}

// Without gravity and speed: no slip, no force, and a torque that no weight resists.
TEST(RequiredModels, WantTheTorqueOfASphereThatOnlySpins) {
  auto scene = thrown_sphere("2000");
  scene.bed.gravity = {};
  scene.bed.source.csv =
      "x,y,z,diameter,density,fixed,vx,vy,vz,wx,wy,wz\n0.5e-3,0.5e-3,4e-3,1e-4,3000,0,0,0,0,0,0,2000\n";
  EXPECT_FALSE(choice(scene, "magnus").wanted);
  EXPECT_EQ(choice(scene, "magnus").ratio, 0);
  EXPECT_TRUE(choice(scene, "viscous_torque").wanted);
}

// theta = 0.2 in water: slip 1.96 m/s, spin 1962 rad/s, Re 1962: 3/4 omega w/((s - 1) g) = 147, of which 0.45 are left.
// In the viscous liquid Re is 0.2: nothing bends at that.
TEST(RequiredModels, WantTheMagnusForceOfSurfaceGrainsUnlessTheyAreSlow) {
  EXPECT_TRUE(choice(erosion_in_water(), "magnus").wanted);
  EXPECT_NEAR(choice(erosion_in_water(), "magnus").ratio, 0.45 * 147.2, 0.1);
  EXPECT_FALSE(choice(laminar_bed(), "magnus").wanted);
  auto smooth = erosion_in_water();
  smooth.bed.grains.friction = 0;   // nothing makes them turn against the fluid
  EXPECT_FALSE(choice(smooth, "magnus").wanted);
}

// Four others at a distance of one diameter and a half: each lies wholly within two diameters, 1/63 of the space left.
TEST(GrainCensus, MeasuresThePackingOfTheOtherGrains) {
  const auto lone = census_of(settling_sphere());
  EXPECT_EQ(lone.densest, 0);
  EXPECT_EQ(lone.nearness, 1);   // it falls to the floor
  EXPECT_FALSE(lone.bed);
  const auto cross = census_of(spheres_in_a_column({"0.5e-3,0.5e-3,3e-3", "0.65e-3,0.5e-3,3e-3", "0.35e-3,0.5e-3,3e-3",
                                                    "0.5e-3,0.65e-3,3e-3", "0.5e-3,0.35e-3,3e-3"}));
  EXPECT_NEAR(cross.densest, 4.0 / 63, 1e-12);
}

TEST(GrainCensus, SeesNeighboursRoundThePeriod) {
  auto scene = spheres_in_a_column({"0.06e-3,0.5e-3,3e-3", "0.94e-3,0.5e-3,3e-3"});
  EXPECT_EQ(census_of(scene).densest, 0);
  scene.bed.sides[0] = scene.grid.sides[0] = Side::periodic;
  EXPECT_NEAR(census_of(scene).densest, 1.0 / 63, 1e-12);
}

struct Strange {
  const char* what;
  void (*change)(Scene&);
  const char* parameter;
  const char* message;
  friend void PrintTo(const Strange& s, std::ostream* out) { *out << s.what; }
};
class OutOfRange : public testing::TestWithParam<Strange> {};
TEST_P(OutOfRange, IsSaid) {
  auto scene = laminar_bed();
  ASSERT_TRUE(range_problems_of(scene).empty());
  GetParam().change(scene);
  const auto problems = range_problems_of(scene);
  const auto found = std::ranges::find_if(problems, [&](const SceneProblem& p) {
    return p.parameter == GetParam().parameter && p.message.find(GetParam().message) != p.message.npos;
  });
  EXPECT_NE(found, problems.end());
  EXPECT_TRUE(found == problems.end() || !found->hint.empty());
}
INSTANTIATE_TEST_SUITE_P(
    SceneRange, OutOfRange,
    testing::Values(
        Strange{"turbulent", [](Scene& s) { s.bed.fluid.viscosity = 1e-6; }, "fluid.viscosity", "not physical"},
        Strange{"turbulent above a smooth bed", become_fine_sand, "fluid.viscosity",
                "the sublayer covers the grains, but the flow above is turbulent"},
        Strange{"lift on a bed", [](Scene& s) { s.terms.shear_lift = true; }, "models.terms",
                "d|omega|/(2|w|) = 1; the law of Saffman and Mei for shear_lift is made for 0.4 and less"},
        Strange{"lift on fast grains", [](Scene& s) { s.terms.shear_lift = true, s.bed.fluid.viscosity = 1e-6; },
                "models.terms", "the law of Saffman and Mei for shear_lift is known up to 100"},
        Strange{"spin of fast grains", [](Scene& s) { s.terms.magnus = true, s.bed.fluid.viscosity = 1e-6; },
                "models.terms", "the law of Oesterle and Bui Dinh for magnus is known up to 140"},
        Strange{"law for slow grains", [](Scene& s) { s.drag = DragLawName::stokes; }, "models.drag", "up to 0.1"},
        Strange{"law for lone grains", [](Scene& s) { s.drag = DragLawName::schiller_naumann; }, "models.drag",
                "0.42; the drag law schiller_naumann is made for 0.995"},
        Strange{"law for beds", [](Scene& s) { s.drag = DragLawName::ergun; }, "models.drag", "made for 0.65 and less"},
        Strange{"silt", [](Scene& s) { s.bed.grains.diameter = 5e-5; }, "grains.diameter", "cohesion"},
        Strange{"colloid", [](Scene& s) { s.bed.grains.diameter = 1e-6; }, "grains.diameter", "Brownian"},
        Strange{"coarse cells", [](Scene& s) { s.grid.h.z = 2.5e-3; }, "box.cell.z", "cells 2.5 d high"},
        Strange{"few cells in the gap", [](Scene& s) { s.grid.h.z = 3.3e-3; }, "box.cell.z",
                "cells high; its flow wants 4"},
        Strange{"avalanche",
                [](Scene& s) {
                  s.bed.gravity = {2.8, 0, -9.4};   // 16.6 degrees
                },
                "box.slope", "angle of repose"},
        Strange{"thin bed", [](Scene& s) { s.bed.source.count = 6000; }, "bed.count", "feels the flat bottom"},
        Strange{"short holds", [](Scene& s) { s.drive.dwell = 1e-3; }, "drive.dwell", "shorter than"},
        Strange{"short holds from rest", [](Scene& s) { s.developed = false, s.drive.dwell = 0.05; }, "drive.dwell",
                "over the gap"},
        Strange{"soft grains", [](Scene& s) { s.bed.grains.young_modulus = 1e4; }, "grains.stiffness", "overlap"},
        Strange{"no drag", [](Scene& s) { s.terms.drag = false; }, "drive.kind", "moves no grain"}));

/// What is said of models.terms; empty if nothing.
std::string said_of_terms(const Scene& scene) {
  std::string said;
  for (const auto& p : range_problems_of(scene))
    if (p.parameter == "models.terms") said += p.message + "\n";
  return said;
}

// Saffman and Mei: Re up to 100; the law of a wall, where there is one for a lone grain: up to 200.
TEST(SceneRange, GoesByTheLawThatLiftsTheGrain) {
  auto scene = settling_sphere();
  scene.terms.shear_lift = true;
  const auto throw_at = [&](const std::string& speed) {   // d = 0.1 mm in water: Re = 100 per m/s
    scene.bed.source.csv = "x,y,z,diameter,density,fixed,vx,vy,vz\n0.5e-3,0.5e-3,4e-3,1e-4,3000,0," + speed + ",0,0\n";
  };
  throw_at("1.5");
  ASSERT_TRUE(scene.terms.wall_forces);
  EXPECT_EQ(said_of_terms(scene), "");
  scene.terms.wall_forces = false;
  EXPECT_NE(said_of_terms(scene).find("Re = 150; the law of Saffman and Mei"), std::string::npos);
  throw_at("0.9");
  EXPECT_EQ(said_of_terms(scene), "");
  scene.terms.wall_forces = true;
  throw_at("2.5");
  EXPECT_NE(said_of_terms(scene).find("Re = 250; the law of Zeng et al. for shear_lift at a wall is known up to 200"),
            std::string::npos);
}

// A surface grain at rest: b = 1 in viscous flow; where the log law reaches it, 0.34.
TEST(SceneRange, KnowsTheShearOfTurbulentFlowAtASurfaceGrain) {
  auto scene = erosion_in_water();
  scene.terms.shear_lift = scene.terms.turbulence = true;
  EXPECT_EQ(said_of_terms(scene).find("omega"), std::string::npos);
  scene.terms.turbulence = false;
  EXPECT_NE(said_of_terms(scene).find("omega"), std::string::npos);
}

// 3 pi 0.073 d/h in cells narrower than grains: 0.86 of the drag of a slow grain comes back, 0.69 in cubes of 1 d.
TEST(SceneRange, TellsWhenCellsAreTooSmallForLoneGrains) {
  auto scene = settling_sphere();
  scene.bed.fluid.viscosity = 1e-4, scene.drag = DragLawName::stokes;
  scene.grid = {.cells = {10, 10, 50}, .h = {1e-4, 1e-4, 1e-4}, .sides = scene.bed.sides};
  EXPECT_NEAR(numbers_of(scene).self_response, 0.69, 0.01);
  EXPECT_TRUE(range_problems_of(scene).empty());
  scene.grid.h = {0.8e-4, 0.8e-4, 1.6e-4};
  ASSERT_EQ(range_problems_of(scene).size(), 1u);
  EXPECT_EQ(range_problems_of(scene)[0].parameter, "box.cell.xy");
  EXPECT_NE(range_problems_of(scene)[0].message.find("kappa = 0.86"), std::string::npos);
  scene.terms.self_disturbance = false;   // nothing is corrected, so nothing is trusted
  EXPECT_TRUE(range_problems_of(scene).empty());
}

}   // namespace
}   // namespace bedload

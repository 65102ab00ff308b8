// Axes to cases: which there are, what they are called, what keeps their identity.
#include "studies/study.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "base/units.hpp"
#include "solver/dimensionless.hpp"
#include "studies/case_entry.hpp"
#include "studies/case_identity.hpp"
#include "tests/studies/study_fixture.hpp"

namespace bedload {
namespace {

std::vector<Case> cases_of(const std::string& text) { return unfold(parse_study(text, "study.toml")); }

std::set<std::string> ids_of(const std::string& text) {
  std::set<std::string> ids;
  for (const auto& one : cases_of(text)) ids.insert(one.id);
  return ids;
}

TEST(Study, UnfoldsTheProductOfItsAxes) {
  const auto cases = cases_of(good_study);
  ASSERT_EQ(cases.size(), 8u);
  EXPECT_EQ(ids_of(good_study).size(), 8u);
  EXPECT_EQ(cases[0].label, "d0.5mm-rho2000-s1");
  EXPECT_EQ(cases[0].set_label, "d0.5mm-rho2000");
  EXPECT_EQ(cases[1].label, "d0.5mm-rho2000-s2");
  EXPECT_EQ(cases[7].label, "d0.6mm-rho3000-s2");
  EXPECT_EQ(cases[0].set, cases[1].set);
  EXPECT_NE(cases[0].set, cases[2].set);
}

TEST(Study, NamesACaseWithoutAxesAfterItself) {
  const auto one = with(with(with(good_study, "[\"0.5 mm\", \"0.6 mm\"]", "\"0.5 mm\""),
                             "[\"2000 kg/m3\", \"3000 kg/m3\"]", "\"2000 kg/m3\""),
                        "seed = { count = 2 }", "");
  const auto seeded = cases_of(one).at(0);
  EXPECT_EQ(seeded.label, "screening-s1");
  EXPECT_EQ(seeded.set_label, "screening");
  EXPECT_EQ(identity_of({seeded.label, seeded.inputs, seeded.scene, {}}).set_label, "screening");
  const auto empty = with(with(one, "name = \"screening\"", "name = \"water-s1\""), "count = 300", "source = \"none\"");
  const auto bare = cases_of(empty).at(0);
  EXPECT_EQ(bare.label, "water-s1");
  EXPECT_EQ(identity_of({bare.label, bare.inputs, bare.scene, {}}).set_label, "water-s1");
}

TEST(Study, LeavesOutWhatIsExcluded) {
  const auto cases =
      cases_of(good_study + "\n[[exclude]]\ngrains.diameter = \"600 um\"\ngrains.density = \"3000 kg/m3\"\n");
  EXPECT_EQ(cases.size(), 6u);
  for (const auto& one : cases) EXPECT_NE(one.set_label, "d0.6mm-rho3000");
}

TEST(Study, RefusesAnExclusionThatNamesNoAxis) {
  EXPECT_NE(complaint(good_study + "\n[[exclude]]\ngrains.spread = 0.05\n").find("grains.spread does not vary"),
            std::string::npos);
}

TEST(Study, MeasuresInGrainsOfEachCase) {
  const auto cases = cases_of(good_study);
  EXPECT_DOUBLE_EQ(cases[0].scene.bed.length.x, 5e-3);
  EXPECT_DOUBLE_EQ(cases[7].scene.bed.length.x, 6e-3);
  EXPECT_EQ(cases[0].scene.grid.cells, (std::array{5, 3, 26}));
}

/// The study at Ga^2 = 5 with d or nu left to the program; `given` says the other.
std::string by_galileo(const std::string& fluid, const std::string& grains) {
  return with(with(with(good_study, "viscosity = \"1.0e-5 m2/s\"", "galileo = 2.2360679775\n" + fluid),
                   "diameter = [\"0.5 mm\", \"0.6 mm\"]", grains),
              "density = [\"2000 kg/m3\", \"3000 kg/m3\"]", "density_ratio = [1.5, 3]");
}

// d = (Ga nu)^(2/3)/((s-1) g)^(1/3): 0.467 mm at s = 1.5, 0.294 mm at s = 3.
TEST(Study, PicksTheDiameterOfAGalileoNumber) {
  const auto cases = cases_of(by_galileo("viscosity = \"1.0e-5 m2/s\"", ""));
  ASSERT_EQ(cases.size(), 4u);
  EXPECT_EQ(cases[0].label, "sg1.5-s1");
  EXPECT_NEAR(cases[0].scene.bed.grains.diameter, std::cbrt(5 * 1e-10 / (0.5 * 9.81)), 1e-9);
  EXPECT_NEAR(cases[2].scene.bed.grains.diameter, std::cbrt(5 * 1e-10 / (2 * 9.81)), 1e-9);
  EXPECT_NEAR(cases[0].scene.bed.grains.diameter, 0.467e-3, 0.0005e-3);
  EXPECT_NEAR(cases[2].scene.bed.grains.diameter, 0.294e-3, 0.0005e-3);
  EXPECT_EQ(cases[0].scene.bed.grains.density, 1500);
  EXPECT_EQ(cases[2].scene.bed.grains.density, 3000);
  EXPECT_DOUBLE_EQ(cases[0].scene.bed.length.x, 10 * cases[0].scene.bed.grains.diameter);
  for (const auto& one : cases) {
    const auto& bed = one.scene.bed;
    EXPECT_NEAR(galileo_number(bed.grains.density / 1000, 9.81, bed.grains.diameter, bed.fluid.viscosity),
                std::sqrt(5.0), 1e-4);
  }
}

TEST(Study, PicksTheViscosityOfAGalileoNumber) {
  const auto cases = cases_of(by_galileo("", "diameter = \"0.5 mm\""));
  ASSERT_EQ(cases.size(), 4u);
  EXPECT_NEAR(cases[0].scene.bed.fluid.viscosity, std::sqrt(0.5 * 9.81 * 1.25e-10 / 5), 1e-10);
  EXPECT_NEAR(cases[2].scene.bed.fluid.viscosity, std::sqrt(2 * 9.81 * 1.25e-10 / 5), 1e-10);
}

TEST(Study, TakesGalileoNumbersAsAnAxis) {
  const auto text = with(by_galileo("", "diameter = \"0.5 mm\""), "galileo = 2.2360679775", "galileo = [2, 4]");
  const auto cases = cases_of(text);
  ASSERT_EQ(cases.size(), 8u);
  EXPECT_EQ(cases[0].label, "Ga2-sg1.5-s1");
  EXPECT_NEAR(cases[0].scene.bed.fluid.viscosity / cases[4].scene.bed.fluid.viscosity, 2, 1e-5);
}

TEST(Study, OfGroupsIsTheStudyOfWhatTheyPick) {
  const auto groups = with(by_galileo("viscosity = \"1.0e-5 m2/s\"", ""), "[1.5, 3]", "1.5");
  const double d = cases_of(groups)[0].scene.bed.grains.diameter;
  const auto written = with(with(good_study, "[\"0.5 mm\", \"0.6 mm\"]", "\"" + shortest(d) + " m\""),
                            "[\"2000 kg/m3\", \"3000 kg/m3\"]", "\"1500 kg/m3\"");
  EXPECT_EQ(ids_of(groups), ids_of(written));
  for (const auto& one : cases_of(groups)) {
    EXPECT_FALSE(one.inputs.has("fluid.galileo"));
    EXPECT_FALSE(one.inputs.has("grains.density_ratio"));
  }
}

TEST(Study, FindsTwinsAmongGroups) {
  const auto text = by_galileo("", "diameter = \"0.5 mm\"");
  EXPECT_TRUE(says(complaint(with(text, "2.2360679775", "[2.2360679775, 2.23606797749]")), "are the same case"));
}

TEST(Study, RefusesGroupsThatSayTooMuchOrTooLittle) {
  EXPECT_TRUE(says(complaint(by_galileo("viscosity = \"1.0e-5 m2/s\"", "diameter = \"0.5 mm\"")),
                   "fluid.galileo: grains.diameter and fluid.viscosity are given too, and say it already\n"
                   "hint: leave out one of fluid.galileo, grains.diameter and fluid.viscosity"));
  EXPECT_TRUE(
      says(complaint(by_galileo("", "")), "fluid.galileo: neither grains.diameter nor fluid.viscosity is given"));
  EXPECT_TRUE(says(complaint(with(good_study, "spread = 0.05", "density_ratio = 2")),
                   "grains.density_ratio: grains.density is given too, and with fluid.density says it already\n"
                   "hint: leave out grains.density or grains.density_ratio"));
  const auto weightless = with(by_galileo("", "diameter = \"0.5 mm\""), "[1.5, 3]", "1");
  EXPECT_TRUE(says(complaint(weightless), "fluid.galileo: grains without submerged weight"));
  const auto light = with(by_galileo("", "diameter = \"0.5 mm\""), "[1.5, 3]", "0.9");
  EXPECT_TRUE(says(complaint(light), "grains.density_ratio: grains of 900 kg/m3 do not settle"));
}

TEST(Study, ShearsItsBedsAndKeepsIdsWithoutShear) {
  const auto with_shear = [](const std::string& shear) {
    return with(good_study, "count = 300", "count = 300\n" + shear);
  };
  const auto cases = cases_of(with_shear("shear = { shields = 0.05, time = \"50 td\" }"));
  EXPECT_EQ(cases[0].scene.shear.shields, 0.05);
  EXPECT_DOUBLE_EQ(cases[0].scene.shear.time, 2 * cases[0].scene.drive.dwell);   // of 25 td
  EXPECT_EQ(cases[0].bed_id, cases_of(good_study)[0].bed_id);                    // poured once for all
  EXPECT_NE(cases[0].id, cases_of(good_study)[0].id);
  EXPECT_NE(cases[0].id, cases_of(with_shear("shear = { shields = 0.05 }"))[0].id);   // for 100 td
  EXPECT_EQ(ids_of(with_shear("shear.shields = 0")), ids_of(good_study));

  const auto axis = cases_of(with_shear("shear = { shields = [0, 0.05], time = \"50 td\" }"));
  ASSERT_EQ(axis.size(), 16u);
  EXPECT_EQ(axis[0].label, "d0.5mm-rho2000-shear0-s1");
  EXPECT_EQ(axis[0].id, cases_of(good_study)[0].id);
  EXPECT_EQ(axis[2].label, "d0.5mm-rho2000-shear0.05-s1");
  EXPECT_EQ(axis[2].id, cases[0].id);
}

TEST(Study, RefusesAShearThatNothingCanDo) {
  const auto with_shear = [](const std::string& text, const std::string& shear) {
    return with(text, "count = 300", "count = 300\n" + shear);
  };
  EXPECT_TRUE(says(complaint(with_shear(good_study, "shear.time = \"50 td\"")),
                   "bed.shear.time: bed.shear.shields is missing, and 0 is no shear\nhint: leave it out"));
  const auto by_speed = with(good_study, "shields = { from = 0.06, ratio = 1.2, steps = 12 }", "speed = \"1 mm/s\"");
  EXPECT_TRUE(says(complaint(with_shear(by_speed, "shear.shields = 0.05")),
                   "bed.shear.shields: a bed is sheared by the drive of the study"));
  const auto suspension = with(good_study, "count = 300", "source = \"suspension\"\ncount = 300");
  EXPECT_TRUE(says(complaint(with_shear(suspension, "shear.shields = 0.05")),
                   "bed.shear.shields: only a bed that settles can be sheared"));
}

TEST(Study, SmoothsByWidthsInGrainsAndKeepsIdsWithoutAny) {
  const auto with_widths = [](const char* widths) {
    return with(good_study, "[drive]", std::string("[models]\nsmoothing = ") + widths + "\n[drive]");
  };
  EXPECT_EQ(ids_of(good_study), ids_of(with_widths("{ xy = \"0 d\", z = \"0 m\" }")));
  const auto cases = cases_of(with_widths("{ xy = \"1.5 d\", z = \"0.5 d\" }"));
  EXPECT_DOUBLE_EQ(cases[0].scene.smoothing.xy, 0.75e-3);
  EXPECT_DOUBLE_EQ(cases[7].scene.smoothing.z, 0.3e-3);
  EXPECT_NE(ids_of(good_study), ids_of(with_widths("{ z = \"0.5 d\" }")));
  EXPECT_NE(complaint(with_widths("{ xy = \"2 d\" }")).find("models.smoothing.xy: a standard deviation of"),
            std::string::npos);
  EXPECT_NE(
      complaint(with(with_widths("{ z = \"0.5 d\" }"), "[models]", "[models]\nterms = [\"drag\", \"wall_forces\"]"))
          .find("wall_forces takes from a lone grain"),
      std::string::npos);
}

TEST(Study, KeepsIdsWhenOnlyTheOnsetCriterionChanges) {
  EXPECT_EQ(ids_of(good_study),
            ids_of(with(good_study, "[drive]", "[onset]\ncriterion = \"moving_fraction\"\nvalue = 0.02\n[drive]")));
}

TEST(Study, OfABisectionCountsItsCriterionAndItsStairsAmongWhatItIs) {
  const auto searched = with(good_study, "[drive]", "[onset]\nmethod = \"bisect\"\n[drive]");
  const auto id = cases_of(searched).at(0).id;
  EXPECT_NE(id, cases_of(good_study).at(0).id);
  for (const auto& [key, other] : {std::pair{"[onset]", "[onset]\nvalue = 2e-2"},
                                   {"[onset]", "[onset]\nbracket = 0.1"},
                                   {"[onset]", "[onset]\nhold = \"50 td\""},
                                   {"steps = 12", "steps = 13"}})
    EXPECT_NE(cases_of(with(searched, key, other)).at(0).id, id) << other;
}

TEST(Study, KeepsIdsWhenTheRampGrowsLonger) {
  EXPECT_EQ(ids_of(good_study), ids_of(with(good_study, "steps = 12", "steps = 20")));
}

/// The study with the terms of its first case written out.
std::string written_out(const std::string& text) {
  const auto cases = cases_of(text);
  const auto& names = std::get<std::vector<std::string>>(cases[0].inputs.values.at("models.terms"));
  std::string list;
  for (const auto& name : names) list += (list.empty() ? "\"" : ", \"") + name + "\"";
  return with(text, "[drive]", "[models]\nterms = [" + list + "]\n[drive]");
}

TEST(Study, CountsAutomaticTermsAsTheListTheyStandFor) {
  const auto one = with(with(good_study, "[\"0.5 mm\", \"0.6 mm\"]", "\"0.5 mm\""), "[\"2000 kg/m3\", \"3000 kg/m3\"]",
                        "\"2000 kg/m3\"");
  EXPECT_TRUE(cases_of(one)[0].scene.terms.viscous_torque);
  EXPECT_EQ(ids_of(one), ids_of(written_out(one)));
}

// Terms are chosen at the onset to be expected, not at the end of the ramp: the last level here is 2 m/s.
TEST(Study, ChoosesTermsWhateverTheEndOfARamp) {
  const auto by_speed = [](const std::string& levels) {
    return ids_of(with(good_study, "shields = { from = 0.06, ratio = 1.2, steps = 12 }", "speed = " + levels));
  };
  EXPECT_EQ(by_speed("{ from = \"1 mm/s\", ratio = 2, steps = 1 }"),
            by_speed("{ from = \"1 mm/s\", ratio = 2, steps = 12 }"));
  const auto fast = with(good_study, "shields = { from = 0.06, ratio = 1.2, steps = 12 }", "speed = \"2 m/s\"");
  EXPECT_TRUE(cases_of(fast)[0].scene.terms.magnus);
}

TEST(Study, LeavesStrictnessOutOfTheIdentity) {
  EXPECT_EQ(ids_of(good_study), ids_of(with(good_study, "[drive]", "[models]\nstrict = false\n[drive]")));
}

TEST(Study, SharesABedWhateverTheTerms) {
  const auto dry = cases_of(with(good_study, "[drive]", "[models]\nterms = []\n[drive]"));
  EXPECT_EQ(cases_of(good_study)[0].bed_id, dry[0].bed_id);
}

TEST(Study, KeepsIdsWhenOnlyTheWayOfRunningOrTheUnitsChange) {
  EXPECT_EQ(ids_of(good_study), ids_of(with(good_study, "[drive]", "[run]\ncores = 2\n[drive]")));
  EXPECT_EQ(ids_of(good_study), ids_of(with(good_study, "name = \"screening\"", "name = \"other\"")));
  EXPECT_EQ(ids_of(good_study), ids_of(with(good_study, "\"0.5 mm\"", "\"500 um\"")));
}

TEST(Study, RenamesCasesWhosePhysicsChanges) {
  const auto ids = ids_of(good_study);
  for (const auto& changed :
       {with(good_study, "spread = 0.05", "spread = 0.06"), with(good_study, "from = 0.06", "from = 0.07"),
        with(good_study, "ratio = 1.2", "ratio = 1.3"), with(good_study, "\"25 td\"", "\"30 td\""),
        with(good_study, "[drive]", "[models]\nterms = [\"drag\", \"buoyancy\"]\n[drive]")}) {
    for (const auto& id : ids_of(changed)) EXPECT_FALSE(ids.contains(id));
  }
}

TEST(Study, SharesABedAmongCasesThatDifferOnlyInTheirFlow) {
  const auto slow = cases_of(good_study), fast = cases_of(with(good_study, "from = 0.06", "from = 0.07"));
  for (std::size_t n = 0; n < slow.size(); ++n) EXPECT_EQ(slow[n].bed_id, fast[n].bed_id);
  EXPECT_NE(slow[0].bed_id, slow[1].bed_id);
}

TEST(Study, PoursToADepth) {
  const auto cases = cases_of(with(good_study, "count = 300", "depth = \"4 d\""));
  // 4 d x 60 d2 x 0.58 / (pi/6 d3 (1 + 3 0.05^2)) = 263.9
  EXPECT_EQ(cases[0].scene.bed.source.count, 264u);
}

TEST(Study, ChoosesADemStepOfAFifthOfTheSmallestGrainsRayleighTime) {
  const auto cases = cases_of(good_study);
  const auto& bed = cases[0].scene.bed;
  const double d = bed.grains.diameter * 0.9, shear_modulus = bed.grains.young_modulus / (2 * 1.3);
  const double rayleigh =
      3.14159265358979 * d / 2 * std::sqrt(bed.grains.density / shear_modulus) / (0.1631 * 0.3 + 0.8766);
  EXPECT_NEAR(bed.dem_step / rayleigh, 0.2, 2e-4);
  EXPECT_DOUBLE_EQ(cases[0].scene.steps.fluid_interval, 10 * bed.dem_step);
}

}   // namespace
}   // namespace bedload

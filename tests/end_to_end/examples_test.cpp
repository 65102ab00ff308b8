// The example studies: what `plan` says of them.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "tests/end_to_end/bedload_program.hpp"
#include "tests/support/temporary_directory.hpp"

namespace bedload {
namespace {

Outcome plan_of(const std::string& name, const std::vector<std::string>& more = {}) {
  TemporaryDirectory here;
  std::vector<std::string> words{"plan", std::string(BEDLOAD_SOURCE_DIR) + "/studies/examples/" + name + ".toml",
                                 "--out", here.path() / "out"};
  words.insert(words.end(), more.begin(), more.end());
  return bedload(here.path(), words);
}

/// Lines joined: what is said may be broken anywhere between words.
std::string unwrapped(const std::string& text) { return std::regex_replace(text, std::regex("\\s+"), " "); }

TEST(Examples, QuickstartHasFourCasesThatAreLaminar) {
  const auto plan = plan_of("quickstart");
  EXPECT_EQ(plan.code, 0) << plan.err;
  EXPECT_NE(plan.out.find("4 cases (4 new"), std::string::npos) << plan.out;
  const auto said = unwrapped(plan.out);
  EXPECT_NE(said.find("Re* = 1.57 (<= 5), gap Reynolds number 131 (<= 1300) at theta = 0.2: laminar"), said.npos)
      << said;
  // One thing is said: the lift that such beds want has a law for grains far from walls.
  const auto warning = said.find("warning: ");
  EXPECT_NE(said.find("the law of Saffman and Mei for shear_lift is made for 0.4 and less", warning), said.npos)
      << said;
  EXPECT_EQ(said.find("warning: ", warning + 1), said.npos) << said;
}

// Studies of the threshold itself. Of each it is said that the lift's law is made for other grains; of the shallow beds also that
// they feel their bottom, and of a trade which terms it leaves out on purpose.
TEST(Examples, ThresholdsOfLaminarBedsSayWhereTheyAreOutOfRange) {
  struct Expected {
    std::string name, cases, picked;
    std::vector<std::string> warnings;
  };
  const std::string lift = "the law of Saffman and Mei for shear_lift", bottom = "feels the flat bottom",
                    left_out = "models.terms leaves out what the rules want";
  for (const auto& [name, cases, picked, warnings] :
       {Expected{"laminar-threshold", "28 cases (28 new", "d0.467mm-rho1500-area-s3 new 1200", {bottom, lift}},
        Expected{"laminar-few-terms", "16 cases (16 new", "d0.294mm-rho3000-s8 new 300", {bottom, left_out}},
        Expected{"sensitivity-laminar",
                 "36 cases (36 new",
                 "sensitivity-laminar-stiff-s3 new 300",
                 {bottom, lift, left_out, left_out}},
        Expected{"trade-laminar",
                 "42 cases (42 new",
                 "trade-laminar-dem0.45R-s2 new 300",
                 {bottom, lift, left_out, left_out, left_out}},
        Expected{"slope-threshold", "16 cases (16 new", "slope8deg 0.000370766 m 2000 kg/m3 1e-05 m2/s", {lift}}}) {
    const auto plan = plan_of(name);
    EXPECT_EQ(plan.code, 0) << plan.err;
    const auto said = unwrapped(plan.out);
    EXPECT_NE(said.find(cases), said.npos) << name;
    EXPECT_NE(said.find(picked), said.npos) << name;
    EXPECT_NE(said.find("= 0.2: laminar"), said.npos) << name;
    std::size_t at = 0;
    for (const auto& warning : warnings) {
      at = said.find("warning: ", at + 1);
      ASSERT_NE(at, said.npos) << name;
      EXPECT_LT(said.find(warning, at), said.find("warning: ", at + 1)) << name << ": " << warning;
    }
    EXPECT_EQ(said.find("warning: ", at + 1), said.npos) << name;
  }
}

// Everything that a column can carry is on, turbulence for every size.
TEST(Examples, SandInWaterIsATurbulentColumn) {
  for (const auto& [name, cases, warnings] :
       {std::tuple{"sand-in-water", "60 cases (60 new", 4}, {"trade-sand", "32 cases (32 new", 6}}) {
    const auto plan = plan_of(name);
    EXPECT_EQ(plan.code, 0) << plan.err;
    const auto said = unwrapped(plan.out);
    EXPECT_NE(said.find(cases), said.npos) << said;
    EXPECT_NE(said.find("fluid = column yes"), said.npos) << said;
    for (const auto* term : {"added_mass yes yes", "viscous_torque yes yes", "turbulence yes yes"})
      EXPECT_NE(said.find(term), said.npos) << name << ": " << term;
    int found = 0;
    for (std::size_t at = said.find("warning: "); at != said.npos; at = said.find("warning: ", at + 1)) ++found;
    EXPECT_EQ(found, warnings) << said;
  }
}

TEST(Examples, ABeadLiesOnALayerOfEachKind) {
  const auto plan = plan_of("bead-on-substrate");
  EXPECT_EQ(plan.code, 0) << plan.err;
  const auto said = unwrapped(plan.out);
  EXPECT_NE(said.find("4 cases (4 new"), said.npos);
  EXPECT_NE(said.find("filebead-on-triangles.csv-L6.92820323d-hz0.5d new 65"), said.npos);
  EXPECT_NE(said.find("filebead-on-squares.csv-L8d-hz1d new 65"), said.npos);
}

// tau_b = 0.2 x 2000 x 9.81 x 0.001 = 3.924 Pa; over 10 mm of water that is a lid at 39 m/s.
TEST(Examples, SeedErosionIsCalledUnphysicalInWater) {
  for (const auto* name : {"seed-erosion", "seed-erosion-fine", "trade-seed"}) {
    const auto plan = plan_of(name);
    EXPECT_EQ(plan.code, 0) << plan.err;
    for (const auto* part : {"this laminar scene is not physical", "theta = 0.2 means a lid speed of 39.1 m/s",
                             "gap Reynolds number of 3.9e+05"})
      EXPECT_NE(unwrapped(plan.out).find(part), std::string::npos) << part << "\n" << plan.out;
  }
}

// Verdicts of the scene's own list, each with the ratio that was worked out by hand: mass loading 0.58 x 3, 1/s, 1/(s - 1),
// 0.5/(s + 0.5), 6 theta.
TEST(Examples, SeedErosionGetsAVerdictOnEveryTerm) {
  const auto said = unwrapped(plan_of("seed-erosion").out);
  for (const auto* part :
       {"drag yes yes 1.74", "buoyancy yes yes 0.3333", "pressure_gradient no yes 0.5", "viscous_stress no yes 0.5",
        "self_disturbance no no 0.004", "added_mass no yes 0.1429", "shear_lift no yes", "magnus no yes",
        "viscous_torque no yes 1.2", "wall_forces no no", "wet_restitution no yes", "lubrication no no",
        "exposure no no", "turbulence no yes 300", "rolling_friction no no", "Galileo number Ga 140.1",
        "models.terms leaves out what the rules want"})
    EXPECT_NE(said.find(part), std::string::npos) << part << "\n" << said;
}

TEST(Examples, VerdictsFitAPageAndAProgram) {
  std::istringstream lines(plan_of("seed-erosion").out.substr(plan_of("seed-erosion").out.find("Models of")));
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
  const auto json = nlohmann::json::parse(plan_of("seed-erosion", {"--json"}).out);
  ASSERT_EQ(json.size(), 1u);
  EXPECT_EQ(json[0]["models"].size(), 16u);   // the rung of the fluid, and every term
  EXPECT_EQ(json[0]["models"][0]["term"], "fluid = box");
  EXPECT_EQ(json[0]["models"][1]["term"], "drag");
  EXPECT_GT(json[0]["numbers"].size(), 15u);
  EXPECT_GE(json[0]["warnings"].size(), 2u);
}

}   // namespace
}   // namespace bedload

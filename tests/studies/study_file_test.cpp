// Reading study files: what is refused, where, and what is suggested.
#include "studies/study_file.hpp"

#include <gtest/gtest.h>

#include "tests/studies/study_fixture.hpp"

namespace bedload {
namespace {

TEST(StudyFile, ReadsAGoodStudy) {
  const auto study = parse_study(good_study, "study.toml");
  EXPECT_EQ(study.name, "screening");
  ASSERT_EQ(study.axes.size(), 3u);
  EXPECT_EQ(study.axes[0].key, "grains.diameter");
  EXPECT_EQ(study.axes[2].key, "bed.seed");
  EXPECT_EQ(study.run.checkpoint_every, 300);
}

TEST(StudyFile, PointsAtTheValueThatIsNoLength) {
  EXPECT_TRUE(says(complaint(with(good_study, "\"0.6 mm\"", "\"0,8 mm\"")),
                   "study.toml:9:23: error: grains.diameter[2]: \"0,8 mm\" is not a length\nhint: "));
}

TEST(StudyFile, SuggestsTheNearestKey) {
  const auto said = complaint(with(good_study, "spread", "spred"));
  EXPECT_TRUE(says(said, "study.toml:11:1: error: grains.spred is not a key of a study file"));
  EXPECT_TRUE(says(said, "hint: did you mean grains.spread?"));
  EXPECT_TRUE(says(complaint(with(good_study, "[fluid]", "[fluids]")), "did you mean fluid?"));
}

TEST(StudyFile, SaysWhatThereIsWhereNothingIsNear) {
  EXPECT_TRUE(says(complaint(with(good_study, "spread", "d50")),
                   "grains.d50 is not a key of a study file\nhint: its place takes diameter, density, density_ratio, "
                   "spread, friction, "
                   "restitution, poisson, rolling_friction, stiffness; "));
  EXPECT_TRUE(says(complaint(with(good_study, "steps = 12", "steps = 12, to = 3")),
                   "drive.shields.to is not a key of a study file\nhint: its place takes from, ratio, step, steps; "));
  EXPECT_TRUE(
      says(complaint(with(good_study, "[fluid]", "[water]")),
           "hint: its place takes format, name, fluid, grains, bed, box, drive, onset, models, steps, record, run, "
           "exclude; "));
  EXPECT_TRUE(says(complaint(with(good_study, "\"lid\"", "\"wind\"")),
                   "drive.kind: \"wind\" is not known\nhint: one of lid, pressure, push, through_flow, none"));
  EXPECT_TRUE(says(complaint(with(good_study, "length", "lenght")), "did you mean box.length?"));
}

TEST(StudyFile, TellsHowToAddATermToTheAutomaticOnes) {
  EXPECT_TRUE(says(complaint(with(good_study, "[drive]", "[models]\nterms = [\"auto\", \"exposure\"]\n[drive]")),
                   "study.toml:23:10: error: models.terms[1]: \"auto\" stands for a whole list, not in one\n"
                   "hint: `bedload plan` prints the list that \"auto\" stands for"));
}

TEST(StudyFile, SuggestsTheNearestWord) {
  EXPECT_TRUE(says(complaint(with(good_study, "\"lid\"", "\"lidd\"")),
                   "did you mean \"lid\"? It is one of lid, pressure, push, through_flow, none"));
}

TEST(StudyFile, SuggestsWhatDiffersInCaseOnly) {
  const auto said = [](const std::string& models) {
    return complaint(with(good_study, "[drive]", models + "[drive]"));
  };
  EXPECT_TRUE(says(said("[models]\ndrag = \"TANG\"\n"), "did you mean \"tang\"?"));
  EXPECT_TRUE(says(said("[models]\ndrag = \"Di_Felice\"\n"), "did you mean \"di_felice\"?"));
  EXPECT_TRUE(says(said("[models]\nterms = [\"drag\", \"MAGNUS\"]\n"), "did you mean \"magnus\"?"));
  EXPECT_TRUE(
      says(said("[MODELS]\ndrag = \"tang\"\n"), "MODELS is not a key of a study file\nhint: did you mean models?"));
}

TEST(StudyFile, ReportsAllProblemsAtOnceInOrderOfPlace) {
  const auto said = complaint(with(with(good_study, "\"25 td\"", "25"), "\"1000 kg/m3\"", "\"1000 kg\""));
  const auto density = said.find("study.toml:5:11: error: fluid.density"),
             dwell = said.find("study.toml:25:9: error: drive.dwell");
  ASSERT_NE(density, std::string::npos) << said;
  ASSERT_NE(dwell, std::string::npos) << said;
  EXPECT_LT(density, dwell);
}

TEST(StudyFile, ReportsASyntaxErrorWithItsPlace) {
  EXPECT_TRUE(says(complaint(with(good_study, "density = \"1000 kg/m3\"", "density = 1000 kg/m3")), "study.toml:5:"));
}

TEST(StudyFile, RemindsOfQuotesOnlyWhereTheyAreMissing) {
  const auto hint = [](const std::string& part, const std::string& instead) {
    try {
      parse_study(with(good_study, part, instead), "study.toml");
    } catch (const Error& error) {
      return error.hint;
    }
    return std::string("accepted");
  };
  EXPECT_TRUE(says(hint("\"13 d\"", "13 d"), "values with a unit stand in quotes"));
  EXPECT_TRUE(says(hint("\"lid\"", "lid"), "words stand in quotes"));
  EXPECT_EQ(hint("count = 300", "count = 300\ncount = 400"), "");
  EXPECT_EQ(hint("[bed]", "[bed"), "");
  EXPECT_EQ(hint("ratio = 1.2,", "ratio = 1.2"), "");
}

TEST(StudyFile, BlamesAMissingKeyOnlyOnItself) {
  EXPECT_EQ(complaint(with(good_study, "viscosity = \"1.0e-5 m2/s\"", "")),
            "study.toml: error: fluid.viscosity is missing\nhint: docs/study_files.md shows every key with an example");
  EXPECT_EQ(complaint(with(good_study, "diameter = [\"0.5 mm\", \"0.6 mm\"]", "")),
            "study.toml: error: grains.diameter is missing\nhint: docs/study_files.md shows every key with an example");
}

struct Refusal {
  const char *part, *instead, *message;
  friend void PrintTo(const Refusal& r, std::ostream* out) { *out << r.message; }
};
class Refused : public testing::TestWithParam<Refusal> {};
TEST_P(Refused, WithTheReason) {
  EXPECT_TRUE(says(complaint(with(good_study, GetParam().part, GetParam().instead)), GetParam().message));
}
INSTANTIATE_TEST_SUITE_P(
    StudyFile, Refused,
    testing::Values(
        Refusal{"format = 1", "format = 2", "not a format that this bedload reads"},
        Refusal{"\"1.0e-5 m2/s\"", "1.0e-5", "fluid.viscosity: \"1e-05\" has no unit"},
        Refusal{"\"1.0e-5 m2/s\"", "\"1.0e-5 m/s\"", "is a speed, not a kinematic viscosity"},
        Refusal{"\"0.5 mm\"", "\"0 mm\"", "grains.diameter[1]: '0 mm' must be greater than zero"},
        Refusal{"\"0.5 mm\"", "\"-0.5 mm\"", "must be greater than zero"},
        Refusal{"\"0.5 mm\"", "\"0.6 mm\"", "stands twice"},
        Refusal{"[\"0.5 mm\", \"0.6 mm\"]", "\"2 d\"", "counts grain diameters, which are not known here"},
        Refusal{"steps = 12", "steps = [12, 14]", "not physics"},
        Refusal{"dwell =", "[onset]\ncriterion = [\"flux\", \"moving_fraction\"]\n[drive.x]\ndwell =",
                "onset.criterion: a list is an axis, and this key is not physics"},
        Refusal{"[drive]", "[onset]\nhold = \"50 td\"\n[drive]", "onset.hold: only onset.method = \"bisect\" reads it"},
        Refusal{"[drive]", "[onset]\nmethod = \"bisect\"\ncriterion = \"moving_fraction\"\n[drive]",
                "onset.criterion: a bisection asks whether grains go on moving downstream"},
        Refusal{"[drive]", "[onset]\nmethod = \"bisect\"\nhold = \"8 td\"\n[drive]",
                "a search judges holds by them and wants 9 at least within onset.hold"},
        Refusal{"[drive]", "[onset]\nmethod = \"bisect\"\n[record]\nevery = \"3 td\"\n[drive]",
                "a search judges holds by them and wants 9 at least within drive.dwell"},
        Refusal{"[drive]", "[run]\nexecutor = \"slurm\"\n[drive]", "run.executor: \"slurm\" is not in this version"},
        Refusal{"[drive]", "[run]\nranks = 2\n[drive]", "run.ranks: 2 ranks per case are not in this version"},
        Refusal{"[drive]", "[models]\nfluid = \"column\"\nsmoothing.z = \"1 d\"\n[drive]",
                "models.fluid = \"column\": slices of grains take the place of the kernel that it widens"},
        Refusal{"[drive]", "[models]\nfluid = \"column\"\nterms = [\"drag\", \"self_disturbance\"]\n[drive]",
                "models.fluid = \"column\": it does not carry self_disturbance"},
        Refusal{"[drive]", "[models]\nfluid = \"column\"\nterms = [\"drag\", \"buoyancy\"]\n[drive]",
                "models.fluid = \"column\": its balance is that of Model A"},
        Refusal{"[drive]", "[models]\nfluid = \"profile\"\n[drive]\nstart = \"rest\"",
                "models.fluid = \"profile\": a flow that answers to nothing is imposed as it is when steady"},
        Refusal{"[drive]", "[models]\nterms = [\"drag\", \"viscous_torqe\"]\n[drive]",
                "did you mean \"viscous_torque\"?"},
        Refusal{"[drive]", "[models]\nterms = [\"drag\", \"buoyancy\", \"drag\"]\n[drive]",
                "study.toml:23:30: error: models.terms[3]: \"drag\" stands twice in this list\nhint: remove one"},
        Refusal{"[drive]", "[models]\nterms = [\"drag\", \"viscous_stress\"]\n[drive]", "both or neither"},
        Refusal{"[drive]", "[models]\nterms = [\"drag\", \"wet_restitution\", \"lubrication\"]\n[drive]",
                "study.toml:23:9: error: models.terms: wet_restitution and lubrication are both the film"},
        Refusal{"[drive]", "[models]\nterms = [\"buoyancy\", \"shear_lift\"]\n[drive]",
                "models.terms: shear_lift works on the drag of a grain, and drag is left out\nhint: add \"drag\""},
        Refusal{"[drive]", "[models]\nterms = [\"magnus\"]\n[drive]", "magnus works on the drag"},
        Refusal{"spread = 0.05", "friction = 0\n[models]\nterms = [\"drag\", \"magnus\"]",
                "magnus is the force of a grain's spin, and nothing turns these"},
        Refusal{"height = \"13 d\"", "height = \"13 d\"\nroughness = \"1 mm\"",
                "study.toml:21:13: error: box.roughness: a rough wall has meaning only for a turbulent flow"},
        Refusal{"[drive]", "[models]\nstrict = \"yes\"\n[drive]", "models.strict: 'yes' is not true or false"},
        Refusal{"[drive]", "[models]\nstrict = true\ndrag = \"stokes\"\n[drive]",
                "study.toml:24:8: error: models.drag: grains come to Re = "},
        Refusal{"\"1.0e-5 m2/s\"", "\"1.0e-6 m2/s\"\n[models]\nstrict = true\nterms = [\"drag\", \"buoyancy\"]",
                "study.toml:6:13: error: fluid.viscosity: this laminar scene is not physical"},
        Refusal{"[drive]", "[models]\ndrag = \"betstra\"\n[drive]", "did you mean \"beetstra\"?"},
        Refusal{"[drive]", "[models]\naccuracy = { target = \"5 %\" }\n[drive]", "models.accuracy"},
        Refusal{"spread = 0.05", "rolling_friction = -0.1", "zero or greater"},
        Refusal{"[drive]", "[steps]\ndem = \"1 ms\"\n[drive]", "Rayleigh times of the smallest grain"},
        Refusal{"height = \"13 d\"", "height = \"3 d\"", "do not fit the box"},
        Refusal{"width = \"6 d\"", "width = \"6 d\"\ncell = { xy = \"8 d\" }", "larger than the box"},
        Refusal{"width = \"6 d\"", "width = \"6 d\"\nz = \"periodic\"", "a periodic z has none"},
        Refusal{"count = 300", "count = 300\ndepth = \"4 d\"", "both count and depth"},
        Refusal{"count = 300", "count = 2.5", "is not a whole number"},
        Refusal{"kind = \"lid\"", "kind = \"pressure\"\nspeed = \"1 m/s\"",
                "wants one of drive.shields and drive.gradient"},
        Refusal{"length = \"10 d\"", "", "study.toml: error: box.length is missing"},
        Refusal{"ratio = 1.2, ", "", "how the levels grow is missing"},
        Refusal{"\"2000 kg/m3\"", "\"900 kg/m3\"",
                "study.toml:10:12: error: grains.density: grains of 900 kg/m3 do not settle in a fluid of 1000 kg/m3"},
        Refusal{"spread = 0.05", "spread = 0.9",
                "study.toml:11:10: error: grains.spread: 0.9 lets the smallest grain vanish"},
        Refusal{"steps = 12", "steps = 100000000",
                "study.toml:24:47: error: drive.shields.steps: 100000000 levels are too many\nhint: at most 10000"},
        Refusal{"steps = 12", "steps = 5000", "drive.shields.steps: level 5000 is too large a number"},
        Refusal{"ratio = 1.2, steps = 12", "step = 1e306, steps = 5000", "level 5000 is too large a number"},
        Refusal{"\"25 td\"", "\"1e30 s\"", "study.toml:25:9: error: drive.dwell: 12 times 1e+30 s are"},
        Refusal{"count = 300", "count = 99999999999", "bed.count: 99999999999 is too large\nhint: at most 4000000000"},
        Refusal{"[drive]", "[run]\nwall_limit = \"1 h\"\n[drive]",
                "run.wall_limit is not in this version (a wall time limit per attempt)"},
        Refusal{"name = \"screening\"", "name = \"a/b\"", "cannot be the name of a result directory"},
        Refusal{"name = \"screening\"", "bed_only = true", "bed_only is not a key"}));

TEST(StudyFile, IsStrictOnlyWhereItSaysSo) {
  const auto stokes = [](const std::string& strict) {
    return complaint(with(good_study, "[drive]", "[models]\n" + strict + "drag = \"stokes\"\n[drive]"));
  };
  EXPECT_EQ(stokes(""), "");
  EXPECT_EQ(stokes("strict = false\n"), "");
  EXPECT_TRUE(says(stokes("strict = true\n"), "the drag law stokes is made for Re up to 0.1"));
  EXPECT_TRUE(says(stokes("strict = true\n"), "made for 0.995 and more"));
}

// It is the fluid's turning against the grain's, whatever its slip.
TEST(StudyFile, TakesViscousTorqueWithoutDrag) {
  const auto text = with(good_study, "[drive]", "[models]\nterms = [\"viscous_torque\"]\n[drive]");
  EXPECT_EQ(complaint(text), "");
  EXPECT_TRUE(unfold(parse_study(text, "study.toml"))[0].scene.terms.viscous_torque);
}

// Every value that puts cases out of range is blamed, once for all of them.
TEST(StudyFile, ReportsTheRangeOfAllCasesWhereItIsStrict) {
  const auto strict = with(good_study, "[drive]", "[models]\nstrict = true\ndrag = \"stokes\"\n[drive]");
  const auto said = complaint(with(strict, "\"0.5 mm\", \"0.6 mm\"", "\"0.5 mm\", \"50 um\", \"40 um\""));
  EXPECT_TRUE(says(said, "study.toml:9:23: error: grains.diameter[2]: grains of "));
  EXPECT_TRUE(says(said, "there is none here (d50um-rho2000-s1 and 3 more)\n"));
  EXPECT_TRUE(says(said, "study.toml:9:32: error: grains.diameter[3]: grains of "));
  EXPECT_TRUE(says(said, "(d40um-rho2000-s1 and 3 more)\n"));
  const auto law = said.find("models.drag: grains come to Re = ");
  EXPECT_NE(law, said.npos) << said;
  EXPECT_EQ(said.find("models.drag: grains come to Re = ", law + 1), said.npos) << said;
}

TEST(StudyFile, TakesAnEmptyListOfTermsAsDryGrains) {
  const auto cases = unfold(parse_study(with(good_study, "[drive]", "[models]\nterms = []\n[drive]"), "study.toml"));
  for (const auto& named : named_terms) EXPECT_FALSE(cases[0].scene.terms.*named.term) << named.name;
}

TEST(StudyFile, TakesAListOfListsAsTheAxisOfTerms) {
  const auto study = parse_study(
      with(good_study, "[drive]", "[models]\nterms = [[\"drag\", \"buoyancy\"], [\"drag\"]]\n[drive]"), "study.toml");
  ASSERT_EQ(study.axes.size(), 4u);
  EXPECT_EQ(study.axes[3].key, "models.terms");
}

}   // namespace
}   // namespace bedload

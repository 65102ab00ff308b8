// The example studies: what `plan` says of them.
#include <gtest/gtest.h>

#include "tests/end_to_end/bedload_program.hpp"
#include "tests/support/temporary_directory.hpp"

namespace bedload {
namespace {

Outcome plan_of(const std::string& name) {
  TemporaryDirectory here;
  return bedload(here.path(), {"plan", std::string(BEDLOAD_SOURCE_DIR) + "/studies/examples/" + name + ".toml", "--out",
                               here.path() / "out"});
}

TEST(Examples, QuickstartHasFourCasesThatAreLaminar) {
  const auto plan = plan_of("quickstart");
  EXPECT_EQ(plan.code, 0) << plan.err;
  EXPECT_NE(plan.out.find("4 cases (4 new"), std::string::npos) << plan.out;
  EXPECT_EQ(plan.out.find("not physical"), std::string::npos) << plan.out;
}

// tau_b = 0.2 x 2000 x 9.81 x 0.001 = 3.924 Pa; over 10 mm of water that is a lid at 39 m/s.
TEST(Examples, SeedErosionIsCalledUnphysicalInWater) {
  for (const auto* name : {"seed-erosion", "seed-erosion-fine"}) {
    const auto plan = plan_of(name);
    EXPECT_EQ(plan.code, 0) << plan.err;
    for (const auto* part : {"this laminar scene is not physical", "theta = 0.2 means a lid speed of 39.1 m/s",
                             "gap Reynolds number of 3.9e+05"})
      EXPECT_NE(plan.out.find(part), std::string::npos) << part << "\n" << plan.out;
  }
}

}   // namespace
}   // namespace bedload

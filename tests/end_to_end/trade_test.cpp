// `bedload trade` from the study file to the frontier, and a study that follows it.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "base/durable_file.hpp"
#include "tests/end_to_end/bedload_program.hpp"
#include "tests/end_to_end/tiny_study.hpp"
#include "tests/support/temporary_directory.hpp"

namespace bedload {
namespace {

std::string one_scene() {
  auto text = with(tiny_study, "diameter = [\"0.5 mm\", \"0.6 mm\"]", "diameter = \"0.5 mm\"");
  text = with(text, "density = [\"2000 kg/m3\", \"3000 kg/m3\"]", "density = \"2000 kg/m3\"");
  text = with(text, "from = 0.1, ratio = 1.5, steps = 4", "from = 0.05, ratio = 1.5, steps = 6");
  return with(text, "dwell = \"5 td\"", "");
}

TEST(Trade, MeasuresWhatAnotherStudyThenFollows) {
  TemporaryDirectory here;
  std::ofstream(here.path() / "trade.toml")
      << with(with(with(one_scene(), "\"tiny\"", "\"trade\""), "[drive]", "[drive]\ndwell = \"5 td\""), "[bed]",
              "[bed]\nseed = { count = 4 }")
      << "[[trade]]\nname = \"short\"\ndrive.dwell = \"2 td\"\n";
  const auto made = bedload(here.path(), {"trade", "trade.toml", "--cores", "2"});
  ASSERT_EQ(made.code, 0) << made.err;
  for (const char* part : {"finest", "short", "core s", "scene: Ga = 3.5, s = 2"})
    EXPECT_NE(made.out.find(part), std::string::npos) << part << "\n" << made.out;
  const auto json = nlohmann::json::parse(read_text(here.path() / "trade" / "trade.json"));
  EXPECT_EQ(json["settings"][1]["changes"]["drive.dwell"], "\"2 td\"");
  EXPECT_LT(json["settings"][1]["core_seconds"].get<double>(), json["settings"][0]["core_seconds"].get<double>());
  const auto asked = bedload(
      here.path(), {"query", "trade.toml", "SELECT setting, frontier FROM trades WHERE core_s > 0 ORDER BY core_s"});
  EXPECT_NE(asked.out.find("short    1"), std::string::npos) << asked.out;
  EXPECT_TRUE(read_text(here.path() / "trade" / "trade.svg").starts_with("<svg xmlns="));
  EXPECT_NE(read_text(here.path() / "trade" / "report.html").find("Trade of speed against accuracy"),
            std::string::npos);

  std::ofstream(here.path() / "tiny.toml") << with(
      one_scene(), "[drive]", "[models]\naccuracy = { target = \"500 %\", from = \"trade/trade.json\" }\n\n[drive]");
  const auto plan = bedload(here.path(), {"plan", "tiny.toml"});
  EXPECT_EQ(plan.code, 0) << plan.err;
  EXPECT_NE(plan.out.find("accuracy 500 %: setting short of trade/trade.json"), std::string::npos) << plan.out;
  const auto told = nlohmann::json::parse(bedload(here.path(), {"plan", "tiny.toml", "--json"}).out);
  const double predicted = told[0]["core_hours"].get<double>() * 3600;
  EXPECT_NEAR(predicted / json["settings"][1]["core_seconds"].get<double>(), 1, 0.3)
      << "the same scene, another packing";
  EXPECT_EQ(bedload(here.path(), {"run", "tiny.toml", "--prepare"}).code, 0);
  EXPECT_EQ(bedload(here.path(), {"plan", "tiny"}).code, 0) << "the result directory stands by itself";
}

}   // namespace
}   // namespace bedload

// Which scenes the matrix has.
#include <algorithm>

#include <fmt/format.h>

#include "studies/covering_pairs.hpp"
#include "studies/extremes.hpp"

namespace bedload {
namespace {

constexpr int full_length = 1500, short_length = 220;   // fluid steps

struct Level {
  const char *name, *lines;
};
using Factor = std::vector<Level>;

/// One factor at a time around each of the two beds.
const std::vector<Factor>& single_factors() {
  static const std::vector<Factor> factors = {
      {{"d 20 um", "grains.diameter = \"20 um\""},
       {"d 0.1 mm", "grains.diameter = \"0.1 mm\""},
       {"d 4 mm", "grains.diameter = \"4 mm\""},
       {"d 20 mm", "grains.diameter = \"20 mm\""}},
      {{"s 1.01", "grains.density = \"1010 kg/m3\""},
       {"s 1.05", "grains.density = \"1050 kg/m3\""},
       {"s 1.2", "grains.density = \"1200 kg/m3\""},
       {"s 1.5", "grains.density = \"1500 kg/m3\""},
       {"s 8", "grains.density = \"8000 kg/m3\""}},
      {{"theta 0.01", "drive.shields = 0.01"}, {"theta 1", "drive.shields = 1.0"}, {"theta 5", "drive.shields = 5.0"}},
      {{"nu 1e-6", "fluid.viscosity = \"1e-6 m2/s\""},
       {"nu 1e-4", "fluid.viscosity = \"1e-4 m2/s\""},
       {"nu 1e-2", "fluid.viscosity = \"1e-2 m2/s\""}},
      {{"slope -20", "box.slope = \"-20 deg\""}, {"slope 25", "box.slope = \"25 deg\""}},
      {{"restitution 0", "grains.restitution = 0.0"}, {"restitution 1", "grains.restitution = 1.0"}},
      {{"friction 0", "grains.friction = 0.0"}, {"friction 1", "grains.friction = 1.0"}},
      {{"spread 0.3",
        "grains.spread = 0.3\nbox.width = \"8 d\"\nbox.cell.xy = \"2.7 d\"\nbox.cell.z = \"0.75 d\"\nbed.count = 90"}},
      {{"one layer", "bed.count = 36"}},
  };
  return factors;
}

/// Every pair of levels of two of these occurs.
const std::vector<Factor>& paired_factors() {
  static const std::vector<Factor> factors = {
      {{"d 20 um", "grains.diameter = \"20 um\""},
       {"d 0.2 mm", "grains.diameter = \"0.2 mm\""},
       {"d 2 mm", "grains.diameter = \"2 mm\""},
       {"d 20 mm", "grains.diameter = \"20 mm\""}},
      {{"s 1.01", "grains.density = \"1010 kg/m3\""},
       {"s 1.2", "grains.density = \"1200 kg/m3\""},
       {"s 2.65", "grains.density = \"2650 kg/m3\""},
       {"s 8", "grains.density = \"8000 kg/m3\""}},
      {{"nu 1e-6", "fluid.viscosity = \"1e-6 m2/s\""},
       {"nu 1e-4", "fluid.viscosity = \"1e-4 m2/s\""},
       {"nu 1e-2", "fluid.viscosity = \"1e-2 m2/s\""}},
      {{"theta 0.01", "drive.shields = 0.01"},
       {"theta 0.3", "drive.shields = 0.3"},
       {"theta 5", "drive.shields = 5.0"}},
      {{"slope -20", "box.slope = \"-20 deg\""}, {"level", ""}, {"slope 25", "box.slope = \"25 deg\""}},
      {{"e 0", "grains.restitution = 0.0"}, {"e 1", "grains.restitution = 1.0"}},
      {{"mu 0", "grains.friction = 0.0"}, {"mu 1", "grains.friction = 1.0"}},
  };
  return factors;
}

std::string table(const char* file) {
  return fmt::format("without bed\nbed.source = \"file\"\nbed.file = \"{}\"", file);
}

const std::string by_speed = "without drive.shields\ndrive.speed = \"0.05 m/s\"";

std::vector<ExtremeScene> special_scenes() {
  const std::string laminar = "extremes-laminar", water = "extremes-water";
  std::vector<ExtremeScene> scenes;
  const auto add = [&](const std::string& name, const std::string& base, const std::string& overrides, bool quick) {
    scenes.push_back({.name = name, .base = base, .overrides = overrides, .quick = quick});
  };
  const auto refuse = [&](const std::string& name, const std::string& overrides, const std::string& why) {
    scenes.push_back({.name = name,
                      .base = laminar,
                      .overrides = overrides,
                      .expected = Outcome::refused,
                      .why = why,
                      .quick = true});
  };
  add("as it is", laminar, "", true);
  add("as it is", water, "", true);
  add("no grain", laminar, "without bed\nbed.source = \"none\"", true);
  add("no grain", water, "without bed\nbed.source = \"none\"", true);
  add("one grain", laminar, table("extremes-one.csv") + "\n" + by_speed, false);
  add("on cell faces", laminar, table("extremes-face.csv") + "\n" + by_speed, true);
  add("on the seam", laminar, table("extremes-seam.csv") + "\n" + by_speed, true);
  add("in corners", laminar, table("extremes-corner.csv") + "\nbox.x = \"wall\"\nbox.y = \"wall\"\n" + by_speed, true);
  add("no bottom, no lid", laminar,
      table("extremes-seam.csv") + "\nbox.z = \"periodic\"\nwithout drive.shields\ndrive.kind = \"none\"", true);
  add("size ratio 1:5", laminar, table("extremes-sizes.csv"), true);
  add("bed of solid fraction 0.64 that touches the lid", laminar,
      table("extremes-dense.csv") +
          "\nbox.length = \"3.71164321 mm\"\nbox.width = \"2.96931457 mm\"\nbox.height = \"4.58780773 mm\"\n" +
          by_speed,
      true);
  add("fluid at rest", laminar, "without drive.shields\ndrive.kind = \"none\"", false);
  add("fluid at rest, s 1.01", water, "grains.density = \"1010 kg/m3\"\nwithout drive\ndrive.kind = \"none\"", true);
  add("lid that turns back", laminar,
      "without drive.shields\ndrive.speed.from = \"0.05 m/s\"\ndrive.speed.step = \"-0.1 m/s\"\ndrive.speed.steps = 2",
      true);
  add("stream that turns back", water,
      "without drive.shields\ndrive.gradient.from = \"20 Pa/m\"\ndrive.gradient.step = \"-40 Pa/m\"\n"
      "drive.gradient.steps = 2",
      false);
  refuse("two grains at one place", table("extremes-twins.csv") + "\n" + by_speed, "no direction parts them");
  refuse("DEM step of a millisecond", "steps.dem = \"1 ms\"", "it is many Rayleigh times of the smallest grain");
  refuse("more grains than fit", "bed.count = 600", "the bed would be higher than the box");
  refuse("grains lighter than the fluid", "grains.density = \"990 kg/m3\"", "they would not settle");
  refuse("tilt of 60 degrees", "box.slope = \"60 deg\"", "beyond 45 degrees x is no longer along the bed");
  return scenes;
}

std::string joined(const std::string& a, const std::string& b) { return a.empty() || b.empty() ? a + b : a + "\n" + b; }

}   // namespace

std::vector<ExtremeScene> extreme_scenes(bool quick) {
  std::vector<ExtremeScene> scenes = special_scenes();
  for (const char* base : {"extremes-laminar", "extremes-water"})
    for (const Factor& factor : single_factors())
      for (const Level& level : factor) {
        const bool ends = &level == &factor.front() || &level == &factor.back();
        scenes.push_back({.name = level.name,
                          .base = base,
                          .overrides = level.lines,
                          .quick = ends && (base == std::string("extremes-laminar"))});
      }
  std::vector<int> levels;
  for (const Factor& factor : paired_factors()) levels.push_back(static_cast<int>(factor.size()));
  for (const auto& row : covering_pairs(levels)) {
    ExtremeScene scene{.base = "extremes-water"};
    for (std::size_t f = 0; f < row.size(); ++f) {
      const Level& level = paired_factors()[f][static_cast<std::size_t>(row[f])];
      scene.name += fmt::format("{}{}", f ? ", " : "", level.name);
      scene.overrides = joined(scene.overrides, level.lines);
    }
    scenes.push_back(scene);
  }
  for (ExtremeScene& scene : scenes) scene.steps = quick ? short_length : full_length;
  if (quick) std::erase_if(scenes, [](const ExtremeScene& scene) { return !scene.quick; });
  return scenes;
}

}   // namespace bedload

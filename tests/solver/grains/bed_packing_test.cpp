#include "solver/grains/bed_packing.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "solver/grains/box_walls.hpp"
#include "tests/solver/grains/grain_scenes.hpp"
#include "tests/support/plain_pouring.hpp"

namespace bedload {
namespace {

/// Grains of 0.5 mm in a viscous liquid over a box of 10 x 8 x 13 d.
BedScene bed_scene(std::uint64_t count, BedSource::Kind kind = BedSource::Kind::poured) {
  const double d = 0.5e-3;
  BedScene scene;
  scene.fluid = {1000, 1e-5};
  scene.grains = {d, 2500, 0.05, 0.4, 0.6, 0.3, 0};
  scene.source = {kind, count, "", 1};
  scene.length = {10 * d, 8 * d, 13 * d};
  scene.sides = {Side::periodic, Side::periodic, Side::wall};
  scene.gravity = {0, 0, -9.81};
  scene.grains.young_modulus = automatic_young_modulus(scene, bed_layers(scene));
  scene.dem_step = 0.2 * rayleigh_time(0.9 * d, 2500, scene.grains.young_modulus, 0.3);
  return scene;
}

double deepest_overlap(const BedScene& scene, const Grains& grains) {
  const PeriodicBox box(scene);
  double deepest = 0;
  for (std::size_t i = 0; i < grains.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      deepest = std::max(deepest, (grains.diameter[i] + grains.diameter[j]) / 2 -
                                      norm(box.shortest(grains.position[i] - grains.position[j])));
  return deepest / scene.grains.diameter;
}

/// Volume of grains between two levels / volume of the slab: exact spherical segments.
double solid_fraction(const BedScene& scene, const Grains& grains, double low, double high) {
  const auto below = [](double r, double level) {   // of a sphere about 0, below `level`
    const double h = std::clamp(level + r, 0.0, 2 * r);
    return std::numbers::pi * h * h * (r - h / 3);
  };
  double volume = 0;
  for (std::size_t i = 0; i < grains.size(); ++i) {
    const double r = grains.diameter[i] / 2, z = grains.position[i].z;
    volume += below(r, high - z) - below(r, low - z);
  }
  return volume / ((high - low) * scene.length.x * scene.length.y);
}

struct Bed {
  Grains grains;
  ContactHistory contacts;
  bool settled = false;
  int intervals = 0;
};

Bed settle(const BedScene& scene, int most_intervals = 3000) {
  Bed bed;
  bed.grains = place_grains(scene);
  BedPacking packing(scene);
  double time = 0;
  for (; bed.intervals < most_intervals && !bed.settled; ++bed.intervals) {
    const auto progress = packing.advance(bed.grains, bed.contacts);
    bed.settled = progress.settled;
    time += progress.dt;
  }
  EXPECT_LT(time, packing.patience() / 10) << "a bed that would be given up too early";
  return bed;
}

TEST(BedPacking, PlacesGrainsApartAndInsideTheBox) {
  for (const auto kind : {BedSource::Kind::poured, BedSource::Kind::lattice})
    for (const Side side : {Side::periodic, Side::wall}) {
      BedScene scene = bed_scene(400, kind);
      scene.sides[0] = scene.sides[1] = side;
      const Grains grains = place_grains(scene);
      ASSERT_EQ(grains.size(), 400u);
      EXPECT_LE(deepest_overlap(scene, grains), 1e-12);
      for (std::size_t i = 0; i < grains.size(); ++i)
        for (int c = 0; c < 3; ++c) {
          const double room = scene.sides[c] == Side::wall ? grains.diameter[i] / 2 * (1 - 1e-12) : 0;
          EXPECT_GE(grains.position[i][c], room);
          EXPECT_LE(grains.position[i][c], scene.length[c] - room);
        }
    }
}

TEST(BedPacking, DrawsDiametersAboutTheMeanCutAtTwoDeviations) {
  BedScene scene = bed_scene(4000);
  scene.length = {30e-3, 30e-3, 30e-3};
  const Grains grains = place_grains(scene);
  double sum = 0, squares = 0;
  for (const double d : grains.diameter) {
    EXPECT_LE(std::abs(d / 0.5e-3 - 1), 2 * 0.05 * (1 + 1e-12));
    sum += d / 0.5e-3 - 1, squares += (d / 0.5e-3 - 1) * (d / 0.5e-3 - 1);
  }
  EXPECT_NEAR(sum / 4000, 0, 4 * 0.05 / std::sqrt(4000.0));
  EXPECT_NEAR(std::sqrt(squares / 4000), 0.05 * 0.8796, 0.003);   // deviation of a normal cut at two deviations
}

TEST(BedPacking, PoursTheSameBedForTheSameSeedOnly) {
  BedScene scene = bed_scene(300);
  const Grains first = place_grains(scene);
  EXPECT_TRUE(first == place_grains(scene));
  scene.source.seed = 2;
  EXPECT_FALSE(first == place_grains(scene));
}

TEST(BedPacking, RefusesMoreGrainsThanFitBelowTheTop) {
  EXPECT_NO_THROW(place_grains(bed_scene(500)));
  try {
    place_grains(bed_scene(5000));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind, ErrorKind::study_invalid);
    EXPECT_NE(std::string(error.what()).find("5000 grains"), std::string::npos) << error.what();
  }
  BedScene narrow = bed_scene(3);
  narrow.sides[1] = Side::wall, narrow.length.y = 0.4e-3;
  EXPECT_THROW(place_grains(narrow), Error) << "a slot narrower than a grain";
}

// Random loose packing .55 (Onoda & Liniger 1990) to random close packing .64.
TEST(BedPacking, SettlesBetweenRandomLooseAndRandomClosePacking) {
  const BedScene scene = bed_scene(500);
  const Bed bed = settle(scene);
  ASSERT_TRUE(bed.settled);
  const double d = scene.grains.diameter, phi = solid_fraction(scene, bed.grains, 1.5 * d, 4.5 * d);
  EXPECT_GE(phi, 0.55);
  EXPECT_LE(phi, 0.64);
  EXPECT_LT(deepest_overlap(scene, bed.grains), 0.01);
  const double coordination = 2.0 * static_cast<double>(bed.contacts.size()) / 500;
  EXPECT_GT(coordination, 4) << "isostatic with friction";
  EXPECT_LT(coordination, 6.5) << "isostatic without";
}

// Explicit damping that is too strong for the step shakes a bed for ever: the longest step that a study may ask for.
TEST(BedPacking, SettlesWithoutRestitutionUnderFullFrictionAtTheLongestStep) {
  for (const double restitution : {0.0, 0.3}) {
    BedScene scene = bed_scene(250);
    scene.grains.friction = 1, scene.grains.restitution = restitution, scene.dem_step *= 1.5;
    EXPECT_TRUE(settle(scene, 800).settled) << restitution;
  }
}

TEST(BedPacking, ComesToRestSoonAtRestitutionOneWhereTheLiquidSlowsNothing) {
  // Grains of 5 mm in water: Stokes's drag alone would take some seconds, 4000 intervals and more, to slow them.
  BedScene scene = bed_scene(500);
  const double larger = 10;
  scene.fluid.viscosity = 1e-6, scene.grains.restitution = 1;
  scene.grains.diameter *= larger, scene.length *= larger;
  scene.grains.young_modulus = automatic_young_modulus(scene, bed_layers(scene));
  scene.dem_step = 0.2 * rayleigh_time(0.9 * scene.grains.diameter, 2500, scene.grains.young_modulus, 0.3);
  EXPECT_TRUE(settle(scene, 800).settled);
}

TEST(BedPacking, SinksByStokesButNoSlowerThanSpeedHasASay) {
  BedScene scene = bed_scene(1);
  const double d = 0.5e-3, reduced = (1 - 1000.0 / 2500) * 9.81;
  for (const double viscosity : {1e-4, 1e-2}) {
    scene.fluid.viscosity = viscosity;
    Grains grains = place_grains(scene);
    grains.diameter[0] = d, grains.position[0].z = 10 * d;
    ContactHistory contacts;
    BedPacking packing(scene);
    for (int interval = 0; interval < 5; ++interval) packing.advance(grains, contacts);
    const double stokes = reduced * 2500 * d * d / (18 * viscosity * 1000), slowest = 0.01 * std::sqrt(reduced * d);
    ASSERT_EQ(stokes<slowest, viscosity> 1e-3);
    EXPECT_NEAR(-grains.velocity[0].z / std::max(stokes, slowest), 1, 1e-3) << viscosity;
  }
}

// What is not in grains and contacts is scratch: a run that is resumed at any interval makes the same bed.
TEST(BedPacking, MakesTheSameBitsWhenEveryIntervalIsTakenByAnotherBedPacking) {
  const BedScene scene = bed_scene(300);
  Grains whole = place_grains(scene), parts = whole;
  ContactHistory contacts_of_whole, contacts_of_parts;
  BedPacking packing(scene);
  double time = 0;
  bool settled = false, alone = false;
  while (!settled) {
    const auto progress = packing.advance(whole, contacts_of_whole);
    BedPacking(scene).advance(parts, contacts_of_parts);
    ASSERT_TRUE(whole == parts && contacts_of_whole == contacts_of_parts) << time;
    alone |= progress.grain_steps < 300 * 50 / 2;
    time += progress.dt, settled = progress.settled;
    ASSERT_LT(time, packing.patience());
  }
  EXPECT_TRUE(alone) << "stragglers were moved by themselves, else this tests little";
}

/// How many grains go further than 0.05 d when a settled bed is left to itself.
int restless_grains(const BedScene& scene, Grains grains, ContactHistory contacts) {
  const Grains before = grains;
  BedPacking packing(scene);
  for (int n = 0; n < 100; ++n) packing.advance(grains, contacts);
  const PeriodicBox box(scene);
  int moved = 0;
  for (std::size_t i = 0; i < before.size(); ++i)
    moved += norm(box.shortest(grains.position[i] - before.position[i])) > 0.05 * scene.grains.diameter;
  return moved;
}

// A grain that balances on two others may roll on later, in a bed poured plainly too.
TEST(BedPacking, StaysSettledAsOftenAsAPlainlyPouredBed) {
  BedScene scene = bed_scene(200);
  int ours = 0, plain = 0;   // beds with a restless grain
  for (scene.source.seed = 1; scene.source.seed <= 16; ++scene.source.seed) {
    const Bed bed = settle(scene);
    ASSERT_TRUE(bed.settled);
    const int restless = restless_grains(scene, bed.grains, bed.contacts);
    EXPECT_LE(restless, 2) << "of 200, seed " << scene.source.seed;
    const test::PouredBed poured = test::pour_plainly(scene);
    ASSERT_TRUE(poured.settled);
    ours += restless > 0, plain += restless_grains(scene, poured.grains, poured.contacts) > 0;
  }
  EXPECT_LE(ours, plain + 4) << "of 16; " << plain
                             << " poured plainly; 1 % of pairs of sixteens differ by more if both are alike";
}

TEST(BedPacking, DoesNotTakeGrainsInTheAirForSettled) {
  const BedScene scene = bed_scene(300);
  Grains grains = place_grains(scene);
  ContactHistory contacts;
  BedPacking packing(scene);
  const auto first = packing.advance(grains, contacts);
  EXPECT_FALSE(first.settled);
  EXPECT_GT(first.dt, 0);
}

TEST(BedPacking, WaitsForFineGrainsThatSinkAtTheirTerminalSpeed) {
  BedScene scene = bed_scene(1);
  const double d = 20e-6;
  scene.fluid.viscosity = 1e-6;
  scene.grains.diameter = d, scene.grains.density = 2650;
  scene.length = {10 * d, 8 * d, 13 * d};
  scene.grains.young_modulus = automatic_young_modulus(scene, 1);
  scene.dem_step = 0.2 * rayleigh_time(0.9 * d, 2650, scene.grains.young_modulus, 0.3);
  Grains grains = place_grains(scene);
  grains.position[0].z = 3 * d;
  ContactHistory contacts;
  BedPacking packing(scene);
  bool settled = false;
  for (int n = 0; n < 3000 && !settled; ++n) settled = packing.advance(grains, contacts).settled;
  EXPECT_TRUE(settled);
  EXPECT_LT(grains.position[0].z, 0.56 * d) << "on the floor";
}

TEST(BedPacking, SettlesLevelHoweverSteepTheSlope) {
  BedScene scene = bed_scene(100);
  scene.gravity = {9.81 * std::sin(0.44), 0, -9.81 * std::cos(0.44)};
  EXPECT_TRUE(settle(scene).settled);
}

TEST(BedPacking, SettlesWhatIsLooseOverAFloor) {
  EXPECT_TRUE(needs_settling(bed_scene(10)));
  EXPECT_TRUE(needs_settling(bed_scene(10, BedSource::Kind::lattice)));
  EXPECT_FALSE(needs_settling(bed_scene(10, BedSource::Kind::file)));
  EXPECT_FALSE(needs_settling(bed_scene(10, BedSource::Kind::none)));
  EXPECT_FALSE(needs_settling(bed_scene(0)));
  BedScene bottomless = bed_scene(10), buoyant = bed_scene(10);
  bottomless.sides[2] = Side::periodic;
  buoyant.grains.density = buoyant.fluid.density;
  EXPECT_FALSE(needs_settling(bottomless));
  EXPECT_FALSE(needs_settling(buoyant));
}

TEST(BedPacking, FillsABoxWithoutFloorEvenly) {
  BedScene scene = bed_scene(300);
  scene.sides[2] = Side::periodic;
  const Grains grains = place_grains(scene);
  const double half = scene.length.z / 2;
  EXPECT_NEAR(static_cast<double>(std::ranges::count_if(grains.position, [&](Vec3 p) { return p.z < half; })), 150, 40);
  EXPECT_LE(deepest_overlap(scene, grains), 1e-12);
}

TEST(BedPacking, HandsOutIdsInSpaceWithoutChangingTheBed) {
  BedScene scene = bed_scene(200);
  scene.grains.rolling_friction = 0.1;   // another spring to be renamed
  Bed bed;
  bed.grains = place_grains(scene);
  BedPacking packing(scene);
  for (int n = 0; n < 60; ++n) packing.advance(bed.grains, bed.contacts);   // still moving: springs at work
  bed.contacts.damping.resize(bed.contacts.size());
  for (std::size_t k = 0; k < bed.contacts.size(); ++k) bed.contacts.damping[k] = norm2(bed.contacts.spring[k]);
  Bed renamed = bed;
  for (std::size_t i = 0; i < 200; ++i) renamed.grains.travel[i] = static_cast<double>(i);   // to know them again
  renumber_in_space(scene, renamed.grains, renamed.contacts);
  for (std::size_t k = 0; k < renamed.contacts.size(); ++k) {
    EXPECT_LT(renamed.contacts.lower[k], renamed.contacts.higher[k]);
    EXPECT_EQ(renamed.contacts.damping[k], norm2(renamed.contacts.spring[k])) << "each has kept its own";
    if (k == 0) continue;
    EXPECT_LT(std::pair(renamed.contacts.lower[k - 1], renamed.contacts.higher[k - 1]),
              std::pair(renamed.contacts.lower[k], renamed.contacts.higher[k]));
  }
  for (std::size_t i = 1; i < 200; ++i)
    EXPECT_LE(std::floor(renamed.grains.position[i - 1].x / scene.grains.diameter),
              std::floor(renamed.grains.position[i].x / scene.grains.diameter));
  packing.advance(bed.grains, bed.contacts);
  BedPacking(scene).advance(renamed.grains, renamed.contacts);
  double far = 0, fast = 0;
  for (std::size_t i = 0; i < 200; ++i) {   // sums in another order: not the same bits, the same motion
    const auto old = static_cast<std::size_t>(renamed.grains.travel[i]);
    far = std::max(far, norm(renamed.grains.velocity[i] - bed.grains.velocity[old]));
    fast = std::max(fast, norm(bed.grains.velocity[old]));
  }
  EXPECT_LE(far, 1e-9 * fast);
}

}   // namespace
}   // namespace bedload

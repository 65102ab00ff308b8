// Deep grains stand still, hold up those above, and wake as the bed over them goes.
#include "solver/bed/frozen_grains.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "solver/bed/bed_surface.hpp"
#include "solver/experiment.hpp"
#include "tests/support/scenes.hpp"

namespace bedload {
namespace {

constexpr double d = 0.5e-3, slow = 1e-3;
constexpr auto bottom = static_cast<std::uint32_t>(Wall::z_low);

/// Columns of four grains, one upon the other, 2 d x 2 d each, in a row along x.
struct Columns {
  explicit Columns(std::size_t count) {
    scene.length = {2 * d * static_cast<double>(count), 2 * d, 20 * d};
    scene.grains.diameter = d;
    grains.resize(4 * count);
    std::ranges::fill(grains.diameter, d);
    for (std::uint32_t c = 0; c < count; ++c)
      for (std::uint32_t n = 0; n < 4; ++n) {
        grains.position[4 * c + n] = {(2 * c + 1) * d, d, (n + 0.5) * d};
        if (n == 0) touch(4 * c, bottom, 0.5);
        if (n < 3) touch(4 * c + n, 4 * c + n + 1, n);
      }
    sort();
  }
  void touch(std::uint32_t lower, std::uint32_t higher, double spring) { pairs.push_back({lower, higher, spring}); }
  void sort() {
    std::ranges::sort(pairs, {}, [](const Pair& p) { return std::pair(p.lower, p.higher); });
    for (const Pair& p : pairs)
      contacts.lower.push_back(p.lower), contacts.higher.push_back(p.higher),
          contacts.spring.push_back({p.spring, 0, 0});
  }
  void freeze(double depth) { freeze_deep_grains(scene, depth, slow, grains, contacts, asleep); }
  std::vector<int> which_are_frozen() const { return {grains.fixed.begin(), grains.fixed.end()}; }

  struct Pair {
    std::uint32_t lower, higher;
    double spring;
  };
  std::vector<Pair> pairs;
  BedScene scene;
  Grains grains;
  ContactHistory contacts, asleep;
};

TEST(FrozenGrains, LieDeeperThanAskedForAndKeepWhatTheyRemember) {
  Columns one(1);
  const ContactHistory before = one.contacts;
  one.grains.velocity[0] = {1e-4, 0, 0};
  one.freeze(2 * d);   // the top stands at 4 d: centres at 0.5 and 1.5 d are deep, those at 2.5 and 3.5 d are not
  EXPECT_EQ(one.which_are_frozen(), (std::vector<int>{frozen, frozen, 0, 0}));
  EXPECT_EQ(norm(one.grains.velocity[0]), 0);
  EXPECT_EQ(one.contacts.lower, (std::vector<std::uint32_t>{1, 2})) << "what a grain that moves touches";
  EXPECT_EQ(one.asleep.higher, (std::vector<std::uint32_t>{1, bottom}));
  EXPECT_EQ(all_contacts(one.contacts, one.asleep), before);
  one.freeze(20 * d);
  EXPECT_EQ(one.which_are_frozen(), std::vector<int>(4, 0));
  EXPECT_EQ(one.contacts, before);
  EXPECT_EQ(one.asleep.size(), 0u);
}

/// A bed is packed dry, without rolling springs; what is awake gets both with the first wet step.
TEST(FrozenGrains, WakeWithoutWhatTheyNeverHad) {
  Columns one(1);
  one.freeze(2 * d);
  one.contacts.damping = {0.3, 0.4}, one.contacts.rolling = {{1, 0, 0}, {2, 0, 0}};
  thaw(one.grains, one.contacts, one.asleep);
  EXPECT_EQ(one.contacts.lower, (std::vector<std::uint32_t>{0, 0, 1, 2}));
  EXPECT_EQ(one.contacts.damping, (std::vector<double>{-1, -1, 0.3, 0.4})) << "-1: to be chosen";
  EXPECT_EQ(one.contacts.rolling, (std::vector<Vec3>{{}, {}, {1, 0, 0}, {2, 0, 0}}));
}

TEST(FrozenGrains, WakeAsTheBedBesideThemIsScoured) {
  Columns three(3);
  three.freeze(2 * d);
  EXPECT_EQ(std::ranges::count(three.grains.fixed, frozen), 6);
  for (const int top : {10, 11})
    three.grains.position[top] = {d, d, (top + 0.5 - 5) * d};   // two grains of the last column move onto the first
  three.freeze(2 * d);
  EXPECT_EQ(std::ranges::count(three.grains.fixed, frozen), 0) << "the hole is seen from the columns beside it";
}

TEST(FrozenGrains, AreNotBuriedByOneThatFliesPast) {
  Columns one(1);
  one.grains.position[3].z = 15 * d, one.grains.velocity[3] = {0.1, 0, 0};
  one.freeze(2 * d);   // the top at rest stands at 3 d
  EXPECT_EQ(one.which_are_frozen(), (std::vector<int>{frozen, 0, 0, 0}));
}

TEST(FrozenGrains, LeaveThoseAloneThatNeverMove) {
  Columns one(1);
  one.grains.fixed[0] = 1;
  one.freeze(2 * d);
  EXPECT_EQ(one.which_are_frozen(), (std::vector<int>{1, frozen, 0, 0}));
  thaw(one.grains, one.contacts, one.asleep);
  EXPECT_EQ(one.which_are_frozen(), (std::vector<int>{1, 0, 0, 0}));
}

Scene bed_scene(double frozen_depth) {
  Scene scene = test::fluid_scene({4, 3, 20}, {2 * d, 2 * d, 0.5 * d}, test::channel, 1e-5);
  scene.bed.gravity = {0, 0, -9.81};
  test::add_grains(scene, d, 2, 0.05);
  scene.bed.grains.friction = 0.4, scene.bed.grains.restitution = 0.6;
  scene.bed.source = {.kind = BedSource::Kind::poured, .count = 200, .seed = 3};
  scene.drive = {FlowRamp::Kind::lid, FlowRamp::Quantity::shields, {0.05}, 60 * scene.steps.fluid_interval};
  scene.onset.method = Onset::Method::none;
  scene.record.every = 10 * scene.steps.fluid_interval;
  scene.frozen_depth = frozen_depth;
  return scene;
}

/// Under a flow far below onset nothing is lost with the deep grains: they stay where they were, and so does the surface.
TEST(FrozenGrains, HoldUpTheBedThatLiesOnThem) {
  Experiment free(bed_scene(0)), deep(bed_scene(1.5 * d));
  State a = free.begin(), b = deep.begin();
  while (a.search.phase == Search::packing) free.step(a);
  while (b.search.phase == Search::packing) deep.step(b);
  const std::vector<Vec3> settled = b.grains.position;
  while (!Experiment::finished(a)) free.step(a);
  while (!Experiment::finished(b)) deep.step(b);
  const auto still = std::ranges::count(b.grains.fixed, frozen);
  EXPECT_GT(still, 60);
  EXPECT_LT(still, 190);
  for (std::size_t p = 0; p < settled.size(); ++p)
    EXPECT_TRUE(!b.grains.fixed[p] || b.grains.position[p] == settled[p]);
  EXPECT_NEAR(b.record.holds.bed_height[0], a.record.holds.bed_height[0], 0.01 * d);
  EXPECT_NEAR(b.record.holds.coordination[0], a.record.holds.coordination[0], 0.05);
  EXPECT_NEAR(b.record.holds.shields_measured[0], a.record.holds.shields_measured[0], 0.05 * 0.05)
      << "six grain times after it was imposed the flow in the pores, which grains that may not give way slow more, "
         "still settles";
  EXPECT_LT(b.record.holds.momentum_residual[0], 0) << "not known";
}

}   // namespace
}   // namespace bedload

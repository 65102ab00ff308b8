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

/// Stacks of four grains, one upon the other, side by side: nx along x, ny along y.
struct Columns {
  explicit Columns(std::uint32_t nx, std::uint32_t ny = 1) : ny_(ny) {
    scene.length = {d * nx, d * ny, 20 * d};
    scene.grains.diameter = d;
    grains.resize(4 * nx * ny);
    std::ranges::fill(grains.diameter, d);
    for (std::uint32_t c = 0; c < nx * ny; ++c)
      for (std::uint32_t n = 0; n < 4; ++n) {
        grains.position[4 * c + n] = {(c / ny + 0.5) * d, (c % ny + 0.5) * d, (n + 0.5) * d};
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
  /// The two upper grains of a stack are on their way elsewhere.
  void scour(std::uint32_t i, std::uint32_t j) {
    for (const int n : {2, 3}) grains.velocity[4 * (i * ny_ + j) + n] = {1, 0, 0};
  }
  long frozen_in(std::uint32_t i, std::uint32_t j) const {
    const auto first = grains.fixed.begin() + 4 * (i * ny_ + j);
    return std::count(first, first + 4, frozen);
  }
  std::vector<int> which_are_frozen() const { return {grains.fixed.begin(), grains.fixed.end()}; }

  struct Pair {
    std::uint32_t lower, higher;
    double spring;
  };
  std::vector<Pair> pairs;
  BedScene scene;
  Grains grains;
  ContactHistory contacts, asleep;

 private:
  std::uint32_t ny_;
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

/// A hole two diameters wide is seen from 2.5 diameters around it, across the seams of the box too, and from no farther.
TEST(FrozenGrains, WakeAsTheBedBesideThemIsScoured) {
  Columns field(12, 10);
  field.freeze(2 * d);
  EXPECT_EQ(std::ranges::count(field.grains.fixed, frozen), 2 * 120);
  for (const std::uint32_t i : {0u, 1u})
    for (const std::uint32_t j : {0u, 1u}) field.scour(i, j);
  field.freeze(2 * d);
  for (std::uint32_t i = 0; i < 12; ++i)
    for (std::uint32_t j = 0; j < 10; ++j) {
      const bool near = (i <= 3 || i >= 10) && (j <= 3 || j >= 8);
      EXPECT_EQ(field.frozen_in(i, j), near ? 0 : 2) << i << ' ' << j;
    }
}

TEST(FrozenGrains, DoNotTakeAPoreForAHole) {
  Columns field(6, 6);
  field.scour(2, 3);
  field.freeze(2 * d);
  EXPECT_EQ(std::ranges::count(field.grains.fixed, frozen), 2 * 36);
}

TEST(FrozenGrains, AreNotStoppedOnTheirWay) {
  Columns one(1);
  one.grains.velocity[1] = {0, 0, -10 * slow};
  one.freeze(2 * d);
  EXPECT_EQ(one.which_are_frozen(), (std::vector<int>{frozen, 0, 0, 0}));
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

/// What bore a grain before it was frozen bears it when it wakes: under hardly any flow none moves.
TEST(FrozenGrains, WakeWithoutAKick) {
  for (const bool added_mass : {false, true}) {
    Scene scene = bed_scene(1.5 * d);
    scene.drive.levels = {1e-6};
    scene.terms.added_mass = added_mass;
    Experiment deep(scene);
    State state = deep.begin();
    while (state.search.phase == Search::packing) deep.step(state);
    for (int n = 0; n < 15; ++n) deep.step(state);
    const long still = std::ranges::count(state.grains.fixed, frozen);
    ASSERT_GT(still, 40);
    const auto fastest = [&] {
      double speed = 0;
      for (const Vec3 v : state.grains.velocity) speed = std::max(speed, norm(v));
      return speed;
    };
    const double before = fastest();
    thaw(state.grains, state.contacts, state.asleep);
    deep.step(state);
    EXPECT_LT(fastest(), 1.5 * before + 1e-6) << "added mass " << added_mass;
  }
}

TEST(FrozenGrains, LeaveTheSurfaceItselfAwake) {
  const auto problems = problems_of(bed_scene(0.9 * d));
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].parameter, "models.frozen_depth");
  EXPECT_TRUE(problems_of(bed_scene(1.5 * d)).empty());
}

}   // namespace
}   // namespace bedload

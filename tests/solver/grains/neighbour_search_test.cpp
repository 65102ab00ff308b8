#include "solver/grains/neighbour_search.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "base/random_stream.hpp"
#include "tests/solver/grains/grain_scenes.hpp"

namespace bedload {
namespace {

struct Cloud {
  std::vector<Vec3> position;
  std::vector<double> reach;
  std::vector<std::uint8_t> fixed;
};

/// Random places, some a little outside the box; reaches from r to 5 r.
Cloud random_cloud(Vec3 length, std::size_t count, std::uint64_t seed) {
  Cloud cloud;
  RandomStream random(seed, Stream::grain_place);
  for (std::size_t i = 0; i < count; ++i) {
    Vec3 place;
    for (int c = 0; c < 3; ++c) place[c] = length[c] * (1.1 * random.uniform() - 0.05);
    cloud.position.push_back(place);
    cloud.reach.push_back(0.2e-3 * (1 + 4 * random.uniform()));
    cloud.fixed.push_back(random.uniform() < 0.3);
  }
  return cloud;
}

/// Every image of every pair.
PairList brute_force(const BedScene& scene, const Cloud& cloud) {
  PairList pairs;
  for (std::uint32_t i = 0; i < cloud.position.size(); ++i)
    for (std::uint32_t j = i + 1; j < cloud.position.size(); ++j) {
      if (cloud.fixed[i] && cloud.fixed[j]) continue;
      double nearest = 1e300;
      for (int a = -2; a <= 2; ++a)
        for (int b = -2; b <= 2; ++b)
          for (int c = -2; c <= 2; ++c) {
            const Vec3 image{a * scene.length.x, b * scene.length.y, c * scene.length.z};
            const bool allowed = (a == 0 || scene.sides[0] == Side::periodic) &&
                                 (b == 0 || scene.sides[1] == Side::periodic) &&
                                 (c == 0 || scene.sides[2] == Side::periodic);
            if (allowed) nearest = std::min(nearest, norm(cloud.position[j] - cloud.position[i] + image));
          }
      if (nearest < cloud.reach[i] + cloud.reach[j]) pairs.lower.push_back(i), pairs.higher.push_back(j);
    }
  return pairs;
}

TEST(NeighbourList, AgreesWithBruteForceInOrderWhateverTheSides) {
  for (const Vec3 length :
       {Vec3{12e-3, 9e-3, 7e-3}, Vec3{2.1e-3, 12e-3, 4e-3}, Vec3{4.5e-3, 2.2e-3, 6.6e-3}, Vec3{30e-3, 30e-3, 30e-3}})
    for (int sides = 0; sides < 8; ++sides) {
      BedScene scene = grain_scene(Side::wall, Side::wall);
      scene.length = length;
      for (int c = 0; c < 3; ++c) scene.sides[c] = sides >> c & 1 ? Side::periodic : Side::wall;
      const Cloud cloud = random_cloud(length, 150, static_cast<std::uint64_t>(sides) + 1);
      PairList found;
      find_near_pairs(PeriodicBox(scene), cloud.position, cloud.reach, cloud.fixed, found);
      const PairList expected = brute_force(scene, cloud);
      EXPECT_GT(expected.size(), 0u);
      EXPECT_EQ(found.lower, expected.lower);
      EXPECT_EQ(found.higher, expected.higher);
    }
}

TEST(NeighbourList, FindsNothingAmongNoneOrOne) {
  const BedScene scene = grain_scene(Side::periodic, Side::wall);
  const Cloud none, one = random_cloud(scene.length, 1, 1);
  PairList found;
  find_near_pairs(PeriodicBox(scene), none.position, none.reach, none.fixed, found);
  EXPECT_EQ(found.size(), 0u);
  find_near_pairs(PeriodicBox(scene), one.position, one.reach, one.fixed, found);
  EXPECT_EQ(found.size(), 0u);
}

TEST(NeighbourList, RefusesAPeriodicSideShorterThanTwoGrains) {
  BedScene scene = grain_scene(Side::periodic, Side::wall);
  scene.length.y = 1.9e-3;
  EXPECT_THROW(check_periodic_sides(PeriodicBox(scene), 1e-3), Error);
  scene.length.y = 2e-3;
  EXPECT_NO_THROW(check_periodic_sides(PeriodicBox(scene), 1e-3));
  scene.length.y = 1.9e-3, scene.sides[1] = Side::wall;
  EXPECT_NO_THROW(check_periodic_sides(PeriodicBox(scene), 1e-3));
}

TEST(NeighbourList, WrapsPlacesIntoTheBox) {
  const BedScene scene = grain_scene(Side::periodic, Side::wall);
  const PeriodicBox box(scene);
  const Vec3 inside = box.wrapped({-1e-20, 40e-3, 41e-3});
  EXPECT_GE(inside.x, 0);
  EXPECT_LT(inside.x, 40e-3);
  EXPECT_EQ(inside.y, 0);
  EXPECT_EQ(inside.z, 41e-3) << "a wall does not wrap";
}

}   // namespace
}   // namespace bedload

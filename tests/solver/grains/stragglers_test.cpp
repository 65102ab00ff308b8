#include "solver/grains/stragglers.hpp"

#include <gtest/gtest.h>

#include "tests/solver/grains/grain_scenes.hpp"

namespace bedload {
namespace {

constexpr double d = 1e-3;

/// A row of grains that overlap by a hundredth, in a periodic box; grain n stands n places along x.
Grains row(int count) {
  Grains grains;
  for (int n = 0; n < count; ++n) add_grain(grains, {(n + 0.5) * 0.99 * d, 20e-3, 20e-3}, {0, 0, 0.01 * n});
  return grains;
}

ContactHistory contacts_of_row(int count) {
  ContactHistory contacts;
  for (int n = 0; n + 1 < count; ++n) {
    contacts.lower.push_back(static_cast<std::uint32_t>(n)),
        contacts.higher.push_back(static_cast<std::uint32_t>(n + 1));
    contacts.spring.push_back({0, 0, 1e-9 * (n + 1)});
  }
  return contacts;
}

std::vector<std::uint8_t> only(std::size_t count, std::size_t awake) {
  std::vector<std::uint8_t> flags(count);
  flags[awake] = 1;
  return flags;
}

TEST(Stragglers, AreTakenWithTheirNeighboursFreeAndThoseOfTheseFixed) {
  Stragglers part;
  part.cut_out(grain_scene(Side::periodic, Side::wall), row(12), contacts_of_row(12), only(12, 5));
  ASSERT_EQ(part.grains.size(), 5u);   // 3 to 7
  EXPECT_EQ(part.grains.fixed, (std::vector<std::uint8_t>{1, 0, 0, 0, 1}));
  EXPECT_EQ(part.contacts.lower, (std::vector<std::uint32_t>{0, 1, 2, 3}));
  EXPECT_EQ(part.contacts.spring[0].z, 4e-9) << "that of grains 3 and 4";
}

TEST(Stragglers, PutBackUntouchedLeaveTheBedAsItWas) {
  Grains grains = row(12);
  ContactHistory contacts = contacts_of_row(12);
  contacts.lower.push_back(11), contacts.higher.push_back(static_cast<std::uint32_t>(Wall::z_low));
  contacts.spring.push_back({1e-9, 0, 0});
  const Grains before = grains;
  const ContactHistory contacts_before = contacts;
  for (std::size_t awake = 0; awake < 12; ++awake) {
    grains = before;
    Stragglers part;
    part.cut_out(grain_scene(Side::periodic, Side::wall), grains, contacts, only(12, awake));
    part.put_back(grains, contacts);
    EXPECT_EQ(grains.position, before.position);
    for (std::size_t n = 0; n < 12; ++n)
      EXPECT_EQ(grains.velocity[n].z, n + 1 < awake || n > awake + 1 ? 0 : before.velocity[n].z) << "rest if held";
    EXPECT_EQ(contacts, contacts_before);
  }
}

// Far from anything that is held fixed, a part moves as it does in its bed.
TEST(Stragglers, MoveAloneAsTheyDoInTheBedWhereNothingElseIsNear) {
  const BedScene scene = grain_scene(Side::periodic, Side::wall);
  Grains bed = row(12);
  for (std::size_t n = 0; n < 3; ++n) bed.position[n].y = 5e-3;   // three by themselves
  ContactHistory contacts = contacts_of_row(12);
  contacts.lower.erase(contacts.lower.begin() + 2), contacts.higher.erase(contacts.higher.begin() + 2);
  contacts.spring.erase(contacts.spring.begin() + 2);
  Grains alone = bed;
  ContactHistory contacts_alone = contacts;

  Stragglers part;
  part.cut_out(scene, alone, contacts_alone, only(12, 1));
  ASSERT_EQ(part.grains.size(), 3u);
  GrainDynamics of_bed(scene), of_part(scene);
  coast(of_bed, bed, contacts, scene.dem_step, 20);
  coast(of_part, part.grains, part.contacts, scene.dem_step, 20);
  part.put_back(alone, contacts_alone);
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(alone.position[n], bed.position[n]);
    EXPECT_EQ(alone.velocity[n], bed.velocity[n]);
    EXPECT_EQ(alone.mean_contact_force[n], bed.mean_contact_force[n]);
  }
  for (std::size_t k = 0; k < contacts_alone.size() && contacts_alone.lower[k] < 3; ++k)
    EXPECT_EQ(contacts_alone.spring[k], contacts.spring[k]);
  EXPECT_EQ(alone.position[7], row(12).position[7]) << "time stands still elsewhere";
}

TEST(Stragglers, GrainsThatTheBedHoldsFixedStayFixed) {
  Grains grains = row(5);
  grains.fixed[2] = 1;
  Stragglers part;
  part.cut_out(grain_scene(Side::periodic, Side::wall), grains, contacts_of_row(5), only(5, 1));
  EXPECT_EQ(part.grains.fixed[2], 1);
}

}   // namespace
}   // namespace bedload

#include "solver/grains/grain_dynamics.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "solver/grains/box_walls.hpp"
#include "tests/solver/grains/grain_scenes.hpp"

namespace bedload {
namespace {

TEST(GrainDynamics, FallFreelyWithGravity) {
  const BedScene scene = grain_scene(Side::periodic, Side::wall);
  Grains grains;
  add_grain(grains, {20e-3, 20e-3, 30e-3});
  GrainDynamics dynamics(scene);
  ContactHistory contacts;
  coast(dynamics, grains, contacts, 1e-5, 1000, {0, 0, -9.81});
  EXPECT_NEAR(grains.velocity[0].z, -9.81e-2, 1e-10 * 9.81e-2);
}

TEST(GrainDynamics, RelaxToTheTerminalSpeedOfLinearDrag) {
  const BedScene scene = grain_scene(Side::periodic, Side::wall);
  Grains grains;
  add_grain(grains, {20e-3, 20e-3, 30e-3});
  GrainDynamics dynamics(scene);
  ContactHistory contacts;
  const std::vector<Vec3> push{{0, 0, -9.81}};
  const std::vector<double> rate{1e7};   // a hundred times faster than the step: implicit, so harmless
  dynamics.advance(grains, contacts, {.push = push, .relaxation = rate}, 1e-5, 100, 0);
  EXPECT_NEAR(grains.velocity[0].z, -9.81e-7, 1e-6 * 9.81e-7);
}

TEST(GrainDynamics, TurnFasterByASpinPushAndAddedMassDoesNotHinderThat) {
  const BedScene scene = grain_scene(Side::periodic, Side::wall);
  Grains grains;
  add_grain(grains, {20e-3, 20e-3, 30e-3});
  add_grain(grains, {10e-3, 20e-3, 30e-3});
  grains.fixed[1] = 1;
  GrainDynamics dynamics(scene);
  ContactHistory contacts;
  const std::vector<Vec3> push(2), turn(2, Vec3{3, -2, 1});
  const std::vector<double> added{1e-6, 1e-6};
  dynamics.advance(grains, contacts, {.push = push, .spin_push = turn, .added_mass = added}, 1e-5, 1000, 0);
  EXPECT_LE(norm(grains.spin[0] - 1e-2 * turn[0]), 1e-12);
  EXPECT_EQ(grains.spin[1], Vec3{});
}

// m* of (m_1 + a_1, m_2 + a_2): the speeds after a head-on collision are those of the heavier bodies. Added mass may
// change from call to call, as it does with the packing of the grains.
TEST(GrainDynamics, CollideWithTheirAddedMassAndTheRestitutionAskedFor) {
  const BedScene scene = grain_scene(Side::wall, Side::wall);
  Grains grains;
  add_grain(grains, {19.49e-3, 20e-3, 20e-3}, {0.1, 0, 0});
  add_grain(grains, {20.51e-3, 20e-3, 20e-3});
  GrainDynamics dynamics(scene);
  ContactHistory contacts;
  const std::vector<Vec3> push(2);
  const double mass = mass_of(grains, 0), dt = scene.dem_step / 10;
  std::vector<double> added{0, 0};
  dynamics.advance(grains, contacts, {.push = push, .added_mass = added}, dt, 10, 0);
  added = {0.3 * mass, 1.1 * mass};   // the list was made without
  for (int n = 0; n < 300; ++n) dynamics.advance(grains, contacts, {.push = push, .added_mass = added}, dt, 10, 0);
  const double m1 = 1.3, m2 = 2.1, shared = m1 * 0.1 / (m1 + m2), e = scene.grains.restitution;
  EXPECT_NEAR(grains.velocity[0].x, shared - m2 / (m1 + m2) * e * 0.1, 0.001);
  EXPECT_NEAR(grains.velocity[1].x, shared + m1 / (m1 + m2) * e * 0.1, 0.001);
  EXPECT_NEAR(m1 * grains.velocity[0].x + m2 * grains.velocity[1].x, m1 * 0.1, 1e-15);
}

TEST(GrainDynamics, MeetWithTheAddedMassOfTheCallWhenTheListWasMadeWithout) {
  const BedScene scene = grain_scene(Side::wall, Side::wall);
  Grains grains;
  add_grain(grains, {19.5e-3, 20e-3, 20e-3}, {0.01, 0, 0}), add_grain(grains, {20.499e-3, 20e-3, 20e-3});
  const std::vector<Vec3> push(2);
  GrainDynamics kept(scene), made_anew(scene);
  ContactHistory contacts;
  kept.advance(grains, contacts, {.push = push, .added_mass = std::vector<double>{0, 0}}, scene.dem_step, 1, 0);
  Grains others = grains;
  ContactHistory their_contacts = contacts;
  ASSERT_EQ(contacts.size(), 1u);
  const std::vector<double> added{0.3 * mass_of(grains, 0), 1.1 * mass_of(grains, 0)};
  kept.advance(grains, contacts, {.push = push, .added_mass = added}, scene.dem_step, 1, 0);
  made_anew.advance(others, their_contacts, {.push = push, .added_mass = added}, scene.dem_step, 1, 0);
  EXPECT_EQ(grains.velocity, others.velocity);
}

TEST(GrainDynamics, BookTheMeanTorqueOfContacts) {
  const BedScene scene = grain_scene(Side::periodic, Side::wall);
  Grains grains;
  add_grain(grains, {20e-3, 20e-3, 0.49e-3}, {0.1, 0.05, 0});
  GrainDynamics dynamics(scene);
  ContactHistory contacts;
  const double dt = scene.dem_step, inertia = sphere_inertia(mass_of(grains, 0), 1e-3);
  coast(dynamics, grains, contacts, dt, 20);
  EXPECT_GT(grains.mean_contact_torque[0].y, 0);
  EXPECT_LT(grains.mean_contact_torque[0].x, 0);
  EXPECT_LE(norm(grains.mean_contact_torque[0] * (20 * dt / inertia) - grains.spin[0]), 1e-12 * norm(grains.spin[0]));
}

TEST(GrainDynamics, ConserveMomentumAmongCollidingGrains) {
  const BedScene scene = [] {
    BedScene s = grain_scene(Side::periodic, Side::periodic);
    s.length = {8e-3, 8e-3, 8e-3};
    return s;
  }();
  Grains grains = agitated_grains(scene, 120);
  std::ranges::fill(grains.fixed, 0);
  const Vec3 before = momentum(grains);
  double scale = 0;
  for (std::size_t i = 0; i < grains.size(); ++i) scale += mass_of(grains, i) * norm(grains.velocity[i]);
  GrainDynamics dynamics(scene);
  ContactHistory contacts;
  std::uint64_t met = 0;
  for (int n = 0; n < 200; ++n) met += coast(dynamics, grains, contacts, scene.dem_step, 10).contacts;
  EXPECT_GT(met, 100u);
  EXPECT_LE(norm(momentum(grains) - before), 1e-13 * scale);
}

TEST(GrainDynamics, ConserveAngularMomentumAmongUnequalSpinningGrains) {
  const BedScene scene = grain_scene(Side::wall, Side::wall);
  Grains grains;
  add_grain(grains, {20e-3, 20e-3, 20e-3}, {0.2, 0.05, 0}, 1e-3);
  add_grain(grains, {21.4e-3, 20.3e-3, 20.1e-3}, {-0.2, 0, 0.03}, 1.6e-3, 4000);
  add_grain(grains, {20.2e-3, 21.1e-3, 20.4e-3}, {0, -0.3, -0.1}, 0.7e-3);
  grains.spin = {{300, -100, 50}, {0, 80, -20}, {-500, 10, 900}};
  const Vec3 before = angular_momentum(grains);
  GrainDynamics dynamics(scene);
  ContactHistory contacts;
  std::uint64_t met = 0;
  for (int n = 0; n < 100; ++n) met += coast(dynamics, grains, contacts, scene.dem_step, 10).contacts;
  EXPECT_GT(met, 1u);
  // Lever arms and torques are rounded to float, forces act on both grains alike.
  EXPECT_LE(norm(angular_momentum(grains) - before), 0x1p-24 * norm(before));
}

TEST(GrainDynamics, TellTheDeepestOverlapPerDiameterOfTheSmallerGrain) {
  const BedScene scene = grain_scene(Side::wall, Side::wall);
  Grains grains;   // the overlap of 30 um is deeper in itself, that of 15 um per diameter of its smaller grain
  add_grain(grains, {10e-3, 10e-3, 10e-3}, {}, 2e-3), add_grain(grains, {10e-3 + 1.97e-3, 10e-3, 10e-3}, {}, 2e-3);
  add_grain(grains, {20e-3, 20e-3, 20e-3}, {}, 2e-3), add_grain(grains, {20e-3 + 1.185e-3, 20e-3, 20e-3}, {}, 0.4e-3);
  ContactHistory contacts;
  GrainDynamics dynamics(scene);
  EXPECT_NEAR(coast(dynamics, grains, contacts, scene.dem_step, 1).deepest_overlap, 15e-6 / 0.4e-3, 1e-6);
}

TEST(GrainDynamics, TellTheDeepestOverlapWhicheverPairHasIt) {
  const BedScene scene = grain_scene(Side::wall, Side::wall);
  constexpr int pairs = 21;
  for (int deepest = 0; deepest < pairs; ++deepest) {
    Grains grains;
    for (int k = 0; k < pairs; ++k) {
      const double y = 1e-3 + 1.5e-3 * k, overlap = k == deepest ? 20e-6 : 10e-6;
      add_grain(grains, {10e-3, y, 10e-3}, {}, 1e-3), add_grain(grains, {11e-3 - overlap, y, 10e-3}, {}, 1e-3);
    }
    ContactHistory contacts;
    GrainDynamics dynamics(scene);
    const GrainHealth health = coast(dynamics, grains, contacts, 1e-3 * scene.dem_step, 1);
    EXPECT_EQ(health.contacts, pairs);
    EXPECT_NEAR(health.deepest_overlap, 0.02, 1e-6) << deepest;
  }
}

TEST(GrainDynamics, NeverMoveAFixedGrain) {
  BedScene scene = grain_scene(Side::periodic, Side::wall);
  scene.length = {8e-3, 8e-3, 8e-3};
  Grains grains = agitated_grains(scene, 120);
  const Grains before = grains;
  GrainDynamics dynamics(scene);
  ContactHistory contacts;
  bool pushed = false;
  for (int n = 0; n < 50; ++n) {
    coast(dynamics, grains, contacts, scene.dem_step, 10, {0, 0, -9.81});
    for (std::size_t i = 0; i < grains.size(); i += 10) pushed = pushed || norm(grains.mean_contact_force[i]) > 0;
  }
  EXPECT_TRUE(pushed) << "the contacts of fixed grains are booked";
  for (std::size_t i = 0; i < grains.size(); i += 10) {
    EXPECT_EQ(grains.position[i], before.position[i]);
    EXPECT_EQ(grains.velocity[i], Vec3{});
    EXPECT_EQ(grains.spin[i], Vec3{});
  }
}

/// What a run of 200 x 10 steps under a strong pull ends in, with something done to the dynamics between its calls.
template <class Meddle>
std::pair<Grains, ContactHistory> agitate(const BedScene& scene, ContactTerms terms, Meddle&& meddle) {
  Grains grains = agitated_grains(scene, 170);
  ContactHistory contacts;
  auto dynamics = std::make_unique<GrainDynamics>(scene, terms);
  const PeriodicBox box(scene);
  for (int n = 0; n < 200; ++n) {
    coast(*dynamics, grains, contacts, scene.dem_step, 10, {3, 0, -30});
    for (Vec3& place : grains.position) place = box.wrapped(place);
    meddle(dynamics);
  }
  return {grains, contacts};
}

TEST(GrainDynamics, GiveTheSameBitsWheneverTheirListsAreMade) {
  BedScene scene = grain_scene(Side::periodic, Side::wall);
  scene.length = {8e-3, 8e-3, 10e-3};
  scene.fluid.viscosity = 1e-5;
  for (const double rolling : {0.0, 0.2})
    for (const ContactTerms terms : all_contact_terms) {
      if (rolling == 0 && (terms.wet_restitution || terms.lubrication)) continue;
      scene.grains.rolling_friction = rolling;
      const auto straight = agitate(scene, terms, [](auto&) {});
      const auto amnesic = agitate(scene, terms, [](auto& dynamics) { dynamics->forget(); });
      int call = 0;
      const auto replaced = agitate(scene, terms, [&](auto& dynamics) {
        if (++call % 60 == 0) dynamics = std::make_unique<GrainDynamics>(scene, terms);
      });
      EXPECT_GT(straight.second.size(), 100u);
      EXPECT_EQ(straight.second.damping.size(), terms.wet_restitution ? straight.second.size() : 0);
      EXPECT_EQ(straight.second.rolling.size(), rolling > 0 ? straight.second.size() : 0);
      EXPECT_TRUE(straight == amnesic);
      EXPECT_TRUE(straight == replaced);
    }
}

TEST(GrainDynamics, GiveTheSameBitsInOneCallOrMany) {
  BedScene scene = grain_scene(Side::periodic, Side::wall);
  scene.length = {8e-3, 8e-3, 10e-3};
  scene.grains.rolling_friction = 0.1;
  for (const ContactTerms terms : all_contact_terms) {
    Grains together = agitated_grains(scene, 170), apart = together;
    ContactHistory contacts_together, contacts_apart;
    GrainDynamics one(scene, terms), many(scene, terms);
    coast(one, together, contacts_together, scene.dem_step, 300);
    for (int n = 0; n < 300; ++n) coast(many, apart, contacts_apart, scene.dem_step), many.forget();
    EXPECT_TRUE(together.position == apart.position && together.velocity == apart.velocity &&
                together.spin == apart.spin);
    EXPECT_TRUE(contacts_together == contacts_apart);
  }
}

TEST(GrainDynamics, CollideAcrossAPeriodicSeamAsAnywhereElse) {
  const BedScene scene = grain_scene(Side::periodic, Side::periodic);
  Grains middle, seam;
  const Vec3 a{-0.52e-3, 0.1e-3, 0}, b{0.52e-3, -0.1e-3, 0.05e-3}, centre{20e-3, 20e-3, 20e-3};
  for (auto* grains : {&middle, &seam}) {
    const Vec3 origin = grains == &middle ? centre : Vec3{};
    add_grain(*grains, PeriodicBox(scene).wrapped(origin + a), {0.2, 0, 0.01});
    add_grain(*grains, PeriodicBox(scene).wrapped(origin + b), {-0.2, 0, 0});
  }
  GrainDynamics dynamics(scene), across(scene);
  ContactHistory contacts, contacts_across;
  for (int n = 0; n < 40; ++n) {
    coast(dynamics, middle, contacts, scene.dem_step, 10);
    coast(across, seam, contacts_across, scene.dem_step, 10);
    for (Vec3& place : seam.position) place = PeriodicBox(scene).wrapped(place);
  }
  EXPECT_LT(middle.velocity[0].x, 0) << "they have met";
  for (int i = 0; i < 2; ++i) EXPECT_LE(norm(middle.velocity[i] - seam.velocity[i]), 1e-9);
}

TEST(GrainDynamics, RestOnTheFloorWithTheirWeight) {
  const BedScene scene = grain_scene(Side::periodic, Side::wall);
  Grains grains;
  add_grain(grains, {20e-3, 20e-3, 0.5e-3});
  GrainDynamics dynamics(scene);
  ContactHistory contacts;
  GrainHealth health;
  for (int n = 0; n < 500; ++n) health = coast(dynamics, grains, contacts, scene.dem_step, 10, {0, 0, -9.81});
  const double weight = 9.81 * mass_of(grains, 0);
  EXPECT_NEAR(health.force_on_walls.z, -weight, 1e-6 * weight);
  EXPECT_NEAR(grains.mean_contact_force[0].z, weight, 1e-6 * weight);
  EXPECT_EQ(health.contacts, 1u);
  EXPECT_EQ(contacts.higher[0], static_cast<std::uint32_t>(Wall::z_low));
  // Hertz: F = 4/3 Y* sqrt(R) depth^3/2
  EXPECT_NEAR(health.deepest_overlap * 1e-3, std::pow(weight * 0.75 * 2 * 0.91 / 1e6 / std::sqrt(0.5e-3), 2.0 / 3),
              1e-9);
}

TEST(GrainDynamics, RollOnTheFloorAboutTheMiddleOfTheOverlap) {
  // Grain and wall are of one material and give way alike: what rolls without sliding turns at v/(r - depth/2).
  const BedScene scene = grain_scene(Side::periodic, Side::wall);
  Grains grains;
  add_grain(grains, {20e-3, 20e-3, 0.48e-3}, {0.1, 0, 0});
  GrainDynamics dynamics(scene);
  ContactHistory contacts;
  double overlap = 0;   // 2 % of the diameter under a hundredfold weight
  for (int n = 0; n < 500; ++n)
    overlap = coast(dynamics, grains, contacts, scene.dem_step, 10, {0, 0, -981}).deepest_overlap * 1e-3;
  EXPECT_GT(overlap, 0.015e-3);
  EXPECT_NEAR(grains.velocity[0].x / (grains.spin[0].y * (0.5e-3 - overlap / 2)), 1, 1e-4);
}

TEST(GrainDynamics, AreDraggedByALidButNotByAFreeSurface) {
  BedScene scene = grain_scene(Side::periodic, Side::wall);
  for (const Top top : {Top::lid, Top::free_slip}) {
    scene.top = top;
    Grains grains;
    add_grain(grains, {20e-3, 20e-3, 39.5e-3});
    GrainDynamics dynamics(scene);
    ContactHistory contacts;
    const std::vector<Vec3> upward{{0, 0, 9.81}};
    const auto health = dynamics.advance(grains, contacts, {.push = upward}, scene.dem_step, 200, 0.1);
    EXPECT_GT(health.force_on_walls.z, 0);
    if (top == Top::lid) {
      EXPECT_GT(grains.velocity[0].x, 0.001);
      EXPECT_LT(health.force_on_walls.x, 0);
    } else {
      EXPECT_EQ(grains.velocity[0].x, 0);
    }
  }
}

/// Runs grains in a closed box without a source of energy; the most that they have at any time, per that at the start.
double most_energy(const BedScene& scene, ContactTerms terms, Grains grains, double dt) {
  const double before = kinetic_energy(grains);
  GrainDynamics dynamics(scene, terms);
  ContactHistory contacts;
  double most = 0, deepest = 0;
  for (int n = 0; n < 150; ++n) {
    deepest = std::max(deepest, coast(dynamics, grains, contacts, dt, 10).deepest_overlap);
    most = std::max(most, kinetic_energy(grains));
  }
  EXPECT_LT(deepest, 0.2);
  return most / before;
}

TEST(GrainDynamics, KeepTheirEnergyInElasticCollisionsWithoutFriction) {
  BedScene scene = grain_scene(Side::wall, Side::wall);
  scene.length = {6e-3, 6e-3, 10e-3};
  scene.grains.friction = 0, scene.grains.restitution = 1;
  Grains grains = agitated_grains(scene, 100);
  const double before = kinetic_energy(grains);
  GrainDynamics dynamics(scene);
  ContactHistory contacts;
  coast(dynamics, grains, contacts, 0.3 * rayleigh_time(0.6e-3, 2500, 1e6, 0.3), 5000);
  EXPECT_NEAR(kinetic_energy(grains), before, 0.05 * before);
}

TEST(GrainDynamics, MakeNoEnergyAtExtremeFrictionAndRestitution) {
  BedScene scene = grain_scene(Side::wall, Side::wall);
  scene.length = {6e-3, 6e-3, 10e-3};
  const double dt = 0.3 * rayleigh_time(0.6e-3, 2500, 1e6, 0.3);
  for (const ContactTerms terms : all_contact_terms)
    for (const double friction : {0.0, 1.0})
      for (const double restitution : {0.0, 1.0}) {
        scene.grains.friction = scene.grains.rolling_friction = friction, scene.grains.restitution = restitution;
        EXPECT_LE(most_energy(scene, terms, agitated_grains(scene, 100), dt), 1.01) << friction << " " << restitution;
      }
}

TEST(GrainDynamics, MakeNoEnergyAmongGrainsOneOfWhichIsFiveTimesTheOther) {
  BedScene scene = grain_scene(Side::wall, Side::wall);
  scene.length = {6e-3, 6e-3, 6e-3};
  Grains grains;
  for (int n = 0; n < 8; ++n)
    add_grain(grains, 1e-3 * Vec3{1.5 + 3 * (n % 2), 1.5 + 3 * (n / 2 % 2), 1.5 + 3.0 * (n / 4)},
              0.1 * Vec3{std::sin(n), std::cos(n), 0.3}, 2.5e-3);
  for (int n = 0; n < 100; ++n)   // in the planes between the large ones
    add_grain(grains, 1e-3 * Vec3{0.4 + 0.58 * (n % 10), 0.4 + 0.58 * (n / 10), 3.0},
              0.3 * Vec3{std::sin(3 * n), std::cos(5 * n), std::sin(7 * n)}, 0.5e-3);
  const double dt = 0.3 * rayleigh_time(0.5e-3, 2500, 1e6, 0.3);
  for (const ContactTerms terms : all_contact_terms)
    for (const double friction : {0.0, 1.0})
      for (const double restitution : {0.0, 1.0}) {
        scene.grains.friction = friction, scene.grains.rolling_friction = 0.3 * friction;
        scene.grains.restitution = restitution;
        EXPECT_LE(most_energy(scene, terms, grains, dt), 1.01) << friction << " " << restitution;
      }
}

TEST(GrainDynamics, RefuseAPeriodicBoxNarrowerThanTwoGrains) {
  BedScene scene = grain_scene(Side::periodic, Side::wall);
  scene.length.x = 1.5e-3;
  Grains grains;
  add_grain(grains, {1e-3, 20e-3, 20e-3});
  GrainDynamics dynamics(scene);
  ContactHistory contacts;
  EXPECT_THROW(coast(dynamics, grains, contacts, scene.dem_step), Error);
}

TEST(GrainDynamics, DoNothingWithoutGrains) {
  GrainDynamics dynamics(grain_scene(Side::periodic, Side::wall));
  Grains grains;
  ContactHistory contacts;
  EXPECT_EQ(coast(dynamics, grains, contacts, 1e-5, 10).contacts, 0u);
}

}   // namespace
}   // namespace bedload

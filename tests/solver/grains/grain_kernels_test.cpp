// The kernels against a plain loop over the same law, contact by contact: the same bits.
#include <gtest/gtest.h>

#include <memory>

#include "base/random_stream.hpp"
#include "solver/grains/contact_forces.hpp"
#include "tests/solver/grains/grain_scenes.hpp"

namespace bedload {
namespace {

std::vector<const GrainKernels*> kernels_here() {
  std::vector<const GrainKernels*> all{&grain_kernels_v3};
  if (runs_v4()) all.push_back(&grain_kernels_v4);
  return all;
}

/// Grains of several sizes that overlap or nearly do, in a periodic box, in motion; springs everywhere.
struct Crowd {
  explicit Crowd(bool in_liquid) : scene(grain_scene(Side::periodic, Side::wall)), wet(scene.fluid, 0.7) {
    scene.length = {6e-3, 5e-3, 4e-3};
    RandomStream random(7, Stream::grain_place);
    const auto any = [&](double scale) {
      Vec3 v;
      for (int c = 0; c < 3; ++c) v[c] = scale * (2 * random.uniform() - 1);
      return v;
    };
    for (int n = 0; n < 333; ++n) {
      const double r = 0.4e-3 * (1 + 0.2 * random.uniform()), mass = 2500 * sphere_volume(2 * r);
      Vec3 place;
      for (int c = 0; c < 3; ++c) place[c] = scene.length[c] * random.uniform();
      const Vec3 v = any(0.1), w = any(200);
      bodies.spheres.push_back(sphere_of(place, r, v, w));
      const bool fixed = n % 10 == 0;
      bodies.motions.push_back({v, fixed ? 0 : 1 / mass, w, fixed ? 0 : 1 / sphere_inertia(mass, 2 * r)});
      push.push_back({any(10), 1 - 0.1 * random.uniform()});
    }
    list = std::make_unique<NeighbourList>(scene, in_liquid ? &wet : nullptr, false);
    list->rebuild(bodies, scene.dem_step, {});
    for (PairBlock& b : list->pairs.blocks)
      for (std::size_t k = 0; k < PairBlock::pairs; ++k) {
        b.spring_x[k] = static_cast<float>(1e-6 * random.uniform());
        b.spring_z[k] = static_cast<float>(-1e-6 * random.uniform());
      }
    for (WetBlock& b : list->pairs.wet_blocks)
      for (float& alpha : b.damping)
        if (random.uniform() < 0.5) alpha = 0.3f;   // else a contact that begins
  }

  PairPass pass() { return pair_pass(law, list->wet() ? &wet : nullptr, bodies, scene.dem_step, *list); }
  SumPass sums() { return sum_pass(bodies, *list); }

  BedScene scene;
  WetRestitution wet;
  HertzMindlin law{scene.grains};
  Bodies bodies;
  std::vector<Push> push;
  std::unique_ptr<NeighbourList> list;
};

Vector<float> components(const float (&v)[3]) { return {v[0], v[1], v[2]}; }

/// One pair, without a register in sight.
void meet_plainly(const PairPass& p, const PeriodicBox& box, std::size_t pair, ContactLoad& load) {
  PairBlock& b = p.blocks[pair / PairBlock::pairs];
  const std::size_t k = pair % PairBlock::pairs;
  const Sphere &i = p.spheres[b.lower[k]], &j = p.spheres[b.higher[k]];
  const Vec3 d = box.shortest(j.position - i.position);
  const auto real = [](double x) { return static_cast<float>(x); };
  const Vector<float> apart{real(d.x), real(d.y), real(d.z)};
  const float distance = root(dot(apart, apart));
  OverlapOf<float> o;
  o.depth = real(b.radius_sum[k] * b.radius_sum[k] - norm2(d)) / (real(b.radius_sum[k]) + distance);
  o.root_radius = b.root_radius[k], o.mass = b.mass[k];
  o.normal = (1 / distance) * apart;
  const float arm = distance * b.inverse_radius_sum[k];
  o.velocity = components(i.velocity) - components(j.velocity) +
               arm * cross(components(i.surface_velocity) + components(j.surface_velocity), o.normal);
  DampingOf<float> damping = p.damping;
  if (p.wet_blocks) {
    WetBlock& wet = p.wet_blocks[pair / PairBlock::pairs];
    float& alpha = wet.damping[k];
    if (!(o.depth > 0)) alpha = -1;
    else if (alpha < 0) alpha = real(p.wet.damping(wet.viscous_speed[k], dot(o.velocity, o.normal)));
    const float strongest = real(strongest_shear_damping);
    damping = {alpha, p.root_shear_ratio * (strongest / std::max(alpha, strongest))};
  }
  const auto r = hertz_mindlin(p.material, o, {b.spring_x[k], b.spring_y[k], b.spring_z[k]}, p.dt, damping);
  const Vector<float> torque = arm * cross(o.normal, r.force);
  b.depth[k] = o.depth, b.spring_x[k] = r.spring.x, b.spring_y[k] = r.spring.y, b.spring_z[k] = r.spring.z;
  load = {{r.force.x, r.force.y, r.force.z}, 0, {torque.x, torque.y, torque.z}, 0};
}

TEST(GrainKernels, GiveTheBitsOfAPlainLoopOverTheLaw) {
  for (const bool in_liquid : {false, true})
    for (const GrainKernels* kernels : kernels_here()) {
      Crowd crowd(in_liquid), plain(in_liquid);
      const std::size_t n = crowd.list->pairs.size();
      ASSERT_GT(n, 300u);
      std::size_t touching = 0;
      for (int step = 0; step < 3; ++step) {   // springs and dampings of one step are met by the next
        kernels->meet(crowd.pass(), 0, crowd.list->pairs.blocks.size());
        const PairPass pass = plain.pass();
        for (std::size_t k = 0; k < n; ++k) meet_plainly(pass, plain.list->box(), k, plain.list->loads.load[k]);
        for (std::size_t k = 0; k < n; ++k) {
          const PairBlock &a = crowd.list->pairs.blocks[k / PairBlock::pairs],
                          &b = plain.list->pairs.blocks[k / PairBlock::pairs];
          const std::size_t at = k % PairBlock::pairs;
          touching += a.depth[at] > 0;
          ASSERT_EQ(a.depth[at], b.depth[at]) << kernels->instructions << " pair " << k;
          ASSERT_EQ(a.spring_x[at], b.spring_x[at]) << kernels->instructions << " pair " << k;
          ASSERT_EQ(a.spring_y[at], b.spring_y[at]) << kernels->instructions << " pair " << k;
          ASSERT_EQ(a.spring_z[at], b.spring_z[at]) << kernels->instructions << " pair " << k;
          if (in_liquid) {
            ASSERT_EQ(crowd.list->pairs.damping(k), plain.list->pairs.damping(k))
                << kernels->instructions << " pair " << k;
          }
          for (int c = 0; c < 3; ++c) {
            ASSERT_EQ(crowd.list->loads.load[k].force[c], plain.list->loads.load[k].force[c]) << kernels->instructions;
            ASSERT_EQ(crowd.list->loads.load[k].torque_per_radius[c], plain.list->loads.load[k].torque_per_radius[c])
                << kernels->instructions;
          }
        }
      }
      EXPECT_GT(touching, n / 4) << "nothing was tested";
    }
}

TEST(GrainKernels, AddUpEveryContactInTheOrderOfPartners) {
  for (const GrainKernels* kernels : kernels_here()) {
    Crowd crowd(false);
    kernels->meet(crowd.pass(), 0, crowd.list->pairs.blocks.size());
    const std::size_t n = crowd.bodies.size();
    std::vector<Vec3> as_higher(n), as_lower(n), turn_as_higher(n), turn_as_lower(n);
    std::size_t most = 0;
    std::vector<std::size_t> count(n, 0);
    const auto in_double = [](const float(&v)[3]) { return Vec3{v[0], v[1], v[2]}; };
    for (std::size_t k = 0; k < crowd.list->pairs.size(); ++k) {
      const auto i = crowd.list->pairs.ids.lower[k], j = crowd.list->pairs.ids.higher[k];
      const ContactLoad& load = crowd.list->loads.load[k];
      as_lower[i] += in_double(load.force), turn_as_lower[i] += in_double(load.torque_per_radius);
      as_higher[j] += in_double(load.force), turn_as_higher[j] += in_double(load.torque_per_radius);
      most = std::max(most, ++count[i]);
    }
    ASSERT_GT(most, ContactPlaces::direct) << "no grain needs further places";
    std::vector<Load> loads(n);
    SumPass sums = crowd.sums();
    for (std::size_t first = 0; first < n; first += 100)   // in stretches, as a step does
      kernels->add_up(sums, first, std::min(n, first + 100), &loads[first]);
    for (std::size_t i = 0; i < n; ++i) {
      ASSERT_EQ(loads[i].force, as_lower[i] - as_higher[i]) << kernels->instructions << " grain " << i;
      ASSERT_EQ(loads[i].torque, crowd.bodies.spheres[i].radius * (turn_as_lower[i] + turn_as_higher[i]));
    }
  }
}

/// A channel of touching grains, numbered along it, so long that loads wait in a short ring; its two ends are neighbours.
Bodies long_channel(BedScene& scene) {
  scene = grain_scene(Side::periodic, Side::wall);
  scene.sides = {Side::periodic, Side::periodic, Side::wall};
  const double d = 1e-3, apart = 0.98 * d, mass = 2500 * sphere_volume(d);
  const int along = 600, across = 10, up = 5;
  scene.length = {along * apart, across * apart, up * apart};
  RandomStream random(3, Stream::grain_place);
  const auto any = [&](double scale) { return scale * (2 * random.uniform() - 1); };
  Bodies bodies;
  for (int i = 0; i < along; ++i)
    for (int j = 0; j < across; ++j)
      for (int k = 0; k < up; ++k) {
        const Vec3 place{(i + 0.5 + any(0.01)) * apart, (j + 0.5 + any(0.01)) * apart, (k + 0.5) * apart};
        const Vec3 v{any(0.1), any(0.1), any(0.1)}, w{any(200), any(200), any(200)};
        bodies.spheres.push_back(sphere_of(place, 0.5 * d, v, w));
        bodies.motions.push_back({v, 1 / mass, w, 1 / sphere_inertia(mass, d)});
      }
  return bodies;
}

/// What every grain gets through a ring, and what all loads together give it.
void expect_the_ring_to_lose_nothing(const BedScene& scene, const Bodies& bodies, NeighbourList& ring) {
  const HertzMindlin law(scene.grains);
  const std::size_t n = bodies.size();
  const GrainKernels& kernels = grain_kernels();
  NeighbourList whole(scene, nullptr, false);
  whole.rebuild(bodies, scene.dem_step, {});
  ASSERT_LT(ring.loads.ring_blocks, whole.pairs.blocks.size() / 2) << "no ring was tested";
  ASSERT_FALSE(ring.loads.far.empty()) << "no far pair was tested";
  std::vector<Load> by_turns(n), together(n);
  for (int step = 0; step < 2; ++step) {   // the second finds the loads of the first
    meet_walls(law, law, nullptr, bodies, scene.dem_step, 0, ring);
    meet_walls(law, law, nullptr, bodies, scene.dem_step, 0, whole);
    PairWave wave(kernels, pair_pass(law, nullptr, bodies, scene.dem_step, ring), ring);
    SumPass sums = sum_pass(bodies, ring), all_sums = sum_pass(bodies, whole);
    for (std::size_t first = 0; first < n; first += grains_at_once) {
      const std::size_t last = std::min(n, first + grains_at_once);
      wave.meet_below(last);
      kernels.add_up(sums, first, last, &by_turns[first]);
    }
    kernels.meet(pair_pass(law, nullptr, bodies, scene.dem_step, whole), 0, whole.pairs.blocks.size());
    kernels.add_up(all_sums, 0, n, together.data());
    for (std::size_t i = 0; i < n; ++i) {
      ASSERT_NE(together[i].force, Vec3{}) << i;
      ASSERT_EQ(by_turns[i].force, together[i].force) << i;
      ASSERT_EQ(by_turns[i].torque, together[i].torque) << i;
    }
  }
}

TEST(NeighbourList, AShortRingOfLoadsGivesEveryGrainWhatAllLoadsTogetherGive) {
  BedScene scene;
  const Bodies bodies = long_channel(scene);
  NeighbourList ring(scene, nullptr, false, grains_at_once);
  ring.rebuild(bodies, scene.dem_step, {});
  expect_the_ring_to_lose_nothing(scene, bodies, ring);
}

// Two dozen boulders, first in the numbering, have more pairs among the pebbles than the ring has places.
TEST(NeighbourList, AShortRingServesASliceThatHasMorePairsThanItHolds) {
  BedScene scene;
  const Bodies pebbles = long_channel(scene);
  Bodies bodies;
  const double r = 2e-3, mass = 2500 * sphere_volume(2 * r);
  for (int i = 0; i < 24; ++i) {
    const Vec3 place{(i + 0.5) / 24 * scene.length.x, 0.5 * scene.length.y, 0.5 * scene.length.z};
    bodies.spheres.push_back(sphere_of(place, r, {0.01 * i, 0, 0}, {}));
    bodies.motions.push_back({{0.01 * i, 0, 0}, 1 / mass, {}, 1 / sphere_inertia(mass, 2 * r)});
  }
  bodies.spheres.insert(bodies.spheres.end(), pebbles.spheres.begin(), pebbles.spheres.end());
  bodies.motions.insert(bodies.motions.end(), pebbles.motions.begin(), pebbles.motions.end());
  NeighbourList ring(scene, nullptr, false, grains_at_once);
  ring.rebuild(bodies, scene.dem_step, {});
  ASSERT_GT(ring.blocks_of_grains_below(grains_at_once), ring.loads.ring_blocks) << "the slice fits";
  expect_the_ring_to_lose_nothing(scene, bodies, ring);
}

TEST(GrainKernels, MoveGrainsByNewtonsLaws) {
  for (const GrainKernels* kernels : kernels_here()) {
    Crowd crowd(false), before(false);
    const std::size_t n = crowd.bodies.size();
    const double dt = 1e-5;
    std::vector<Load> loads(n);
    std::vector<LoadSum> sums(n, {{1, 2, 3}, {4, 5, 6}});
    std::vector<Vec3> spin_push(n);
    std::vector<double> inverse_skin(n, 1 / 1e-5);
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3 f = 1e-6 * crowd.push[i].acceleration;
      loads[i].force = f, loads[i].torque = {1e-9 * f.y, -1e-9 * f.x, 2e-9 * f.z}, spin_push[i] = {f.z, f.x, f.y};
    }
    MotionPass pass{crowd.bodies.spheres.data(),
                    crowd.bodies.motions.data(),
                    crowd.push.data(),
                    spin_push.data(),
                    inverse_skin.data(),
                    sums.data(),
                    true,
                    dt};
    const double fastest = kernels->move(pass, 0, n, loads.data());
    for (std::size_t i = 0; i < n; ++i) {
      const Motion &was = before.bodies.motions[i], &is = crowd.bodies.motions[i];
      const Sphere &stood = before.bodies.spheres[i], &stands = crowd.bodies.spheres[i];
      ASSERT_EQ(sums[i].force, loads[i].force);
      ASSERT_EQ(sums[i].torque, loads[i].torque);
      ASSERT_EQ(is.inverse_mass, was.inverse_mass);
      ASSERT_EQ(is.inverse_inertia, was.inverse_inertia);
      ASSERT_EQ(stands.radius, stood.radius);
      if (was.inverse_mass == 0) {
        ASSERT_EQ(stands.position, stood.position);
        ASSERT_EQ(is.velocity, was.velocity);
        ASSERT_EQ(is.spin, was.spin);
        continue;
      }
      const Vec3 v =
          crowd.push[i].damp * (was.velocity + dt * (crowd.push[i].acceleration + was.inverse_mass * loads[i].force));
      ASSERT_EQ(is.velocity, v);
      ASSERT_EQ(is.spin, was.spin + dt * was.inverse_inertia * loads[i].torque + dt * spin_push[i]);
      ASSERT_EQ(stands.position, stood.position + dt * v);
      ASSERT_GE(fastest, norm2(v) * 1e10 * (1 - 1e-12));
      for (int c = 0; c < 3; ++c) {
        ASSERT_EQ(stands.velocity[c], static_cast<float>(v[c]));
        ASSERT_EQ(stands.surface_velocity[c], static_cast<float>(stands.radius * is.spin[c]));
      }
    }
    pass.begins_sums = false;
    kernels->move(pass, 0, n, loads.data());
    for (std::size_t i = 0; i < n; ++i) {
      ASSERT_EQ(sums[i].force, 2 * loads[i].force);
      ASSERT_EQ(sums[i].torque, 2 * loads[i].torque);
    }
  }
}

TEST(GrainKernels, AgreeOverFiveHundredStepsOfAStirredBed) {
  if (!runs_v4()) GTEST_SKIP() << "this processor has no AVX-512";
  for (const ContactTerms terms : all_contact_terms) {
    const auto stir = [&](const GrainKernels& kernels) {
      Crowd crowd(false);
      Grains grains;
      for (std::size_t i = 0; i < crowd.bodies.size(); ++i)
        if (i % 3 == 0)
          add_grain(grains, crowd.bodies.spheres[i].position, crowd.bodies.motions[i].velocity,
                    2 * crowd.bodies.spheres[i].radius);
      const std::vector<Vec3> push(grains.size(), Vec3{1, 0, -9.81});
      ContactHistory contacts;
      GrainDynamics dynamics(crowd.scene, terms, kernels);
      for (int call = 0; call < 50; ++call)
        dynamics.advance(grains, contacts, {.push = push}, crowd.scene.dem_step, 10, 0.5);
      EXPECT_GT(contacts.size(), 20u);
      return std::pair(grains, contacts);
    };
    EXPECT_EQ(stir(grain_kernels_v3), stir(grain_kernels_v4));
  }
}

}   // namespace
}   // namespace bedload

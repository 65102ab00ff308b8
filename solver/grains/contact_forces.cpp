// Pairs are prepared for the kernel; walls, which are few, are met in double, some side by side.
#include "solver/grains/contact_forces.hpp"

#include <algorithm>

namespace bedload {
namespace {

/// Some contacts with walls, quantity by quantity, so that the compiler answers several of them with one instruction.
struct WallColumns {
  static constexpr std::size_t at_once = 32;
  using Column = double[at_once];
  Column depth, root_radius, mass, friction, damping, tangential_damping;
  Column normal_x, normal_y, normal_z, velocity_x, velocity_y, velocity_z;
  Column spring_x, spring_y, spring_z, force_x, force_y, force_z;

  void put(std::size_t k, const Overlap& o, double of_friction, Damping of_damping, Vec3 spring) noexcept {
    depth[k] = o.depth, root_radius[k] = o.root_radius, mass[k] = o.mass, friction[k] = of_friction;
    damping[k] = of_damping.normal, tangential_damping[k] = of_damping.tangential;
    normal_x[k] = o.normal.x, normal_y[k] = o.normal.y, normal_z[k] = o.normal.z;
    velocity_x[k] = o.velocity.x, velocity_y[k] = o.velocity.y, velocity_z[k] = o.velocity.z;
    spring_x[k] = spring.x, spring_y[k] = spring.y, spring_z[k] = spring.z;
  }

  void respond(const ContactModuli<double>& material, double dt, std::size_t count) noexcept {
    for (std::size_t k = 0; k < count; ++k) {
      const OverlapOf<double> o{depth[k],
                                root_radius[k],
                                mass[k],
                                {normal_x[k], normal_y[k], normal_z[k]},
                                {velocity_x[k], velocity_y[k], velocity_z[k]}};
      const ContactModuli<double> of_wall{material.normal_stiffness, material.shear_ratio, friction[k]};
      const auto r = hertz_mindlin(of_wall, o, {spring_x[k], spring_y[k], spring_z[k]}, dt,
                                   Damping{damping[k], tangential_damping[k]});
      force_x[k] = r.force.x, force_y[k] = r.force.y, force_z[k] = r.force.z;
      spring_x[k] = r.spring.x, spring_y[k] = r.spring.y, spring_z[k] = r.spring.z;
    }
  }

  Vec3 force(std::size_t k) const noexcept { return {force_x[k], force_y[k], force_z[k]}; }
  Vec3 spring(std::size_t k) const noexcept { return {spring_x[k], spring_y[k], spring_z[k]}; }
};

/// From the wall into the grain's middle, at the point of contact.
double arm_of(const Sphere& sphere, const WallContact& contact) noexcept { return sphere.radius - 0.5 * contact.depth; }

}   // namespace

PairPass pair_pass(const HertzMindlin& law, const WetRestitution* wet, const Bodies& bodies, double dt,
                   NeighbourList& list) noexcept {
  const PeriodicBox& box = list.box();
  const auto real = [](double x) { return static_cast<float>(x); };
  PairPass pass{};
  pass.spheres = bodies.spheres.data();
  pass.blocks = list.pairs.blocks.data();
  pass.loads = list.loads.load.data(), pass.ring_blocks = list.loads.ring_blocks;
  pass.material = {real(law.material().normal_stiffness), real(law.material().shear_ratio), real(law.friction())};
  pass.damping = {real(law.damping().normal), real(law.damping().tangential)};
  pass.root_shear_ratio = real(law.root_shear_ratio());
  if (wet) pass.wet_blocks = list.pairs.wet_blocks.data(), pass.wet = wet->table();
  for (int c = 0; c < 3; ++c) pass.length[c] = box.length[c], pass.inverse_length[c] = box.inverse[c];
  pass.dt = real(dt);
  return pass;
}

SumPass sum_pass(const Bodies& bodies, const NeighbourList& list) noexcept {
  const ContactLoads& loads = list.loads;
  return {bodies.spheres.data(), loads.load.data(), loads.places.data(), loads.further_as_higher.data(),
          loads.further_as_lower.data()};
}

void PairWave::meet_below(std::size_t grain) noexcept {
  const std::size_t to_meet = list_.blocks_of_grains_below(grain);
  while (met_ < to_meet) {   // never more at once than the ring holds: far loads are kept before the next turn
    const std::size_t next = std::min(to_meet, met_ + list_.loads.ring_blocks);
    kernels_.meet(pass_, met_, next);
    list_.keep_far_loads(met_ = next, far_);
  }
}

// A load is rounded before it is used, so that grain and wall get the same.
Vec3 meet_walls(const HertzMindlin& rough, const HertzMindlin& smooth, const WetRestitution* wet, const Bodies& bodies,
                double dt, double lid_speed, NeighbourList& list) noexcept {
  Vec3 on_walls;
  ContactLoad* load = list.loads.load.data() + list.loads.first_wall;
  WallColumns columns;
  const std::size_t n = list.wall_contacts.size();
  for (std::size_t first = 0; first < n; first += WallColumns::at_once) {
    WallContact* const contacts = list.wall_contacts.data() + first;
    const std::size_t count = std::min(n - first, WallColumns::at_once);
    for (std::size_t k = 0; k < count; ++k) {   // grains at walls lie far apart in memory: all are fetched at once
      __builtin_prefetch(&bodies.spheres[contacts[k].grain]);
      __builtin_prefetch(&bodies.motions[contacts[k].grain]);
    }
    for (std::size_t k = 0; k < count; ++k) {
      WallContact& contact = contacts[k];
      const FlatWall& wall = list.walls()[contact.wall];
      const Sphere& sphere = bodies.spheres[contact.grain];
      const Motion& motion = bodies.motions[contact.grain];
      Overlap o;
      o.depth = contact.depth = wall.depth(sphere.position, sphere.radius);
      o.root_radius = contact.root_radius, o.mass = contact.mass, o.normal = wall.normal();
      o.velocity = motion.velocity - Vec3{wall.moves ? lid_speed : 0, 0, 0} +
                   arm_of(sphere, contact) * cross(motion.spin, o.normal);
      if (!(o.depth > 0)) contact.damping = -1;
      else if (wet && contact.damping < 0)
        contact.damping = wet->damping(contact.viscous_speed, dot(o.velocity, o.normal));
      const HertzMindlin& law = wall.rough ? rough : smooth;
      columns.put(k, o, law.friction(), wet ? law.damping(contact.damping) : law.damping(), contact.spring);
    }
    columns.respond(rough.material(), dt, count);
    for (std::size_t k = 0; k < count; ++k, ++load) {
      WallContact& contact = contacts[k];
      const Sphere& sphere = bodies.spheres[contact.grain];
      contact.spring = columns.spring(k);
      const Vec3 force = columns.force(k);
      const Vec3 torque = arm_of(sphere, contact) / sphere.radius * cross(list.walls()[contact.wall].normal(), force);
      for (int c = 0; c < 3; ++c) {
        load->force[c] = static_cast<float>(force[c]);
        load->torque_per_radius[c] = static_cast<float>(torque[c]);
        on_walls[c] -= static_cast<double>(load->force[c]);
      }
    }
  }
  return on_walls;
}

}   // namespace bedload

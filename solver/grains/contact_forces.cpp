// Pairs are prepared for the kernel; walls, which are few, are met one by one, in double.
#include "solver/grains/contact_forces.hpp"

namespace bedload {

PairPass pair_pass(const HertzMindlin& law, const WetRestitution* wet, const Bodies& bodies, double dt,
                   NeighbourList& list) noexcept {
  const PeriodicBox& box = list.box();
  const auto real = [](double x) { return static_cast<float>(x); };
  PairPass pass{};
  pass.spheres = bodies.spheres.data();
  pass.blocks = list.pairs.blocks.data();
  pass.loads = list.loads.load.data();
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

// A load is rounded before it is used, so that grain and wall get the same.
Vec3 meet_walls(const HertzMindlin& rough, const HertzMindlin& smooth, const WetRestitution* wet, const Bodies& bodies,
                double dt, double lid_speed, NeighbourList& list) noexcept {
  Vec3 on_walls;
  ContactLoad* load = list.loads.load.data() + list.loads.first_wall;
  for (WallContact& contact : list.wall_contacts) {
    const FlatWall& wall = list.walls()[contact.wall];
    const Sphere& sphere = bodies.spheres[contact.grain];
    const Motion& motion = bodies.motions[contact.grain];
    const Vec3 wall_velocity{wall.moves ? lid_speed : 0, 0, 0};
    Overlap o;
    o.depth = contact.depth = wall.depth(sphere.position, sphere.radius);
    if (!(o.depth > 0)) {
      contact.spring = {}, contact.damping = -1, *load++ = {};
      continue;
    }
    o.root_radius = contact.root_radius;
    o.mass = contact.mass;
    o.normal = wall.normal();
    const double arm = sphere.radius - 0.5 * o.depth;
    o.velocity = motion.velocity - wall_velocity + arm * cross(motion.spin, o.normal);
    const HertzMindlin& law = wall.rough ? rough : smooth;
    if (wet && contact.damping < 0) contact.damping = wet->damping(contact.viscous_speed, dot(o.velocity, o.normal));
    const Damping damping = wet ? law.damping(contact.damping) : law.damping();
    const ContactForce r = law.respond(o, contact.spring, dt, damping);
    contact.spring = r.spring;
    const Vec3 torque = arm / sphere.radius * cross(o.normal, r.force);
    for (int c = 0; c < 3; ++c) {
      load->force[c] = static_cast<float>(r.force[c]);
      load->torque_per_radius[c] = static_cast<float>(torque[c]);
      on_walls[c] -= static_cast<double>(load->force[c]);
    }
    ++load;
  }
  return on_walls;
}

}   // namespace bedload

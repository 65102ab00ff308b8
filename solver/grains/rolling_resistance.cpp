// The rolling spring is treated as the tangential one is: turned with its contact, rescaled, capped with its torque.
#include "solver/grains/rolling_resistance.hpp"

namespace bedload {

RollingTorque RollingResistance::respond(const HertzMindlin& law, Damping damped, const Overlap& o, Vec3 turning,
                                         Vec3 spring, double dt) const noexcept {
  if (!(o.depth > 0)) return {};
  const double radius = o.root_radius * o.root_radius, stiffness = law.shear_stiffness(o);
  const double kept = kept_of_spring(o.depth, dot(o.velocity, o.normal), dt);
  const Vec3 rolling = turning - dot(turning, o.normal) * o.normal;
  spring = kept * (spring - dot(spring, o.normal) * o.normal) + dt * rolling;   // (G22)
  const double damping = HertzMindlin::strongest_shear_damping * std::sqrt(stiffness * o.mass);
  Vec3 torque = radius * radius * (stiffness * spring + damping * rolling);   // (G21)
  const double most = friction_ * radius * law.normal_force(o, damped), turn = norm(torque);
  const double scale = turn > most ? most / turn : 1;   // (G23)
  return {-scale * torque, scale * spring};
}

double RollingResistance::energy(const HertzMindlin& law, const Overlap& o, Vec3 spring) noexcept {
  const double radius = o.root_radius * o.root_radius;
  return radius * radius * law.shear_stiffness(o) * norm2(spring) / 2;
}

namespace {

void add_pair_torques(const RollingResistance& resistance, const HertzMindlin& law, const Bodies& bodies, double dt,
                      NeighbourList& list, std::span<Load> loads) noexcept {
  PairContacts& pairs = list.pairs;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    Vec3& spring = pairs.rolling[k];
    if (!(pairs.depth(k) > 0)) {
      spring = {};
      continue;
    }
    const auto i = pairs.ids.lower[k], j = pairs.ids.higher[k];
    const Vec3 apart = list.box().shortest(bodies.spheres[j].position - bodies.spheres[i].position);
    const Vec3 normal = apart * (1 / norm(apart));
    const Overlap o{
        pairs.depth(k), pairs.root_radius(k), pairs.mass(k), normal,
        bodies.motions[i].velocity - bodies.motions[j].velocity};   // of its velocity only the normal part is read
    const Damping damped = list.wet() ? law.damping(pairs.damping(k)) : law.damping();
    const RollingTorque r =
        resistance.respond(law, damped, o, bodies.motions[i].spin - bodies.motions[j].spin, spring, dt);
    spring = r.spring;
    loads[i].torque += r.torque;
    loads[j].torque -= r.torque;
  }
}

}   // namespace

void add_rolling_torques(const RollingResistance& resistance, const HertzMindlin& law, const Bodies& bodies, double dt,
                         NeighbourList& list, std::span<Load> loads) noexcept {
  add_pair_torques(resistance, law, bodies, dt, list, loads);
  for (WallContact& c : list.wall_contacts) {
    const FlatWall& wall = list.walls()[c.wall];
    if (!wall.rough) continue;
    const Motion& motion = bodies.motions[c.grain];
    const Overlap o{c.depth, c.root_radius, c.mass, wall.normal(), motion.velocity};
    const RollingTorque r =
        resistance.respond(law, c.damping < 0 ? law.damping() : law.damping(c.damping), o, motion.spin, c.rolling, dt);
    c.rolling = r.spring;
    loads[c.grain].torque += r.torque;
  }
}

}   // namespace bedload

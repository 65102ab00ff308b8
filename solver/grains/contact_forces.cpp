// Blocks of pairs: fetch both grains, apply the law to the whole block (the compiler vectorises it), add up in order.
#include "solver/grains/contact_forces.hpp"

#include <algorithm>

namespace bedload {
namespace {

constexpr std::size_t block_size = 64;   // its arrays stay in the first-level cache

/// Relative motion of a block of pairs, and what the law makes of it: structure of arrays.
struct alignas(64) PairBlock {
  using Lane = double[block_size];
  Lane dx, dy, dz;           // from the lower to the higher grain [m]
  Lane vx, vy, vz;           // velocity of the lower relative to the higher, without spin [m/s]
  Lane radius_a, radius_b;   // [m]
  Lane ax, ay, az;           // spin of the lower [rad/s]
  Lane bx, by, bz;           // of the higher
  Lane fx, fy, fz;           // force on the lower [N]
  Lane tx, ty, tz;           // normal x force [N]: torque per lever arm, the same on both
};

void fetch(std::span<const Body> bodies, const PairContacts& pairs, std::size_t first, std::size_t count,
           PairBlock& b) noexcept {
  for (std::size_t k = 0; k < count; ++k) {
    const Body& i = bodies[pairs.ids.lower[first + k]];
    const Body& j = bodies[pairs.ids.higher[first + k]];
    b.dx[k] = j.position.x - i.position.x, b.dy[k] = j.position.y - i.position.y, b.dz[k] = j.position.z - i.position.z;
    b.vx[k] = i.velocity.x - j.velocity.x, b.vy[k] = i.velocity.y - j.velocity.y, b.vz[k] = i.velocity.z - j.velocity.z;
    b.radius_a[k] = i.radius, b.radius_b[k] = j.radius;
    b.ax[k] = i.spin.x, b.ay[k] = i.spin.y, b.az[k] = i.spin.z;
    b.bx[k] = j.spin.x, b.by[k] = j.spin.y, b.bz[k] = j.spin.z;
  }
}

// Lever arms are r - depth/2: they add up to the distance, so angular momentum is kept. (G9)
void respond(const HertzMindlin& law, const PeriodicBox& box, double dt, const PairContacts& pairs, std::size_t first,
             std::size_t count, PairBlock& b, double* __restrict depth, double* __restrict sx, double* __restrict sy,
             double* __restrict sz) noexcept {
  const double* root_radius = pairs.root_radius.data() + first;
  const double* mass = pairs.mass.data() + first;
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3 apart = box.shortest({b.dx[k], b.dy[k], b.dz[k]});
    const double distance = norm(apart);
    Overlap o;
    o.depth = b.radius_a[k] + b.radius_b[k] - distance;
    o.root_radius = root_radius[k];
    o.mass = mass[k];
    o.normal = apart * (1 / distance);
    const Vec3 spin = (b.radius_a[k] - 0.5 * o.depth) * Vec3{b.ax[k], b.ay[k], b.az[k]} +
                      (b.radius_b[k] - 0.5 * o.depth) * Vec3{b.bx[k], b.by[k], b.bz[k]};
    o.velocity = Vec3{b.vx[k], b.vy[k], b.vz[k]} + cross(spin, o.normal);
    const ContactForce r = law.respond(o, {sx[k], sy[k], sz[k]}, dt);
    const Vec3 turn = cross(o.normal, r.force);
    depth[k] = o.depth;
    sx[k] = r.spring.x, sy[k] = r.spring.y, sz[k] = r.spring.z;
    b.fx[k] = r.force.x, b.fy[k] = r.force.y, b.fz[k] = r.force.z;
    b.tx[k] = turn.x, b.ty[k] = turn.y, b.tz[k] = turn.z;
  }
}

// The lower grain of a row of pairs is the same: its sum stays in registers until the row ends.
void add_up(const PairContacts& pairs, std::size_t first, std::size_t count, const PairBlock& b,
            std::span<Load> loads) noexcept {
  for (std::size_t k = 0; k < count;) {
    const std::uint32_t lower = pairs.ids.lower[first + k];
    Load sum = loads[lower];
    for (; k < count && pairs.ids.lower[first + k] == lower; ++k) {
      const Vec3 force{b.fx[k], b.fy[k], b.fz[k]}, turn{b.tx[k], b.ty[k], b.tz[k]};
      const double half = 0.5 * pairs.depth[first + k];
      sum.force += force;
      sum.torque += (b.radius_a[k] - half) * turn;
      Load& other = loads[pairs.ids.higher[first + k]];
      other.force -= force;
      other.torque += (b.radius_b[k] - half) * turn;
    }
    loads[lower] = sum;
  }
}

}   // namespace

void add_pair_forces(const HertzMindlin& law, const PeriodicBox& box, std::span<const Body> bodies, double dt,
                     PairContacts& pairs, std::span<Load> loads) noexcept {
  PairBlock block;
  for (std::size_t first = 0; first < pairs.size(); first += block_size) {
    const std::size_t count = std::min(block_size, pairs.size() - first);
    fetch(bodies, pairs, first, count, block);
    respond(law, box, dt, pairs, first, count, block, pairs.depth.data() + first, pairs.spring_x.data() + first,
            pairs.spring_y.data() + first, pairs.spring_z.data() + first);
    add_up(pairs, first, count, block, loads);
  }
}

Vec3 add_wall_forces(const HertzMindlin& rough, const HertzMindlin& smooth, std::span<const FlatWall> walls,
                     std::span<const Body> bodies, double dt, double lid_speed, std::span<WallContact> contacts,
                     std::span<Load> loads) noexcept {
  Vec3 on_walls;
  for (WallContact& contact : contacts) {
    const FlatWall& wall = walls[contact.wall];
    const Body& body = bodies[contact.grain];
    const Vec3 wall_velocity{wall.moves ? lid_speed : 0, 0, 0};
    Overlap o;
    o.depth = contact.depth = wall.depth(body.position, body.radius);
    o.root_radius = contact.root_radius;
    o.mass = contact.mass;
    o.normal = wall.normal();
    const double arm = body.radius - 0.5 * o.depth;
    o.velocity = body.velocity - wall_velocity + arm * cross(body.spin, o.normal);
    const ContactForce r = (wall.rough ? rough : smooth).respond(o, contact.spring, dt);
    contact.spring = r.spring;
    loads[contact.grain].force += r.force;
    loads[contact.grain].torque += arm * cross(o.normal, r.force);
    on_walls -= r.force;
  }
  return on_walls;
}

}   // namespace bedload

// Blocks of pairs: fetch both grains, apply the law to the whole block (the compiler vectorises it), add up in order.
#include "solver/grains/contact_forces.hpp"

#include <algorithm>

namespace bedload {
namespace {

constexpr std::size_t block_size = 64;   // its arrays stay in the first-level cache

/// Relative motion of a block of pairs, and what the law makes of it: structure of arrays.
struct alignas(64) PairBlock {
  using Lane = double[block_size];
  Lane dx, dy, dz, radius_difference;   // from the lower to the higher grain, r_j - r_i [m]
  Lane vx, vy, vz, radius_sum;          // velocity of the lower relative to the higher, without spin [m/s]; [m]
  Lane ax, ay, az, unused_a;            // spin of the lower [rad/s]
  Lane bx, by, bz, unused_b;            // of the higher
  Lane fx, fy, fz;                      // force on the lower [N]
  Lane tx, ty, tz;                      // normal x force [N]: torque per lever arm, the same on both
  Lane arm_a, arm_b;                    // lever arms [m]
};

// The law wants pairs side by side: rows are turned in registers.
inline void store_columns(const BodyRow (&row)[4], double* x, double* y, double* z, double* fourth) {
  const BodyRow ab02 = __builtin_shufflevector(row[0], row[1], 0, 4, 2, 6);
  const BodyRow ab13 = __builtin_shufflevector(row[0], row[1], 1, 5, 3, 7);
  const BodyRow cd02 = __builtin_shufflevector(row[2], row[3], 0, 4, 2, 6);
  const BodyRow cd13 = __builtin_shufflevector(row[2], row[3], 1, 5, 3, 7);
  store_body_row(x, __builtin_shufflevector(ab02, cd02, 0, 1, 4, 5));
  store_body_row(y, __builtin_shufflevector(ab13, cd13, 0, 1, 4, 5));
  store_body_row(z, __builtin_shufflevector(ab02, cd02, 2, 3, 6, 7));
  store_body_row(fourth, __builtin_shufflevector(ab13, cd13, 2, 3, 6, 7));
}

void fetch(std::span<const Body> bodies, const PairContacts& pairs, std::size_t first, std::size_t count,
           PairBlock& b) noexcept {
  for (std::size_t k = 0; k < count; k += 4) {
    BodyRow apart[4], velocity[4], spin_a[4], spin_b[4];
    for (std::size_t n = 0; n < 4; ++n) {
      const std::size_t pair = first + std::min(k + n, count - 1);   // past the end: the last one again, never used
      const Body& i = bodies[pairs.ids.lower[pair]];
      const Body& j = bodies[pairs.ids.higher[pair]];
      const BodyRow place_i = load_body_row(&i.position.x), place_j = load_body_row(&j.position.x);
      const BodyRow relative = load_body_row(&i.velocity.x) - load_body_row(&j.velocity.x);
      apart[n] = place_j - place_i;
      velocity[n] = __builtin_shufflevector(relative, place_i + place_j, 0, 1, 2, 7);
      spin_a[n] = load_body_row(&i.spin.x);
      spin_b[n] = load_body_row(&j.spin.x);
    }
    store_columns(apart, b.dx + k, b.dy + k, b.dz + k, b.radius_difference + k);
    store_columns(velocity, b.vx + k, b.vy + k, b.vz + k, b.radius_sum + k);
    store_columns(spin_a, b.ax + k, b.ay + k, b.az + k, b.unused_a + k);
    store_columns(spin_b, b.bx + k, b.by + k, b.bz + k, b.unused_b + k);
  }
}

/// Damping of dry contacts, of contacts in a liquid that goes on with what was chosen when they began, and of those that
/// begin.
struct DryDamping {
  Damping all;
  Damping of(std::size_t, const Overlap&) const noexcept { return all; }
};

struct KeptDamping {
  const HertzMindlin& law;
  const double* __restrict alpha;   // negative: apart; whatever its damping, a pair apart has no force
  Damping of(std::size_t k, const Overlap&) const noexcept { return law.damping(alpha[k]); }
};

struct ChosenDamping {
  const HertzMindlin& law;
  const WetRestitution& wet;
  const double* viscous_speed;
  double* alpha;

  Damping of(std::size_t k, const Overlap& o) const noexcept {
    return law.damping(alpha[k] = wet.damping(viscous_speed[k], dot(o.velocity, o.normal)));
  }
};

// Pairs begin..end of the block at `first`. Lever arms are r - depth/2: they add up to the distance, so angular momentum is
// kept. (G9)
template <class DampingOf>
void respond(const HertzMindlin& law, const DampingOf& damping, const PeriodicBox& box, double dt,
             const PairContacts& pairs, std::size_t first, std::size_t begin, std::size_t end, PairBlock& b,
             double* __restrict depth, double* __restrict sx, double* __restrict sy, double* __restrict sz) noexcept {
  const double* root_radius = pairs.root_radius.data() + first;
  const double* mass = pairs.mass.data() + first;
  for (std::size_t k = begin; k < end; ++k) {
    const Vec3 apart = box.shortest({b.dx[k], b.dy[k], b.dz[k]});
    const double distance = norm(apart);
    Overlap o;
    o.depth = b.radius_sum[k] - distance;
    o.root_radius = root_radius[k];
    o.mass = mass[k];
    o.normal = apart * (1 / distance);
    const double arm_a = 0.5 * (distance - b.radius_difference[k]);
    const double arm_b = 0.5 * (distance + b.radius_difference[k]);
    const Vec3 spin = arm_a * Vec3{b.ax[k], b.ay[k], b.az[k]} + arm_b * Vec3{b.bx[k], b.by[k], b.bz[k]};
    o.velocity = Vec3{b.vx[k], b.vy[k], b.vz[k]} + cross(spin, o.normal);
    const ContactForce r = law.respond(o, {sx[k], sy[k], sz[k]}, dt, damping.of(k, o));
    const Vec3 turn = cross(o.normal, r.force);
    depth[k] = o.depth;
    sx[k] = r.spring.x, sy[k] = r.spring.y, sz[k] = r.spring.z;
    b.fx[k] = r.force.x, b.fy[k] = r.force.y, b.fz[k] = r.force.z;
    b.tx[k] = turn.x, b.ty[k] = turn.y, b.tz[k] = turn.z;
    b.arm_a[k] = arm_a, b.arm_b[k] = arm_b;
  }
}

/// Takes out the damping of pairs apart; true if any pair touches without one.
bool forget_damping_apart(const double* __restrict depth, double* __restrict alpha, std::size_t count) noexcept {
  bool any_begins = false;
  for (std::size_t k = 0; k < count; ++k) {
    alpha[k] = depth[k] > 0 ? alpha[k] : -1;
    any_begins |= (depth[k] > 0) & (alpha[k] < 0);
  }
  return any_begins;
}

// Contacts that begin are rare: all pairs are answered as if none did, and those few again with the damping they choose.
template <class RespondWith>
void respond_in_liquid(const HertzMindlin& law, const WetRestitution& wet, PairContacts& pairs, std::size_t first,
                       std::size_t count, const RespondWith& respond_with) noexcept {
  double *const alpha = pairs.damping.data() + first, *const depth = pairs.depth.data() + first;
  double before[3][block_size];
  double* const spring[] = {pairs.spring_x.data() + first, pairs.spring_y.data() + first,
                            pairs.spring_z.data() + first};
  for (int c = 0; c < 3; ++c) std::copy_n(spring[c], count, before[c]);
  respond_with(KeptDamping{law, alpha}, 0, count);
  if (!forget_damping_apart(depth, alpha, count)) return;
  for (std::size_t k = 0; k < count; ++k) {
    if (!(depth[k] > 0) || !(alpha[k] < 0)) continue;
    for (int c = 0; c < 3; ++c) spring[c][k] = before[c][k];
    respond_with(ChosenDamping{law, wet, pairs.viscous_speed.data() + first, alpha}, k, k + 1);
  }
}

// The lower grain of a run of pairs is the same: its sum stays in registers until the run ends.
void add_up(const PairContacts& pairs, std::size_t first, std::size_t count, const PairBlock& b,
            std::span<Load> loads) noexcept {
  std::uint32_t lower = pairs.ids.lower[first];
  BodyRow force = load_body_row(&loads[lower].force.x), torque = load_body_row(&loads[lower].torque.x);
  for (std::size_t k = 0; k < count; ++k) {
    if (pairs.ids.lower[first + k] != lower) {
      store_body_row(&loads[lower].force.x, force), store_body_row(&loads[lower].torque.x, torque);
      lower = pairs.ids.lower[first + k];
      force = load_body_row(&loads[lower].force.x), torque = load_body_row(&loads[lower].torque.x);
    }
    const BodyRow pair_force{b.fx[k], b.fy[k], b.fz[k], 0}, turn{b.tx[k], b.ty[k], b.tz[k], 0};
    Load& other = loads[pairs.ids.higher[first + k]];
    force += pair_force;
    torque += b.arm_a[k] * turn;
    store_body_row(&other.force.x, load_body_row(&other.force.x) - pair_force);
    store_body_row(&other.torque.x, load_body_row(&other.torque.x) + b.arm_b[k] * turn);
  }
  store_body_row(&loads[lower].force.x, force), store_body_row(&loads[lower].torque.x, torque);
}

}   // namespace

void add_pair_forces(const HertzMindlin& law, const WetRestitution* wet, const PeriodicBox& box,
                     std::span<const Body> bodies, double dt, PairContacts& pairs, std::span<Load> loads) noexcept {
  PairBlock block;
  for (std::size_t first = 0; first < pairs.size(); first += block_size) {
    const std::size_t count = std::min(block_size, pairs.size() - first);
    fetch(bodies, pairs, first, count, block);
    const auto respond_with = [&](const auto& damping, std::size_t begin, std::size_t end) {
      respond(law, damping, box, dt, pairs, first, begin, end, block, pairs.depth.data() + first,
              pairs.spring_x.data() + first, pairs.spring_y.data() + first, pairs.spring_z.data() + first);
    };
    if (wet) respond_in_liquid(law, *wet, pairs, first, count, respond_with);
    else respond_with(DryDamping{law.damping()}, 0, count);
    add_up(pairs, first, count, block, loads);
  }
}

Vec3 add_wall_forces(const HertzMindlin& rough, const HertzMindlin& smooth, const WetRestitution* wet,
                     std::span<const FlatWall> walls, std::span<const Body> bodies, double dt, double lid_speed,
                     std::span<WallContact> contacts, std::span<Load> loads) noexcept {
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
    const HertzMindlin& law = wall.rough ? rough : smooth;
    if (wet && !(o.depth > 0)) contact.damping = -1;
    else if (wet && contact.damping < 0)
      contact.damping = wet->damping(contact.viscous_speed, dot(o.velocity, o.normal));
    const Damping damping = wet ? law.damping(contact.damping) : law.damping();
    const ContactForce r = law.respond(o, contact.spring, dt, damping);
    contact.spring = r.spring;
    loads[contact.grain].force += r.force;
    loads[contact.grain].torque += arm * cross(o.normal, r.force);
    on_walls -= r.force;
  }
  return on_walls;
}

}   // namespace bedload

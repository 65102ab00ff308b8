// Compiled for x86-64-v3 and for v4. Registers hold 8 or 16 pairs: rows are fetched, turned into columns, answered by the
// law, and turned back into rows that are added up grain by grain.
#include "solver/grains/grain_kernels.hpp"

#include "solver/grains/rows_and_columns.hpp"

namespace bedload {
namespace {

/// x - L rint(x/L), by which a difference of places becomes the shortest one. Adding and taking away 1.5 2^52 rounds.
BEDLOAD_INLINE Doubles shortest(Doubles x, double length, double inverse) {
  constexpr double rounds = 6755399441055744.0;
  return x - length * ((x * inverse + rounds) - rounds);
}

struct PairColumns {
  Doubles x[2], y[2], z[2];   // from the lower to the higher grain [m]
  Floats vx, vy, vz;          // velocity of the lower relative to the higher, without spin [m/s]
  Floats sx, sy, sz;          // r_i omega_i + r_j omega_j [m/s]
};

BEDLOAD_INLINE PairColumns fetch(const Sphere* spheres, const std::uint32_t* lower, const std::uint32_t* higher) {
  PairColumns c;
  constexpr int half_of = lanes / 2;
  const Row8 opposite{-1, -1, -1, 1, 1, 1, 1, 1};   // velocities are subtracted, spins added
  Row8 relative[lanes];
  for (int half = 0; half < 2; ++half) {
    Row4 apart[half_of];
    for (int k = 0; k < half_of; ++k) {
      const int pair = half * half_of + k;
      const Sphere &i = spheres[lower[pair]], &j = spheres[higher[pair]];
      apart[k] = load<Row4>(&j.position.x) - load<Row4>(&i.position.x);
      relative[pair] = load<Row8>(i.velocity) + opposite * load<Row8>(j.velocity);
    }
    turn_rows(apart, c.x[half], c.y[half], c.z[half]);
  }
  Floats rows[8];
  for (int k = 0; k < 8; ++k) {
#if defined(__AVX512F__)
    rows[k] =
        __builtin_shufflevector(relative[k], relative[k + 8], 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
#else
    rows[k] = relative[k];
#endif
  }
  turn_eight(rows);
  c.vx = rows[0], c.vy = rows[1], c.vz = rows[2], c.sx = rows[4], c.sy = rows[5], c.sz = rows[6];
  return c;
}

/// What the law reads of two registers full of pairs.
struct Meeting {
  Vector<Wide> apart;      // from the lower to the higher grain [m]
  Wide excess, reach;      // (r_i + r_j)^2 - distance^2 [m2]; r_i + r_j [m]
  Vector<Wide> velocity;   // of the lower relative to the higher, without spin [m/s]
  Vector<Wide> surface;    // r_i omega_i + r_j omega_j [m/s]
};

BEDLOAD_INLINE void approach(const PairPass& p, const PairBlock& b, std::size_t first, int part, Meeting& m) {
  const std::size_t at = first + static_cast<std::size_t>(part * lanes);
  PairColumns c = fetch(p.spheres, b.lower + at, b.higher + at);
  Doubles excess[2], reach[2];
  for (int half = 0; half < 2; ++half) {
    if (p.inverse_length[0] > 0) c.x[half] = shortest(c.x[half], p.length[0], p.inverse_length[0]);
    if (p.inverse_length[1] > 0) c.y[half] = shortest(c.y[half], p.length[1], p.inverse_length[1]);
    if (p.inverse_length[2] > 0) c.z[half] = shortest(c.z[half], p.length[2], p.inverse_length[2]);
    reach[half] = load<Doubles>(b.radius_sum + at + static_cast<std::size_t>(half * (lanes / 2)));
    excess[half] = reach[half] * reach[half] - (c.x[half] * c.x[half] + c.y[half] * c.y[half] + c.z[half] * c.z[half]);
  }
  m.apart.x.part[part] = join(c.x[0], c.x[1]), m.apart.y.part[part] = join(c.y[0], c.y[1]);
  m.apart.z.part[part] = join(c.z[0], c.z[1]);
  m.excess.part[part] = join(excess[0], excess[1]), m.reach.part[part] = join(reach[0], reach[1]);
  m.velocity.x.part[part] = c.vx, m.velocity.y.part[part] = c.vy, m.velocity.z.part[part] = c.vz;
  m.surface.x.part[part] = c.sx, m.surface.y.part[part] = c.sy, m.surface.z.part[part] = c.sz;
}

BEDLOAD_INLINE void deliver(ContactLoad* to, const Vector<Wide>& force, const Vector<Wide>& torque, int part) {
  Floats rows[8] = {force.x.part[part],  force.y.part[part],  force.z.part[part],  {},
                    torque.x.part[part], torque.y.part[part], torque.z.part[part], {}};
  turn_eight(rows);
  to += part * lanes;
  for (int k = 0; k < 8; ++k) {
#if defined(__AVX512F__)
    store(to[k].force, __builtin_shufflevector(rows[k], rows[k], 0, 1, 2, 3, 4, 5, 6, 7));
    store(to[k + 8].force, __builtin_shufflevector(rows[k], rows[k], 8, 9, 10, 11, 12, 13, 14, 15));
#else
    store(to[k].force, rows[k]);
#endif
  }
}

BEDLOAD_INLINE Wide all(float x) { return Wide{} + x; }

/// Damping of contacts in a liquid: chosen by the speed of approach when a contact begins, and kept.
BEDLOAD_INLINE DampingOf<Wide> wet_damping(const PairPass& p, WetBlock& b, std::size_t at, const OverlapOf<Wide>& o) {
  const Wide closing = dot(o.velocity, o.normal);
  for (int part = 0; part < 2; ++part)
    for (int k = 0; k < lanes; ++k) {
      float& own = b.damping[at + static_cast<std::size_t>(part * lanes + k)];
      if (!(o.depth.part[part][k] > 0)) own = -1;
      else if (own < 0)   // rare
        own = static_cast<float>(
            p.wet.damping(b.viscous_speed[at + static_cast<std::size_t>(part * lanes + k)], closing.part[part][k]));
    }
  const Wide alpha = load<Wide>(b.damping + at), strongest = all(static_cast<float>(strongest_shear_damping));
  return {alpha, p.root_shear_ratio * (strongest / choose(alpha > strongest, alpha, strongest))};
}

/// Two registers full of pairs. The contact divides the line between the centres as the radii do, so that lever arms,
/// r_i q and r_j q with q = distance/(r_i + r_j), add up to it and angular momentum is kept. (G9)
BEDLOAD_INLINE void meet_some(const PairPass& p, PairBlock& b, WetBlock* wet, std::size_t at, ContactLoad* loads) {
  Meeting m;
  approach(p, b, at, 0, m), approach(p, b, at, 1, m);
  const Wide distance = root(dot(m.apart, m.apart));
  OverlapOf<Wide> o;
  o.depth = m.excess / (m.reach + distance);   // the cancellation is left to the double
  o.root_radius = load<Wide>(b.root_radius + at);
  o.mass = load<Wide>(b.mass + at);
  o.normal = (all(1) / distance) * m.apart;
  const Wide arm = distance * load<Wide>(b.inverse_radius_sum + at);
  o.velocity = m.velocity + arm * cross(m.surface, o.normal);

  const DampingOf<Wide> damping =
      wet ? wet_damping(p, *wet, at, o) : DampingOf<Wide>{all(p.damping.normal), all(p.damping.tangential)};
  const Vector<Wide> spring{load<Wide>(b.spring_x + at), load<Wide>(b.spring_y + at), load<Wide>(b.spring_z + at)};
  const auto r = hertz_mindlin(p.material, o, spring, all(p.dt), damping);
  store(b.depth + at, o.depth);
  store(b.spring_x + at, r.spring.x), store(b.spring_y + at, r.spring.y), store(b.spring_z + at, r.spring.z);
  const Vector<Wide> torque = arm * cross(o.normal, r.force);
  deliver(loads + at, r.force, torque, 0), deliver(loads + at, r.force, torque, 1);
}

void meet(const PairPass& pass, std::size_t first, std::size_t last) {
  const PairPass p = pass;   // nothing stored below can change it
  for (std::size_t block = first, place = first % p.ring_blocks; block < last; ++block) {
    for (std::size_t at = 0; at < PairBlock::pairs; at += 2 * lanes)
      meet_some(p, p.blocks[block], p.wet_blocks ? p.wet_blocks + block : nullptr, at,
                p.loads + place * PairBlock::pairs);
    if (++place == p.ring_blocks) place = 0;
  }
}

void add_up(SumPass& pass, std::size_t first, std::size_t last, Load* loads) {
  SumPass s = pass;
  const auto* all = reinterpret_cast<const char*>(s.contact_loads);
  const auto add = [all](TwoRows & sum, std::uint32_t place) __attribute__((always_inline)) {
    sum.add_in_double(reinterpret_cast<const ContactLoad*>(all + place)->force);
  };
  for (std::size_t i = first; i < last; ++i) {
    TwoRows higher, lower;   // force and torque per radius
    const ContactPlaces& places = s.places[i];
    for (std::size_t k = 0; k < ContactPlaces::direct; ++k) add(higher, places.as_higher[k]);
    for (; s.further_as_higher->grain == i; ++s.further_as_higher) add(higher, s.further_as_higher->place);
    for (std::size_t k = 0; k < ContactPlaces::direct; ++k) add(lower, places.as_lower[k]);
    for (; s.further_as_lower->grain == i; ++s.further_as_lower) add(lower, s.further_as_lower->place);
    store(&loads[i - first].force.x, lower.first() - higher.first());
    store(&loads[i - first].torque.x, s.spheres[i].radius * (lower.second() + higher.second()));
  }
  pass = s;
}

BEDLOAD_INLINE void add_to(LoadSum& sum, Row4 force, Row4 torque, bool begins) {
  Row4 first = __builtin_shufflevector(force, torque, 0, 1, 2, 4);   // a sum has no gaps
  Row2 last = __builtin_shufflevector(torque, torque, 1, 2);
  if (!begins) first += load<Row4, 16>(&sum.force.x), last += load<Row2>(&sum.torque.y);
  store<Row4, 16>(&sum.force.x, first), store(&sum.torque.y, last);
}

/// The processor foresees a stretch of memory only to the end of its page, and four of them end every some tens of grains.
BEDLOAD_INLINE void expect(const MotionPass& p, std::size_t grain) {
  __builtin_prefetch(p.motions + grain, 1);
  __builtin_prefetch(p.spheres + grain, 1);
  __builtin_prefetch(p.sums + grain, 1);
  __builtin_prefetch(p.push + grain);
}

double move(const MotionPass& pass, std::size_t first, std::size_t last, const Load* loads) {
  const MotionPass p = pass;
  Row4 fastest{};   // squares of the components of velocity per skin
  for (std::size_t i = first; i < last; ++i) {
    expect(p, i + 64);
    Motion& m = p.motions[i];
    Sphere& s = p.spheres[i];
    const Load& load_of = loads[i - first];
    const Row4 force = load<Row4>(&load_of.force.x), torque = load<Row4>(&load_of.torque.x);
    add_to(p.sums[i], force, torque, p.begins_sums);

    const double dt = m.inverse_mass != 0 ? p.dt : 0;
    const Row4 push = load<Row4>(&p.push[i].acceleration.x);
    const Row4 before = load<Row4>(&m.velocity.x), spin_before = load<Row4>(&m.spin.x);
    Row4 velocity = (dt != 0 ? push[3] : 1.0) * (before + dt * (push + before[3] * force));
    Row4 spin = spin_before + (dt * spin_before[3]) * torque;
    if (p.spin_push) spin += dt * Row4{p.spin_push[i].x, p.spin_push[i].y, p.spin_push[i].z, 0};
    velocity = __builtin_shufflevector(velocity, before, 0, 1, 2, 7);
    spin = __builtin_shufflevector(spin, spin_before, 0, 1, 2, 7);
    store(&m.velocity.x, velocity), store(&m.spin.x, spin);

    const Row4 place = load<Row4>(&s.position.x), moved = place + dt * velocity;
    store(&s.position.x, __builtin_shufflevector(moved, place, 0, 1, 2, 7));
    store_in_float(s.velocity, velocity);
    store_in_float(s.surface_velocity, place[3] * spin);

    const Row4 skins = p.inverse_skin[i] * velocity, squares = skins * skins;
    fastest = squares > fastest ? squares : fastest;
  }
  return fastest[0] + fastest[1] + fastest[2];
}

}   // namespace

#if defined(__AVX512F__)
extern const GrainKernels grain_kernels_v4{"x86-64-v4", meet, add_up, move};
#else
extern const GrainKernels grain_kernels_v3{"x86-64-v3", meet, add_up, move};
#endif

}   // namespace bedload

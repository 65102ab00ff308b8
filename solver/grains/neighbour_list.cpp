// A half list with a skin per grain; the memory of the contacts is merged into it, both being sorted alike.
#include "solver/grains/neighbour_list.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include <fmt/format.h>

#include "base/error.hpp"
#include "solver/grains/film_law.hpp"

namespace bedload {
namespace {

// Wide enough for some tens of steps of a moving grain, narrow for one at rest: most listed pairs touch. (Measured: 12 to
// 30 steps cost the same in an eroding bed, 50 a tenth more.)
double skin_of(const Sphere& sphere, const Motion& motion, double dt) {
  if (motion.inverse_mass == 0) return 0;
  const double diameter = 2 * sphere.radius;
  return std::min(0.01 * diameter + 1.3 * 25 * dt * norm(motion.velocity), 0.2 * diameter);
}

// R* of two grains is at most a quarter of r_i + r_j, so that these parts reach the thickest film.
constexpr double film_reach = FilmLaw::thickest / 4;

float reduced_mass(const Motion& a, const Motion& b) { return 1 / static_cast<float>(a.inverse_mass + b.inverse_mass); }

SolidSphere solid(const Bodies& bodies, std::size_t i) {
  return {bodies.spheres[i].radius, bodies.motions[i].inverse_inertia};
}

bool before(std::uint32_t lower_a, std::uint32_t higher_a, std::uint32_t lower_b, std::uint32_t higher_b) {
  return lower_a != lower_b ? lower_a < lower_b : higher_a < higher_b;
}

}   // namespace

NeighbourList::NeighbourList(const BedScene& scene, const WetRestitution* wet, bool films, std::size_t summed_at_once)
    : box_(scene),
      walls_(walls_of(scene)),
      wet_(wet),
      films_(films),
      rolls_(scene.grains.rolling_friction > 0),
      summed_at_once_(summed_at_once) {}

/// Masses of the contacts.
void NeighbourList::weigh(const Bodies& bodies) noexcept {
  std::ranges::transform(bodies.motions, inverse_mass_.begin(), &Motion::inverse_mass);
  for (PairBlock& b : pairs.blocks)
    for (std::size_t k = 0; k < PairBlock::pairs; ++k)
      b.mass[k] = reduced_mass(bodies.motions[b.lower[k]], bodies.motions[b.higher[k]]);
  for (WallContact& c : wall_contacts) c.mass = 1 / bodies.motions[c.grain].inverse_mass;
}

/// Of the ways that grains have gone since the list was made, the longest [skins].
double NeighbourList::furthest(const Bodies& bodies) const noexcept {
  double most = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    most = std::max(most, inverse_skin_[i] * inverse_skin_[i] * norm2(bodies.spheres[i].position - origin_[i]));
  return std::sqrt(most);
}

bool NeighbourList::covers(const Bodies& bodies) noexcept {
  if (origin_.size() != bodies.size()) return false;
  double most = 0;
  bool others = false, heavier = false;   // once over all that bodies hold, which is more than a cache does
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Sphere& sphere = bodies.spheres[i];
    const double inverse_mass = bodies.motions[i].inverse_mass;
    const Vec3 moved = box_.shortest(sphere.position - origin_[i]);
    origin_[i] = sphere.position - moved;   // the image that belongs to the body
    const double way = norm2(moved);
    others |= sphere.radius != radius_[i] || (inverse_mass == 0) != (fixed_[i] != 0) || (fixed_[i] && way > 0);
    heavier |= inverse_mass != inverse_mass_[i];
    most = std::max(most, inverse_skin_[i] * inverse_skin_[i] * way);
  }
  travelled_ = std::sqrt(most);
  if (others || !(travelled_ <= 1)) return false;
  if (heavier) weigh(bodies);
  return true;
}

bool NeighbourList::still_covers(const Bodies& bodies) noexcept {
  constexpr double sure = 1 - 1e-9;   // of sums of many steps
  if (travelled_ <= sure) return true;
  travelled_ = furthest(bodies);
  return travelled_ <= sure;
}

void NeighbourList::rebuild(const Bodies& bodies, double dt, const ContactHistory& history) {
  const std::size_t n = bodies.size();
  origin_.resize(n), inverse_skin_.resize(n), radius_.resize(n), inverse_mass_.resize(n), reach_.resize(n),
      fixed_.resize(n);
  double largest = 0, smallest = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < n; ++i) {
    const Sphere& sphere = bodies.spheres[i];
    const double skin = skin_of(sphere, bodies.motions[i], dt);
    origin_[i] = sphere.position;
    inverse_skin_[i] = skin > 0 ? 1 / skin : 0;
    radius_[i] = sphere.radius;
    inverse_mass_[i] = bodies.motions[i].inverse_mass;
    reach_[i] = sphere.radius + skin + (films_ ? film_reach * sphere.radius : 0);
    fixed_[i] = bodies.motions[i].inverse_mass == 0;
    largest = std::max(largest, 2 * sphere.radius), smallest = std::min(smallest, 2 * sphere.radius);
  }
  most_unlike_radii_ = (1 + largest / smallest) / 2 * (1 + 1e-6);
  travelled_ = 0;
  check_periodic_sides(box_, largest);
  list_pairs(bodies);
  list_walls(bodies);
  place_loads(n);
  load(history);
}

void NeighbourList::list_pairs(const Bodies& bodies) {
  find_near_pairs(box_, origin_, reach_, fixed_, pairs.ids);
  const std::size_t n = pairs.size();
  pairs.blocks.assign((n + PairBlock::pairs - 1) / PairBlock::pairs, {});
  pairs.wet_blocks.assign(wet_ ? pairs.blocks.size() : 0, {});
  pairs.rolling.resize(rolls_ ? n : 0);
  for (std::size_t pair = 0; pair < n; ++pair) {
    PairBlock& block = pairs.blocks[pair / PairBlock::pairs];
    const std::size_t k = pair % PairBlock::pairs;
    const auto i = pairs.ids.lower[pair], j = pairs.ids.higher[pair];
    const double sum = radius_[i] + radius_[j];
    const float inverse = 1 / static_cast<float>(sum);
    block.lower[k] = i, block.higher[k] = j;
    block.radius_sum[k] = sum;
    block.inverse_radius_sum[k] = inverse;
    block.root_radius[k] = std::sqrt(static_cast<float>(radius_[i]) * static_cast<float>(radius_[j]) * inverse);
    block.mass[k] = reduced_mass(bodies.motions[i], bodies.motions[j]);
    if (wet_)
      pairs.wet_blocks[pair / PairBlock::pairs].viscous_speed[k] =
          static_cast<float>(wet_->viscous_speed(solid(bodies, i), solid(bodies, j)));
  }
}

void NeighbourList::list_walls(const Bodies& bodies) {
  wall_contacts.clear();
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    const Sphere& sphere = bodies.spheres[i];
    if (fixed_[i]) continue;
    const double reach = reach_[i] + (films_ ? (FilmLaw::thickest - film_reach) * sphere.radius : 0);   // R* = r
    for (std::uint32_t w = 0; w < walls_.size(); ++w) {
      if (!(walls_[w].depth(sphere.position, reach) > 0)) continue;
      wall_contacts.push_back({i, w, std::sqrt(sphere.radius), 1 / inverse_mass_[i], 0, {}});
      if (wet_) wall_contacts.back().viscous_speed = wet_->viscous_speed_at_wall(solid(bodies, i));
    }
  }
}

/// Finds the shortest ring in which nearly all loads of pairs are still there when they are asked for.
void NeighbourList::place_pairs(std::size_t grains) {
  constexpr std::size_t shortest = 64, most_far = 16;   // blocks; one pair in so many
  constexpr std::size_t kinds = 32;
  first_pair_.resize(grains + 1);
  std::uint32_t pair = 0;
  for (std::uint32_t i = 0; i < grains; ++i)
    for (first_pair_[i] = pair; pair < pairs.size() && pairs.ids.lower[pair] == i;) ++pair;
  first_pair_[grains] = pair;
  loads.far.clear();
  loads.ring_blocks = std::max<std::size_t>(pairs.blocks.size(), 1);
  if (summed_at_once_ == 0) return;

  const auto blocks_needed = [&](std::size_t k) {   // from the pair's to the last that is met before its load is read
    const std::size_t next = (pairs.ids.higher[k] | (summed_at_once_ - 1)) + 1;
    return blocks_of_grains_below(std::min(grains, next)) - k / PairBlock::pairs;
  };
  std::size_t count[kinds] = {}, longer = pairs.size();   // by the power of two that is enough
  for (std::size_t k = 0; k < pairs.size(); ++k) ++count[std::bit_width(blocks_needed(k) - 1)];
  std::size_t ring = 1;
  for (std::size_t kind = 0; ring < shortest || longer * most_far > pairs.size(); ++kind)
    ring = std::size_t{1} << kind, longer -= count[kind];
  if (ring >= loads.ring_blocks) return;
  loads.ring_blocks = ring;
  auto place = static_cast<std::uint32_t>(ring * PairBlock::pairs);
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (blocks_needed(k) > ring) loads.far.push_back({static_cast<std::uint32_t>(k), place++});
}

void NeighbourList::keep_far_loads(std::size_t met, std::size_t& next) noexcept {
  for (; next < loads.far.size() && loads.far[next].pair < met * PairBlock::pairs; ++next)
    loads.load[loads.far[next].place] = loads.load[loads.in_ring(loads.far[next].pair)];
}

/// Gives every contact a place, and every grain the places of its contacts in order of its partners' ids, walls last.
void NeighbourList::place_loads(std::size_t grains) {
  place_pairs(grains);
  loads.first_wall = loads.ring_blocks * PairBlock::pairs + loads.far.size();
  const auto at = [](std::size_t load) { return static_cast<std::uint32_t>(load * sizeof(ContactLoad)); };
  const std::size_t last = loads.first_wall + wall_contacts.size();
  constexpr std::size_t most = UINT32_MAX / sizeof(ContactLoad);   // whatever the numbering, and so the ring
  if (const std::size_t all = pairs.size() + wall_contacts.size() + PairBlock::pairs; all > most)
    throw Error(ErrorKind::study_invalid,
                fmt::format("grains: {} candidates for contact, at most {} fit into the list", all, most),
                "fewer grains: about 45 million of a settled bed fit");
  const std::uint32_t none = at(last);
  loads.load.assign(last + 1, {});
  loads.places.resize(grains);
  loads.further_as_higher.clear(), loads.further_as_lower.clear();
  std::vector<std::uint8_t> higher(grains, 0), lower(grains, 0);   // direct places in use
  std::ranges::fill(loads.places, ContactPlaces{{none, none, none, none}, {none, none, none, none}});
  const auto add = [at](auto& direct, std::uint8_t& used, auto& further, std::uint32_t grain, std::size_t load) {
    if (used < ContactPlaces::direct) direct[used++] = at(load);
    else further.push_back({grain, at(load)});
  };
  std::size_t touch = 0, far = 0;
  for (std::uint32_t i = 0; i < grains; ++i) {
    ContactPlaces& own = loads.places[i];
    for (std::size_t pair = first_pair_[i]; pair < first_pair_[i + 1]; ++pair) {
      const auto j = pairs.ids.higher[pair];
      const bool is_far = far < loads.far.size() && loads.far[far].pair == pair;
      const std::size_t place = is_far ? loads.far[far++].place : loads.in_ring(pair);
      add(own.as_lower, lower[i], loads.further_as_lower, i, place);
      add(loads.places[j].as_higher, higher[j], loads.further_as_higher, j, place);
    }
    for (; touch < wall_contacts.size() && wall_contacts[touch].grain == i; ++touch)
      add(own.as_lower, lower[i], loads.further_as_lower, i, loads.first_wall + touch);
  }
  std::ranges::stable_sort(loads.further_as_higher, {}, &FurtherPlace::grain);
  loads.further_as_higher.push_back({UINT32_MAX, none}), loads.further_as_lower.push_back({UINT32_MAX, none});
}

void NeighbourList::recall(const ContactHistory& history) {
  const auto same = [this](const auto& given, const auto& kept) {
    return given.size() == std::min(kept_count_, kept.size()) && std::equal(given.begin(), given.end(), kept.begin());
  };
  if (same(history.lower, kept_.lower) && same(history.higher, kept_.higher) && same(history.spring, kept_.spring) &&
      same(history.damping, kept_.damping) && same(history.rolling, kept_.rolling))
    return;
  load(history);
}

void NeighbourList::load(const ContactHistory& history) {
  std::size_t pair = 0, touch = 0;
  for (PairBlock& b : pairs.blocks)
    for (std::size_t k = 0; k < PairBlock::pairs; ++k) b.depth[k] = b.spring_x[k] = b.spring_y[k] = b.spring_z[k] = 0;
  for (WetBlock& b : pairs.wet_blocks) std::ranges::fill(b.damping, -1.0f);
  std::ranges::fill(pairs.rolling, Vec3{});
  for (auto& contact : wall_contacts)
    contact.depth = 0, contact.spring = {}, contact.damping = -1, contact.rolling = {};
  const bool damped = wet_ && !history.damping.empty(), rolls = rolls_ && !history.rolling.empty();
  for (std::size_t h = 0; h < history.size(); ++h) {
    const auto lower = history.lower[h], higher = history.higher[h];
    if (higher >= static_cast<std::uint32_t>(Wall::x_low)) {
      while (touch < wall_contacts.size() &&
             before(wall_contacts[touch].grain, static_cast<std::uint32_t>(walls_[wall_contacts[touch].wall].name),
                    lower, higher))
        ++touch;
      if (touch < wall_contacts.size() && wall_contacts[touch].grain == lower &&
          static_cast<std::uint32_t>(walls_[wall_contacts[touch].wall].name) == higher) {
        wall_contacts[touch].spring = history.spring[h];
        if (damped) wall_contacts[touch].damping = history.damping[h];
        if (rolls) wall_contacts[touch].rolling = history.rolling[h];
      }
    } else {
      while (pair < pairs.size() && before(pairs.ids.lower[pair], pairs.ids.higher[pair], lower, higher)) ++pair;
      if (pair < pairs.size() && pairs.ids.lower[pair] == lower && pairs.ids.higher[pair] == higher) {
        PairBlock& block = pairs.blocks[pair / PairBlock::pairs];
        const std::size_t k = pair % PairBlock::pairs;
        block.spring_x[k] = static_cast<float>(history.spring[h].x);
        block.spring_y[k] = static_cast<float>(history.spring[h].y);
        block.spring_z[k] = static_cast<float>(history.spring[h].z);
        if (damped) pairs.wet_blocks[pair / PairBlock::pairs].damping[k] = static_cast<float>(history.damping[h]);
        if (rolls) pairs.rolling[pair] = history.rolling[h];
      }
    }
  }
}

/// Of pairs [first, last), those that touch, behind the n that are kept; returns how many are kept then. Without a branch
/// on what touches: every candidate is written, and overwritten by the next if it is apart.
std::size_t NeighbourList::keep_pairs(std::size_t first, std::size_t last, std::size_t n) noexcept {
  std::uint32_t *const lower = kept_.lower.data(), *const higher = kept_.higher.data();
  Vec3* const spring = kept_.spring.data();
  while (first < last) {
    const PairBlock& b = pairs.blocks[first / PairBlock::pairs];
    const std::size_t in_block = std::min(last, (first / PairBlock::pairs + 1) * PairBlock::pairs);
    for (; first < in_block; ++first) {
      const std::size_t k = first % PairBlock::pairs;
      lower[n] = b.lower[k], higher[n] = b.higher[k];
      spring[n] = {b.spring_x[k], b.spring_y[k], b.spring_z[k]};
      if (wet_) kept_.damping[n] = pairs.damping(first);
      if (rolls_) kept_.rolling[n] = pairs.rolling[first];
      n += b.depth[k] > 0;
    }
  }
  return n;
}

void NeighbourList::save(ContactHistory& history) {
  const std::size_t most = pairs.size() + wall_contacts.size() + 1;
  kept_.lower.resize(most), kept_.higher.resize(most), kept_.spring.resize(most);
  kept_.damping.resize(wet_ ? most : 0), kept_.rolling.resize(rolls_ ? most : 0);
  std::size_t n = 0, pair = 0;
  for (const WallContact& c : wall_contacts) {   // after the pairs whose lower grain is theirs
    n = keep_pairs(pair, first_pair_[c.grain + 1], n), pair = first_pair_[c.grain + 1];
    kept_.lower[n] = c.grain, kept_.higher[n] = static_cast<std::uint32_t>(walls_[c.wall].name);
    kept_.spring[n] = c.spring;
    if (wet_) kept_.damping[n] = c.damping;
    if (rolls_) kept_.rolling[n] = c.rolling;
    n += c.depth > 0;
  }
  kept_count_ = n = keep_pairs(pair, pairs.size(), n);
  const auto hand_over = [n](auto& to, const auto& from) {
    to.assign(from.begin(), from.begin() + static_cast<std::ptrdiff_t>(std::min(n, from.size())));
  };
  hand_over(history.lower, kept_.lower), hand_over(history.higher, kept_.higher);
  hand_over(history.spring, kept_.spring);
  hand_over(history.damping, kept_.damping), hand_over(history.rolling, kept_.rolling);
}

}   // namespace bedload

// A half list with a skin per grain; the memory of the contacts is merged into it, both being sorted alike.
#include "solver/grains/neighbour_list.hpp"

#include <algorithm>

#include "solver/grains/film_law.hpp"

namespace bedload {
namespace {

// Wide enough for some tens of steps of a moving grain, narrow for one at rest: most listed pairs touch. (Measured: 12 to
// 30 steps cost the same in an eroding bed, 50 a tenth more.)
double skin_of(const Body& body, double dt) {
  if (body.inverse_mass == 0) return 0;
  const double diameter = 2 * body.radius;
  return std::min(0.01 * diameter + 1.3 * 25 * dt * norm(body.velocity), 0.2 * diameter);
}

// R* of two grains is at most a quarter of r_i + r_j, so that these parts reach the thickest film.
constexpr double film_reach = FilmLaw::thickest / 4;

double reduced_mass(const Body& a, const Body& b) { return 1 / (a.inverse_mass + b.inverse_mass); }

bool before(std::uint32_t lower_a, std::uint32_t higher_a, std::uint32_t lower_b, std::uint32_t higher_b) {
  return lower_a != lower_b ? lower_a < lower_b : higher_a < higher_b;
}

}   // namespace

NeighbourList::NeighbourList(const BedScene& scene, const WetRestitution* wet, bool films)
    : box_(scene), walls_(walls_of(scene)), wet_(wet), films_(films), rolls_(scene.grains.rolling_friction > 0) {}

bool NeighbourList::same_grains(std::span<const Body> bodies) const noexcept {
  if (origin_.size() != bodies.size()) return false;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (bodies[i].radius != radius_[i] || (bodies[i].inverse_mass == 0) != (inverse_mass_[i] == 0)) return false;
  return true;
}

/// Masses of the contacts, if any grain's has changed.
void NeighbourList::weigh(std::span<const Body> bodies) noexcept {
  if (std::ranges::equal(bodies, inverse_mass_, {}, &Body::inverse_mass)) return;
  std::ranges::transform(bodies, inverse_mass_.begin(), &Body::inverse_mass);
  for (std::size_t k = 0; k < pairs.size(); ++k)
    pairs.mass[k] = reduced_mass(bodies[pairs.ids.lower[k]], bodies[pairs.ids.higher[k]]);
  for (WallContact& c : wall_contacts) c.mass = 1 / bodies[c.grain].inverse_mass;
}

bool NeighbourList::covers(std::span<const Body> bodies) noexcept {
  if (!same_grains(bodies)) return false;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Vec3 moved = box_.shortest(bodies[i].position - origin_[i].position);
    origin_[i].position = bodies[i].position - moved;   // the image that belongs to the body
  }
  if (!still_covers(bodies)) return false;
  weigh(bodies);
  return true;
}

bool NeighbourList::still_covers(std::span<const Body> bodies) const noexcept {
  bool inside = true;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    inside &= norm2(bodies[i].position - origin_[i].position) <= origin_[i].skin2;
  return inside;
}

void NeighbourList::rebuild(std::span<const Body> bodies, double dt, const ContactHistory& history) {
  const std::size_t n = bodies.size();
  origin_.resize(n), radius_.resize(n), inverse_mass_.resize(n), reach_.resize(n), position_.resize(n),
      fixed_.resize(n);
  double largest = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double skin = skin_of(bodies[i], dt);
    origin_[i] = {bodies[i].position, skin * skin};
    radius_[i] = bodies[i].radius;
    inverse_mass_[i] = bodies[i].inverse_mass;
    reach_[i] = bodies[i].radius + skin + (films_ ? film_reach * bodies[i].radius : 0);
    position_[i] = bodies[i].position;
    fixed_[i] = bodies[i].inverse_mass == 0;
    largest = std::max(largest, 2 * bodies[i].radius);
  }
  check_periodic_sides(box_, largest);
  list_pairs(bodies);
  list_walls(bodies);
  load(history);
}

void NeighbourList::list_pairs(std::span<const Body> bodies) {
  find_near_pairs(box_, position_, reach_, fixed_, pairs.ids);
  const std::size_t n = pairs.size();
  for (auto* array : {&pairs.root_radius, &pairs.mass, &pairs.depth, &pairs.spring_x, &pairs.spring_y, &pairs.spring_z})
    array->resize(n);
  pairs.viscous_speed.resize(wet_ ? n : 0), pairs.damping.resize(wet_ ? n : 0), pairs.rolling.resize(rolls_ ? n : 0);
  for (std::size_t k = 0; k < n; ++k) {
    const Body &a = bodies[pairs.ids.lower[k]], &b = bodies[pairs.ids.higher[k]];
    pairs.root_radius[k] = std::sqrt(a.radius * b.radius / (a.radius + b.radius));
    pairs.mass[k] = reduced_mass(a, b);
    if (wet_) pairs.viscous_speed[k] = wet_->viscous_speed(a, b);
  }
}

void NeighbourList::list_walls(std::span<const Body> bodies) {
  wall_contacts.clear();
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    const Body& body = bodies[i];
    if (fixed_[i]) continue;
    const double reach = reach_[i] + (films_ ? (FilmLaw::thickest - film_reach) * body.radius : 0);   // R* = r
    for (std::uint32_t w = 0; w < walls_.size(); ++w) {
      if (!(walls_[w].depth(body.position, reach) > 0)) continue;
      wall_contacts.push_back({i, w, std::sqrt(body.radius), 1 / body.inverse_mass, 0, {}});
      if (wet_) wall_contacts.back().viscous_speed = wet_->viscous_speed_at_wall(body);
    }
  }
}

void NeighbourList::load(const ContactHistory& history) {
  std::size_t pair = 0, touch = 0;
  for (auto* array : {&pairs.depth, &pairs.spring_x, &pairs.spring_y, &pairs.spring_z}) std::ranges::fill(*array, 0.0);
  std::ranges::fill(pairs.damping, -1.0);
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
        pairs.spring_x[pair] = history.spring[h].x;
        pairs.spring_y[pair] = history.spring[h].y;
        pairs.spring_z[pair] = history.spring[h].z;
        if (damped) pairs.damping[pair] = history.damping[h];
        if (rolls) pairs.rolling[pair] = history.rolling[h];
      }
    }
  }
}

void NeighbourList::save(ContactHistory& history) const {
  history.lower.clear(), history.higher.clear(), history.spring.clear(), history.damping.clear(),
      history.rolling.clear();
  const auto remember = [&](std::uint32_t lower, std::uint32_t higher, Vec3 spring) {
    history.lower.push_back(lower), history.higher.push_back(higher), history.spring.push_back(spring);
  };
  std::size_t touch = 0;
  const auto walls_of_grains_below = [&](std::uint32_t grain) {
    for (; touch < wall_contacts.size() && wall_contacts[touch].grain < grain; ++touch) {
      const WallContact& c = wall_contacts[touch];
      if (!(c.depth > 0)) continue;
      remember(c.grain, static_cast<std::uint32_t>(walls_[c.wall].name), c.spring);
      if (wet_) history.damping.push_back(c.damping);
      if (rolls_) history.rolling.push_back(c.rolling);
    }
  };
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (!(pairs.depth[k] > 0)) continue;
    walls_of_grains_below(pairs.ids.lower[k]);
    remember(pairs.ids.lower[k], pairs.ids.higher[k], {pairs.spring_x[k], pairs.spring_y[k], pairs.spring_z[k]});
    if (wet_) history.damping.push_back(pairs.damping[k]);
    if (rolls_) history.rolling.push_back(pairs.rolling[k]);
  }
  walls_of_grains_below(UINT32_MAX);
}

}   // namespace bedload

// Counted first, then all at once: nothing depends on the order in which films are visited but the last bits of sums.
#include "solver/grains/films.hpp"

#include <algorithm>

#include "solver/grains/grain_motion.hpp"

namespace bedload {
namespace {

struct Film {
  double gap, reduced_radius;   // [m]
  bool exists() const { return gap < FilmLaw::thickest * reduced_radius; }
};

Film film_of(const PairContacts& pairs, std::size_t k) {
  const double root_radius = pairs.root_radius(k);
  return {-static_cast<double>(pairs.depth(k)), root_radius * root_radius};
}
/// A stress-free surface carries no film.
Film film_of(const NeighbourList& list, const WallContact& contact) {
  const double radius = contact.root_radius * contact.root_radius;
  return {list.walls()[contact.wall].rough ? -contact.depth : radius, radius};
}

}   // namespace

/// How many films share each grain.
void Films::count(const NeighbourList& list) {
  std::ranges::fill(films_of_, 0.0);
  for (std::size_t k = 0; k < list.pairs.size(); ++k) {
    const double one = film_of(list.pairs, k).exists() ? 1 : 0;
    films_of_[list.pairs.ids.lower[k]] += one;
    films_of_[list.pairs.ids.higher[k]] += one;
  }
  for (const WallContact& c : list.wall_contacts) films_of_[c.grain] += film_of(list, c).exists() ? 1 : 0;
}

void Films::prepare(const Bodies& bodies, std::span<const Load> loads, std::span<const Push> push, double dt) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Motion& m = bodies.motions[i];
    velocity_[i] = m.inverse_mass == 0 ? m.velocity : pushed(m, loads[i].force, push[i], dt);
    mobility_[i] = films_of_[i] * push[i].damp * m.inverse_mass;
  }
}

// F = c v/(1 + dt c/m), m of the shares m_i/n_i and m_j/n_j that a pair has of its grains' masses: all films together
// then take at most the relative motion away, and never turn it round (G20).
Vec3 Films::add_forces(const NeighbourList& list, const Bodies& bodies, std::span<const Push> push, double dt,
                       std::span<Load> loads) {
  velocity_.resize(bodies.size()), mobility_.resize(bodies.size()), films_of_.resize(bodies.size());
  count(list);
  prepare(bodies, loads, push, dt);
  for (std::size_t k = 0; k < list.pairs.size(); ++k) {
    const Film film = film_of(list.pairs, k);
    if (!film.exists()) continue;
    const auto i = list.pairs.ids.lower[k], j = list.pairs.ids.higher[k];
    const Vec3 apart = list.box().shortest(bodies.spheres[j].position - bodies.spheres[i].position);
    const Vec3 normal = apart * (1 / norm(apart));
    const double closing = dot(velocity_[i] - velocity_[j], normal);
    const double c = law_.resistance(film.gap, film.reduced_radius, closing);
    const Vec3 force = c * closing / (1 + dt * c * (mobility_[i] + mobility_[j])) * normal;
    loads[i].force -= force;
    loads[j].force += force;
  }
  Vec3 on_walls;
  for (const WallContact& contact : list.wall_contacts) {
    const Film film = film_of(list, contact);
    if (!film.exists()) continue;
    const Vec3 normal = list.walls()[contact.wall].normal();
    const double closing = dot(velocity_[contact.grain], normal);   // walls move along themselves
    const double c = law_.resistance(film.gap, film.reduced_radius, closing);
    const Vec3 force = c * closing / (1 + dt * c * mobility_[contact.grain]) * normal;
    loads[contact.grain].force -= force;
    on_walls += force;
  }
  return on_walls;
}

}   // namespace bedload

// The liquid between two grains that are about to meet, meet, or part: lubrication.
#pragma once

#include <span>
#include <vector>

#include "solver/grains/film_law.hpp"
#include "solver/grains/neighbour_list.hpp"

namespace bedload {

/// The films of all pairs and walls at one instant. Each is implicit in the speed of its own pair; so that a grain among
/// many films is stable too, whatever the step, each film has its share of the grain's mass.
class Films {
 public:
  explicit Films(const BedScene& scene) : law_(scene) {}

  /// Adds the films' forces to `loads`, which hold all others. Depths are those
  /// of the contact pass of the same step. Returns the force of all grains on the walls through films [N].
  Vec3 add_forces(const NeighbourList&, const Bodies&, std::span<const Push> push, double dt, std::span<Load> loads);

 private:
  void prepare(const Bodies&, std::span<const Load>, std::span<const Push> push, double dt);
  void count(const NeighbourList&);

  FilmLaw law_;
  std::vector<Vec3> velocity_;     // that grains would have without films [m/s]
  std::vector<double> mobility_;   // change of it by an impulse on the share that each film has of a grain [1/kg]
  std::vector<double> films_of_;   // how many a grain has [-]
};

}   // namespace bedload

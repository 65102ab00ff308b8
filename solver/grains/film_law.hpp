// The film of liquid between two surfaces that approach, meet, or part: lubrication.
#pragma once

#include "solver/grains/bed_scene.hpp"

namespace bedload {

/// Resistance of a film to closing and opening, 6 pi mu R*^2 (1/h - 1/h_max): docs/physics_grains.md, (G18)-(G20).
class FilmLaw {
 public:
  explicit FilmLaw(const BedScene&);

  /// A film begins at this gap [R*], and is never taken thinner than that one, the roughness of surfaces [R*].
  static constexpr double thickest = 0.4, thinnest = 1e-4;

  /// Force per speed of approach [N s/m] at a gap [m] between surfaces, negative in a contact; zero beyond the film.
  double resistance(double gap, double reduced_radius, double speed) const noexcept;
  /// The gap at which its own pressure bends the surfaces of a film as much as it is thick [m]; not above half the
  /// thickest film.
  double elastic_gap(double reduced_radius, double speed) const noexcept;

 private:
  double viscous_force_;   // 6 pi mu [Pa s]
  double compliance_;      // 3 pi mu/(sqrt 2 Y*) [s]
};

/// q^(1/5) for q >= 0, from arithmetic alone: the same bits on every machine.
double fifth_root(double q) noexcept;

}   // namespace bedload

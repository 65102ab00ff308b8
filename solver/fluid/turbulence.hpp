// Turbulence below the size of the cells: Smagorinsky's eddy viscosity with wall laws (docs/physics_fluid.md, section 5).
#pragma once

#include <array>

#include "solver/fluid/mixing_length.hpp"
#include "solver/fluid/operators.hpp"
#include "solver/fluid/staggered_grid.hpp"

namespace bedload {

/// nu_t = l^2 |S| where the staggered stress stands: normal stresses at cell centres, shear stresses on edges. A function of
/// the velocity given to find(): nothing is remembered from step to step. On a no-slip wall nu_t is what makes
/// (nu + nu_t) du/dn, with the ghost's gradient, the stress of the wall law; where the sublayer is resolved it is zero.
class Turbulence {
 public:
  Turbulence(const StaggeredGrid&, double viscosity);

  /// `velocity` has its ghosts filled. Below `surface_height` [m], the surface of a bed (0 = none: the bottom wall), there
  /// are no eddies; `sand_roughness` k_s [m] is that of bed or bottom, 0 = smooth. Other walls are smooth.
  void find(const FaceFields& velocity, double lid_speed, double surface_height, double sand_roughness);

  /// out += factor div(nu_t (grad u + grad u^T)) on unknown faces. `velocity` has one ghost layer filled. Symmetric and
  /// negative: momentum passes between faces and to walls, energy is only taken.
  void add_force(const FaceFields& velocity, double factor, FaceFields& out) const;
  /// out -= factor times the diagonal of that operator (beside walls, where the ghost is a mirror image, somewhat less).
  void add_diagonal(double factor, FaceFields& out) const;
  /// What the eddy stress adds to the force on bottom and lid per rho_f [m4/s2], components x and y.
  WallShear wall_shear(const FaceFields& velocity) const;
  double largest() const { return largest_; }   // nu_t anywhere [m2/s]

  const Field<Centre>& at_centres() const { return centre_; }
  /// Component t: on the edges along t, at the lower corner of the other two directions.
  const FaceFields& at_edges() const { return edge_; }

 private:
  void find_surface_terms_of(const FaceFields& velocity, double lid_speed, double surface_height, double roughness);
  void find_strain(const FaceFields& velocity);
  void find_viscosity();
  void apply_wall_law(const FaceFields& velocity, int direction, bool high, double lid_speed, double surface_height,
                      double roughness);

  StaggeredGrid grid_;
  double viscosity_, filter_term_, largest_ = 0;
  std::array<SurfaceTerms, 3> terms_;
  Field<Centre> centre_;                // |S|^2, then nu_t
  FaceFields edge_;                     // (2 S_ab)^2, then nu_t
  std::array<Field<Centre>, 3> rest_;   // |S|^2 without the share of edges along t
};

}   // namespace bedload

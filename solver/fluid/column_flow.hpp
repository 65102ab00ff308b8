// The flow of a column: one velocity u(z) along x, averaged over the planes of a box that is periodic in x and y.
//
//   eps du/dt = eps d/dz[nu d(eps u + phi v)/dz] + d/dz(eps nu_t du/dz) + eps G/rho_f - exchange
//
// the volume-averaged balance of Revil-Baudard & Chauchat (J. Fluid Mech. 2013) and Maurin, Chauchat, Chareyre & Frey
// (Phys. Fluids 27, 2015, 113302), in the form of Model A: docs/physics_fluid.md, section 6.
#pragma once

#include <span>
#include <vector>

#include "solver/fluid/mixing_length.hpp"
#include "solver/sides.hpp"

namespace bedload {

/// Equal layers k = 0..n-1 from z_k = k h to z_{k+1}, on a bottom at rest; layers are meant to be much thinner than a grain.
struct Column {
  int layers = 0;
  double thickness = 0;        // h of a layer [m]
  double viscosity = 0;        // nu [m2/s]
  Top top = Top::lid;          // a lid that moves along x, or a free-slip plane
  double packing = 0;          // phi_max, at which grains leave eddies no room [-]; 0 = laminar
  double sand_roughness = 0;   // k_s of the bottom [m]; read only where the flow is turbulent
};

/// The grains as the column sees them; one entry per layer.
struct SolidLayers {
  std::vector<double> fraction;   // phi [-]
  std::vector<double> flux;       // phi v, v the mean streamwise velocity of the solid [m/s]
};

/// What grains take from the fluid by drag: rate u - pull [m/s2], the force per volume of layer and fluid density; one entry per
/// layer. Drag beta (u - v) has the rate beta/(rho_f A h) and the target v = pull/rate. Grains that turn against the fluid take a couple
/// turn_rate (du/dz)/2 - turn_pull besides, per volume and fluid density; empty: none.
struct LayerExchange {
  std::vector<double> rate;             // [1/s], >= 0
  std::vector<double> pull;             // [m/s2]
  std::vector<double> turn_rate = {};   // [m2/s], >= 0
  std::vector<double> turn_pull = {};   // [m2/s2]
};

struct ColumnDrive {
  double acceleration = 0;   // G/rho_f, of a stream down a slope g sin(alpha) [m/s2]
  double lid_speed = 0;      // [m/s]; read only under a lid
};

/// Momentum that changed hands in a step, per area and fluid density, means over the step [m2/s2]:
/// gained = driving - on_bottom - on_lid - on_grains, to rounding.
struct ColumnBooks {
  double gained = 0;      // of sum eps u h
  double driving = 0;     // what drives the fluid
  double on_bottom = 0;   // stress on the bottom, viscous, of eddies and of couples: u*^2 of a bare one
  double on_lid = 0;      // the same on the lid
  double on_grains = 0;   // by drag, and by the viscous stress that acts on their volume
};

class ColumnFlow {
 public:
  explicit ColumnFlow(const Column&);

  /// eps is kept at or above this: layers thinner than an overlap may hold more than their volume of solid.
  static constexpr double least_void = 0.01;

  /// Advances u [m/s, one entry per layer] by dt [s], backward Euler; eddies by one Newton step from those of the flow given.
  /// Neither viscosity nor exchange bounds dt. Grains stand still meanwhile; carry() answers to their moving.
  void step(std::span<double> u, const SolidLayers&, const LayerExchange&, const ColumnDrive&, double dt);

  /// du/dz of every layer [1/s], the difference between its edges; at a wall from the wall's own speed.
  void find_shear(std::span<const double> u, double lid_speed, std::vector<double>& out) const;

  /// Stresses of a flow as it stands, without a step: what stress_divergence(), stress() and clamps() tell of it next.
  void measure(std::span<const double> u, const SolidLayers&, double lid_speed);

  /// The fluid that grains displace on their way up or down takes its momentum along: sum eps u stays, a uniform flow too where eps is
  /// not clamped, and u makes no new extremes. phi before and after the grains moved, of the same solid volume.
  void carry(std::span<double> u, std::span<const double> before, std::span<const double> after);

  /// Of the last step or measure(), by layer [m/s2]: d/dz of the viscous stress per fluid density, of which a grain feels its volume times;
  /// where eps is clamped, the part of it that is left to the solid.
  std::span<const double> stress_divergence() const { return stress_divergence_; }
  /// Of the same, eps of every layer, as clamped [-].
  std::span<const double> void_fraction() const { return void_; }
  /// Of the same, at the edges z_0..z_n [m2/s2]: viscous stress plus that of eddies, and of couples in a step, per fluid density.
  std::span<const double> stress() const { return stress_; }
  const ColumnBooks& books() const { return books_; }
  /// Layers whose eps was clamped in it.
  int clamps() const { return clamps_; }

 private:
  static int find_void(std::span<const double> solid_fraction, std::vector<double>& out);
  void find_eddies(std::span<const double> u, std::span<const double> solid_fraction, double lid_speed);
  void find_lengths(std::span<const double> solid_fraction, double lid_slip);
  void find_stress(std::span<const double> u, const SolidLayers&, double lid_speed);
  void find_stress_divergence(const SolidLayers&);
  void add_couples(std::span<const double> u, const LayerExchange&, double lid_speed);
  void assemble(std::span<const double> u, const LayerExchange&, const ColumnDrive&, double dt);
  void solve();
  void book(std::span<const double> u, const SolidLayers&, const LayerExchange&, const ColumnDrive&, double dt);

  const Column column_;
  ColumnBooks books_;
  int clamps_ = 0;
  std::vector<double> void_, void_after_, stress_divergence_;   // layers
  std::vector<double> lower_, diagonal_, upper_, change_;       // layers: the tridiagonal system and its solution
  std::vector<double> conductance_;                             // edges: nu over the distance of what it joins [m/s]
  std::vector<double> eddies_;                                  // edges: the same of eps nu_t
  std::vector<double> turning_;                                 // edges: the same of grains that turn against the flow
  std::vector<double> square_of_length_;                        // edges: l^2 [m2]
  std::vector<double> viscous_, stress_;                        // edges: stresses per fluid density [m2/s2]
  std::vector<TurbulentSurface> lid_;
  SurfaceTerms lid_terms_;
  bool bare_ = true;   // no grains keep the eddies off the bottom
};

}   // namespace bedload

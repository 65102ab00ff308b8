// What grains and the layers of a column exchange, with one set of weights: the slices of each sphere.
#pragma once

#include <span>
#include <vector>

#include "solver/fluid/column_flow.hpp"
#include "solver/grains/grains.hpp"

namespace bedload {

/// The part of each grain's volume that lies in each layer, by id. What lies beyond bottom and top counts in the outermost
/// layers: the parts of a grain add up to 1.
struct GrainSlices {
  std::vector<std::size_t> first;   // lowest layer of the grain
  std::vector<std::size_t> begin;   // [grains + 1]; the parts of grain p are part[begin[p]] to part[begin[p + 1]]
  std::vector<double> part;         // [-]
};
void find_slices(const Column&, const Grains&, GrainSlices&);

/// phi and phi v of every layer of a box of that area [m2]; fixed grains have v = 0.
void average_grains(const Column&, const Grains&, const GrainSlices&, double area, SolidLayers&);

/// Mean of a profile [one value per layer] over the volume of a grain: where the profile is linear, its value at the grain's
/// own height, linearly interpolated.
double sample(const GrainSlices&, std::size_t grain, std::span<const double> profile);

/// How each grain answers to the flow over a step, along x: what the coupled step has in `flow.drag`, `relaxation`, `ballistic`
/// and `flow.force` (docs/physics_coupling.md, section 3). By id.
struct GrainResponse {
  std::span<const Vec3> drag;         // beta/rho_f, or with added mass (beta T + m_a)/T [m3/s]
  std::span<const Vec3> relaxation;   // a = drag T/M [-]; 0 for fixed grains
  std::span<const Vec3> ballistic;    // vt: velocity at the end of the step without drag [m/s]
  std::span<const Vec3> force;        // explicit forces on the grain, per rho_f [m4/s2]; empty: none
};

/// Deposits drag/(1 + a) (u - vt) + force with the grains' slices: rate and pull of every layer.
void find_exchange(const Column&, const GrainSlices&, const GrainResponse&, double area, LayerExchange&);

/// What added mass adds to that, by id: the fluid's increments as well as the grains' resist.
struct AddedMass {
  std::span<const double> volume;     // m_a = C_A V_p [m3]
  std::span<const Vec3> flow;         // u^n at the grains, as sampled [m/s]
  std::span<const Vec3> relaxation;   // a, m_a in it [-]
};
/// The part of the force that the flow u^n of the step's start has, into the pull of every layer: each slice answers to the u^n of its own
/// layer, as it does to u at the end. Leaves sum m_a/(A h) of every layer in `along` [-].
void add_added_mass(const Column&, const Grains&, const GrainSlices&, const AddedMass&, std::span<const double> u,
                    double area, double dt, LayerExchange& out, std::vector<double>& along);

/// Deposits the couples c' (curl u/2 - omega_t) about y, of `strength` = T c'_p [m5] and `target` = omega_t,p [rad/s] by id.
void find_couples(const Column&, const GrainSlices&, std::span<const Vec3> strength, std::span<const Vec3> target,
                  double area, double dt, LayerExchange& out);

/// Force on each grain along x, per rho_f [m4/s2], of the flow u at the end of the step: what find_exchange() took from the
/// layers, to rounding. The viscous stress on the grain's volume comes on top (ColumnFlow::stress_divergence).
void find_forces(const GrainSlices&, const GrainResponse&, std::span<const double> u, std::vector<double>& out);

}   // namespace bedload

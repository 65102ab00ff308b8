// Small scenes for tests: boxes of fluid, with or without grains.
#pragma once

#include <array>

#include "solver/scene.hpp"
#include "solver/state.hpp"

namespace bedload::test {

inline constexpr std::array<Side, 3> periodic_box = {Side::periodic, Side::periodic, Side::periodic};
inline constexpr std::array<Side, 3> channel = {Side::periodic, Side::periodic, Side::wall};
inline constexpr std::array<Side, 3> closed_box = {Side::wall, Side::wall, Side::wall};

/// A box of water (1000 kg/m3) of kinematic viscosity nu, cells of edges h [m], no gravity, no grains.
Scene fluid_scene(std::array<int, 3> cells, Vec3 h, std::array<Side, 3> sides, double viscosity);

/// Gives the scene grains of diameter d [m] and density ratio s, as soft as a slow test allows: `speed` [m/s] is the fastest
/// collision expected, met with an overlap of about 1 % of d; DEM step 0.2 Rayleigh times, fluid interval 10 of them.
void add_grains(Scene&, double diameter, double density_ratio, double speed);

/// Fluid at rest around grains at the given places, all alike, at rest.
State state_of(const Scene&, const std::vector<Vec3>& places, bool fixed);

/// nx x ny x nz places of a simple cubic arrangement that fills the block from `low` to `high`, each moved by up to `jitter`
/// [m] in every direction (counter-based random numbers: the same on every machine).
std::vector<Vec3> cubic_places(std::array<int, 3> count, Vec3 low, Vec3 high, double jitter, unsigned seed);

/// eps on the faces for the grains where they are now.
FaceFields face_void_fraction(const Scene&, const State&);

/// Grains all over the box, 0.3 mm and up to a fifth more, of 2650 kg/m3, at random velocities of up to 0.5 m/s.
Grains random_grains(const StaggeredGrid&, std::size_t count, unsigned seed);

/// Momentum of the fluid [kg m/s].
Vec3 fluid_momentum(const Scene&, const State&);

/// Total momentum of fluid and grains [kg m/s].
Vec3 total_momentum(const Scene&, const State&);

/// Kinetic energy of fluid and grains, spin too [J].
double kinetic_energy(const Scene&, const State&);

}   // namespace bedload::test

// BedScene: the part of a scene that packing a bed may see; its digest is what lets cases share a bed.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "base/vec3.hpp"
#include "solver/sides.hpp"

namespace bedload {

struct FluidProperties {
  double density = 0;     // rho_f [kg/m3]
  double viscosity = 0;   // kinematic, nu [m2/s]
};

struct GrainProperties {
  double diameter = 0;           // mean [m]
  double density = 0;            // [kg/m3]
  double spread = 0;             // standard deviation / mean of diameters, normal, cut at 2 deviations [-]
  double friction = 0;           // Coulomb [-], grain-grain and grain-wall
  double restitution = 0;        // normal, of a dry collision [-]
  double poisson = 0;            // [-]
  double young_modulus = 0;      // [Pa], resolved ("auto" is computed before a Scene exists)
  double rolling_friction = 0;   // mu_r [-]
};

/// Where the grains come from.
struct BedSource {
  enum class Kind { poured, lattice, suspension, file, none };
  Kind kind = Kind::none;
  std::uint64_t count = 0;   // grains; with kind file: rows
  std::string csv;           // kind file: the bytes of the table (grain_table.hpp)
  std::uint64_t seed = 1;    // packing
  bool fixed = false;        // kind suspension: the grains never move
};

/// The part that packing a bed may see.
struct BedScene {
  FluidProperties fluid;
  GrainProperties grains;
  BedSource source;
  Vec3 length;   // box [m]
  std::array<Side, 3> sides{};
  Top top = Top::lid;
  Vec3 gravity;          // [m/s2], tilted by the slope
  double dem_step = 0;   // [s]
};

}   // namespace bedload

// The inner loops of contacts and motion, compiled once for every kind of processor; all give the same bits.
#pragma once

#include <cstddef>
#include <cstdint>

#include "solver/grains/bodies.hpp"
#include "solver/grains/hertz_mindlin.hpp"
#include "solver/grains/pair_block.hpp"
#include "solver/grains/wet_table.hpp"

namespace bedload {

/// The candidate pairs and what their law reads.
struct PairPass {
  const Sphere* spheres;
  PairBlock* blocks;         // depth and springs are renewed
  WetBlock* wet_blocks;      // dampings are renewed; null: no liquid between the grains
  ContactLoad* loads;        // a ring that blocks enter turn by turn
  std::size_t ring_blocks;   // of loads

  ContactModuli<float> material;
  DampingOf<float> damping;   // of all, where there is no liquid in the contacts
  WetTable wet;               // only with wet_blocks
  float root_shear_ratio;     // of S_t/S_n [-]

  double length[3];           // of the box [m]
  double inverse_length[3];   // 0: not periodic [1/m]
  float dt;                   // [s]
};

/// Where the loads of a grain's contacts are [bytes from the first]: as the higher grain of its pairs, then as the lower,
/// then at walls. Places that are not needed are those of a load that is always zero.
struct ContactPlaces {
  static constexpr std::size_t direct = 4;
  std::uint32_t as_higher[direct], as_lower[direct];
};
static_assert(sizeof(ContactPlaces) == 32);

/// A place [bytes] beyond those that a grain has direct.
struct FurtherPlace {
  std::uint32_t grain, place;
};

struct SumPass {
  const Sphere* spheres;
  const ContactLoad* contact_loads;
  const ContactPlaces* places;
  const FurtherPlace *further_as_higher, *further_as_lower;   // by grain; after the last, one of a grain that is none
};

struct MotionPass {
  Sphere* spheres;
  Motion* motions;
  const Push* push;
  const Vec3* spin_push;        // [rad/s2]; null: none
  const double* inverse_skin;   // of the neighbour list; 0: as if it were endless [1/m]
  LoadSum* sums;                // over the sub-steps
  bool begins_sums;             // whatever they held
  double dt;                    // [s]
};

/// `first` and `last` are a range of blocks of pairs, or of grains.
struct GrainKernels {
  const char* instructions;
  /// Overlap, law, springs and loads of pairs.
  void (*meet)(const PairPass&, std::size_t first, std::size_t last);
  /// Loads of grains from those of their contacts, in order of partner id. `loads` begins with that of `first`.
  void (*add_up)(SumPass&, std::size_t first, std::size_t last, Load* loads);
  /// Symplectic Euler: velocity and spin from the loads, then place from the new velocity. Fixed grains stay as they
  /// are. Returns the square of a speed that no grain exceeds [skins2/s2].
  double (*move)(const MotionPass&, std::size_t first, std::size_t last, const Load* loads);
};

/// The fastest that this processor can run.
const GrainKernels& grain_kernels();
/// All that it can run, for tests.
extern const GrainKernels grain_kernels_v3, grain_kernels_v4;
bool runs_v4();

}   // namespace bedload

// Candidate pairs as the contact pass reads them: thirty-two at a time.
#pragma once

#include <cstddef>
#include <cstdint>

namespace bedload {

/// One stretch of memory for everything about 32 pairs. Arrays of their own, all beginning on a page, would want the
/// same few places of the first-level cache.
struct alignas(64) PairBlock {
  static constexpr std::size_t pairs = 32;
  std::uint32_t lower[pairs] = {}, higher[pairs] = {};   // ids; in pairs that only fill the last block 0
  double radius_sum[pairs] = {};                         // r_i + r_j [m]; 0: apart, whatever their places
  float inverse_radius_sum[pairs] = {};                  // [1/m]
  float root_radius[pairs] = {};                         // sqrt(R*) [m^1/2]
  float mass[pairs] = {};                                // m* [kg]
  float depth[pairs] = {};                               // at the last pass [m]; not positive: apart
  float spring_x[pairs] = {}, spring_y[pairs] = {}, spring_z[pairs] = {};   // tangential spring [m]
};

/// What is added in a liquid.
struct alignas(64) WetBlock {
  float damping[PairBlock::pairs] = {};         // alpha, negative: apart [-]
  float viscous_speed[PairBlock::pairs] = {};   // of WetRestitution [m/s]
};

}   // namespace bedload

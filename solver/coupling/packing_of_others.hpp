// How closely other grains surround a grain: what decides whether it counts as a lone one.
#pragma once

#include <span>
#include <vector>

#include "solver/coupling/void_fraction.hpp"

namespace bedload {

/// 1 for a lone grain, 0 in a bed or suspension, smooth between: what is right for a lone grain is blended in by this share
/// (docs/decisions/self_disturbance.md). crowded: packing of others from which on it is none [-].
constexpr double loneness(double packing_of_others, double crowded) noexcept {
  const double lone = crowded / 4, x = std::clamp((crowded - packing_of_others) / (crowded - lone), 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

/// By id; packing densities [-].
struct GrainPacking {
  std::vector<double> own;   // what a grain samples of its own volume
  std::vector<double>
      others;   // the larger of what it samples of all others, and of their mean over the planes at its height
  double crowded = 0.04;
  double loneness(std::size_t p) const noexcept { return bedload::loneness(others[p], crowded); }
};

/// `void_fraction` as grains read it; `sampled` the void fraction at each grain.
void find_packing(const StaggeredGrid&, const Grains&, const Field<Centre>& void_fraction,
                  std::span<const double> sampled, GrainPacking&, const KernelSmoothing& = {});

}   // namespace bedload

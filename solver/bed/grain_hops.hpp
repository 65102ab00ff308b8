// Hops and rests: how the motion of single grains begins, how far it carries them, and when it ends.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/grains/grains.hpp"

namespace bedload {

/// Where every grain is between its rests, by id, within the hold under way. A grain rests once it has been no faster than a
/// limit for longer than a time; a hop is what lies between two rests: from the last moment of the one to the first of the
/// next, which is known only when that has lasted.
struct GrainHops {
  std::vector<std::uint8_t> resting;   // 1 = at rest
  std::vector<double> last_fast;       // when it was last faster than the limit [s]; before the hold: the lowest number
  std::vector<double> left_rest;       // when the hop began [s], likewise; of a resting grain its last hop
  std::vector<double> way;             // along x since the hop began [m]
  std::vector<double> way_when_fast;   // of which until last_fast [m]
  bool operator==(const GrainHops&) const = default;
};

/// Sums of a measure, and its counts in bins that double in width: bin k of n holds 2^(k-6) <= measure/unit < 2^(k-5), the
/// first also what is less (or backwards), the last what is more.
struct Spread {
  static constexpr std::size_t bins = 16;
  static double lower_edge(std::size_t bin);   // per unit; of the first bin too

  /// Per unit, from the counts in all bins, as if the logarithms in a bin were spread evenly; nan where it lies in the first
  /// or the last bin, or nothing is counted.
  static double median(std::span<const double> histogram);

  double sum = 0, squares = 0;
  std::vector<double> histogram = std::vector<double>(bins);

  void add(double measure, double unit);
  double count() const;
  double mean() const;                 // 0 without a measure
  double standard_deviation() const;   // of the measures, by n - 1; 0 with fewer than two
  bool operator==(const Spread&) const = default;
};

/// What has been counted: grains that left rest, grains that came to rest (when that is known, a rest's least time after it
/// began), and whatever began since the hold did and has ended.
struct HopSums {
  double entrained = 0, deposited = 0;
  Spread hop_length, hop_duration, rest_time;   // [m] downstream, [s], [s]
  bool operator==(const HopSums&) const = default;
};

/// What makes a rest, and the units of the histograms.
struct RestRule {
  double speed;      // 0.01 sqrt(|s-1| g d) [m/s]
  double time;       // t_d [s]
  double diameter;   // d [m]
};

/// When a hold begins, `now` [s], grains no faster than the limit rest and the others move, both since before.
void begin_hops(const Grains&, double now, const RestRule&, GrainHops&);

/// Follows every grain through a step from `before` to `now` [s], which found it at `x_before` [m] in a box of `period` > 0
/// along x (0: not periodic); in order of id. What happens is added to `counted`, if that is given.
void follow_hops(const Grains&, std::span<const double> x_before, double period, double before, double now,
                 const RestRule&, GrainHops&, HopSums* counted);

}   // namespace bedload

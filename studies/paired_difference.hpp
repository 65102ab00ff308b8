// One thing changed, the same packings: what it does, and how well that is known.
#pragma once

#include <vector>

namespace bedload {

/// Mean over the packings of a difference, and how well it is known: two standard errors. nan: not measured.
struct PairedDifference {
  double mean = 0, uncertainty = 0;
  /// Whether it is more than noise; if not, `uncertainty` is a bound.
  bool seen() const;
  /// The error to reckon with: the difference, or its bound.
  double size() const;
};

/// A difference of one packing, and the standard error that its two runs leave it.
struct SingleDifference {
  double difference, error;
};

/// ln(theta_c of the other / theta_c of the base) of two thresholds, each anywhere in its bracket with a deviation of its half width over
/// sqrt(3). nan: one of them is censored.
SingleDifference log_ratio(double base, double base_lower, double base_upper, double other, double other_lower,
                           double other_upper);

/// 2 (other - base)/(other + base), from -2 to 2, of two numbers with their standard errors, which are not below zero and not both
/// zero: scatters alike for large changes and small ones, and knows what stands still.
SingleDifference symmetric_difference(double base, double base_error, double other, double other_error);

/// The same change in several packings; one list per change.
using Differences = std::vector<std::vector<SingleDifference>>;

/// Deviation of a packing's difference from the mean of its change, over all changes: two packings alone say nothing of it. 0
/// where no change has two packings: then it is not known.
double pooled_deviation(const Differences&);

/// Mean and uncertainty of one change, from what its runs leave open and from the pooled deviation.
PairedDifference paired(const std::vector<SingleDifference>&, double pooled);

/// A difference of logarithms as a relative one: exp(mean) - 1.
PairedDifference relative(const PairedDifference& logarithmic);

/// A symmetric difference as a relative one; seen where that is seen. The uncertainty is that towards zero; of what is not seen, the larger.
PairedDifference relative_of_symmetric(const PairedDifference& symmetric);

}   // namespace bedload

// One thing changed, the same packings: what it does, and how well that is known.
#pragma once

#include <string>
#include <vector>

namespace bedload {

/// Mean over the packings of a difference, and where it lies with 95 %. nan: not measured; bounds nan: how far packings scatter is not known.
struct PairedDifference {
  double mean = 0, low = 0, high = 0;
  bool known() const;
  /// Whether it is more than noise.
  bool seen() const;
  /// The error to reckon with: the farther of the two bounds.
  double worst() const;
};

/// A difference of one packing, and the standard error that its two runs leave it.
struct SingleDifference {
  double difference, error;
  std::string packing = {};
};

/// ln(theta_c of the other / theta_c of the base) of two thresholds, each anywhere in its bracket with a deviation of its half width over
/// sqrt(3). nan: one of them is censored.
SingleDifference log_ratio(double base, double base_lower, double base_upper, double other, double other_lower,
                           double other_upper);

/// 2 (other - base)/(other + base), from -2 to 2, of two numbers with their standard errors, which are not below zero and not both
/// zero: scatters alike for large changes and small ones, and knows what stands still.
SingleDifference symmetric_difference(double base, double base_error, double other, double other_error);

/// One change in several packings.
using Differences = std::vector<SingleDifference>;

/// Standard deviation of an outcome from packing to packing, and its degrees of freedom; 0: it is not known.
struct Scatter {
  double deviation = 0, freedom = 0;
};

/// From all changes against one base: what is left of the differences without the mean of each change and that of each packing, in which
/// the base's own scatter is common to all. Changes that lack a packing are left out, and those that change nothing at all; of one alone,
/// half the variance of its differences is its own.
Scatter scatter_of(const std::vector<Differences>&);

/// Mean and bounds of one change: Student's t times the scatter of both sides, but not below two standard errors of what its runs leave open.
PairedDifference paired(const Differences&, const Scatter&);

/// A difference of logarithms as a relative one: exp(d) - 1.
PairedDifference relative(const PairedDifference& logarithmic);

/// A symmetric difference as a relative one.
PairedDifference relative_of_symmetric(const PairedDifference& symmetric);

/// Of Student's t with so many degrees of freedom: 95 % lie between it and its negative (the textbooks' table, and from 11 on an
/// approximation good to 0.5 %).
double student_95(double freedom);

}   // namespace bedload

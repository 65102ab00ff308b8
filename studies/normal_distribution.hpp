// The normal distribution as a likelihood needs it, with all digits in the tails; and Student's, for intervals of few.
#pragma once

#include <cstddef>

namespace bedload {

/// ln Phi(z).
double log_normal_cdf(double z);

/// The logarithm of the probability that a standard normal deviate lies where it was seen to be, and its derivatives.
struct LogMass {
  double value, m, h, mm, mh, hh;
};

/// Below z: derivatives in m are those in z, h has no meaning.
LogMass log_mass_below(double z);
LogMass log_mass_above(double z);
/// Between m - h/2 and m + h/2, h > 0.
LogMass log_mass_between(double m, double h);

/// P(|T| < t) of Student's distribution with so many degrees of freedom, at least 1.
double student_within(double t, std::size_t freedom);

}   // namespace bedload

// Two curves fitted to a record: the flux law over holds, the decay of motion within one.
#pragma once

#include <optional>
#include <span>

namespace bedload {

/// q* = k (theta - theta_0)^n, n given: least squares of q*^(1/n) on theta, a straight line. Errors are standard errors from the
/// scatter about it, that of theta_0 = mean theta - mean q*^(1/n)/slope to first order.
struct FluxLaw {
  double exponent = 0;
  double threshold = 0, threshold_error = 0;       // theta_0 [-]: where the flux is extrapolated to nothing
  double coefficient = 0, coefficient_error = 0;   // k [-]
};
/// None from fewer than three points, or where the flux does not rise. `transport` q* >= 0, as many as `shields`.
std::optional<FluxLaw> fit_flux_law(std::span<const double> shields, std::span<const double> transport,
                                    double exponent);

/// Means of last + (first - last) exp(-t/T) over windows, by least squares, T between the spacing of the windows and their span.
struct Decay {
  double time = 0, time_error = 0;   // T [s] and its standard error, from the scatter
  double first = 0, last = 0;        // at t = 0, and what it goes to
};
/// None from fewer than six samples, where y does not fall, where T is best at an end of its range or its error is as large as
/// itself: then the samples do not resolve it. `time` [s] rises, since the beginning; y[n] is the mean from time[n - 1], at first from 0, to time[n].
std::optional<Decay> fit_decay(std::span<const double> time, std::span<const double> y);

}   // namespace bedload

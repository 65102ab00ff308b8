// Least squares in closed form; the one nonlinear parameter by a search on its logarithm.
#include "studies/transport_fits.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

namespace bedload {

namespace {

/// y = mean_y + slope (x - mean_x)
struct Line {
  double mean_x = 0, mean_y = 0, slope = 0, spread_x = 0,
         residual = 0;   // sums of squares, of x about its mean and of the rest
};

Line line_through(std::span<const double> x, std::span<const double> y) {
  Line line;
  const double count = double(x.size());
  for (std::size_t n = 0; n < x.size(); ++n) line.mean_x += x[n] / count, line.mean_y += y[n] / count;
  double mixed = 0;
  for (std::size_t n = 0; n < x.size(); ++n) {
    line.spread_x += (x[n] - line.mean_x) * (x[n] - line.mean_x);
    mixed += (x[n] - line.mean_x) * (y[n] - line.mean_y);
  }
  line.slope = line.spread_x > 0 ? mixed / line.spread_x : 0;
  for (std::size_t n = 0; n < x.size(); ++n) {
    const double off = y[n] - line.mean_y - line.slope * (x[n] - line.mean_x);
    line.residual += off * off;
  }
  return line;
}

/// Means of exp(-t/T) over windows that end at `time`, each beginning where the one before ends, the first at 0.
std::vector<double> faded(std::span<const double> time, double decay_time) {
  std::vector<double> means;
  double began = 0;
  for (const double end : time) {
    means.push_back(decay_time / (end - began) * (std::exp(-began / decay_time) - std::exp(-end / decay_time)));
    began = end;
  }
  return means;
}

/// What they change by with T.
std::vector<double> fading(std::span<const double> time, double decay_time) {
  std::vector<double> means;
  double began = 0;
  for (const double end : time) {
    const double a = began / decay_time, b = end / decay_time;
    means.push_back(((1 + a) * std::exp(-a) - (1 + b) * std::exp(-b)) / (end - began));
    began = end;
  }
  return means;
}

/// y against what is left of exp(-t/T), T given.
Line line_of_decay(std::span<const double> time, std::span<const double> y, double decay_time) {
  return line_through(faded(time, decay_time), y);
}

/// Var(T) = residual/(N - 3)/|what dy/dT has beyond the other two parameters|^2: the Schur complement of the normal equations.
double error_of(std::span<const double> time, const Line& line, double decay_time) {
  std::vector<double> change = fading(time, decay_time);
  for (double& c : change) c *= line.slope;
  const double own = line_through(faded(time, decay_time), change).residual;
  return std::sqrt(line.residual / double(time.size() - 3) / own);
}

}   // namespace

std::optional<FluxLaw> fit_flux_law(std::span<const double> shields, std::span<const double> transport,
                                    double exponent) {
  constexpr std::size_t fewest = 3;
  if (shields.size() < fewest) return std::nullopt;
  std::vector<double> root(transport.size());
  for (std::size_t n = 0; n < root.size(); ++n) root[n] = std::pow(transport[n], 1 / exponent);
  const Line line = line_through(shields, root);
  if (!(line.slope > 0)) return std::nullopt;

  const double count = double(shields.size()), variance = line.residual / (count - 2);
  const double back = line.mean_y / line.slope;   // from the mean theta to theta_0
  return FluxLaw{
      .exponent = exponent,
      .threshold = line.mean_x - back,
      .threshold_error = std::sqrt(variance * (1 / count + back * back / line.spread_x)) / line.slope,
      .coefficient = std::pow(line.slope, exponent),
      .coefficient_error = exponent * std::pow(line.slope, exponent - 1) * std::sqrt(variance / line.spread_x)};
}

std::optional<Decay> fit_decay(std::span<const double> time, std::span<const double> y) {
  constexpr std::size_t fewest = 6;
  constexpr int coarse = 64, halvings = 60;
  if (time.size() < fewest) return std::nullopt;
  const double span = time.back() - time.front(), spacing = span / double(time.size() - 1);
  const auto at = [&](double step) { return spacing * std::pow(span / spacing, step / coarse); };
  const auto rest = [&](double step) { return line_of_decay(time, y, at(step)).residual; };
  int best = 0;
  for (int k = 1; k <= coarse; ++k)
    if (rest(k) < rest(best)) best = k;
  if (best == 0 || best == coarse) return std::nullopt;

  double low = best - 1, high = best + 1;
  for (int n = 0; n < halvings; ++n) {   // thirds: the residual has one minimum between neighbours of the best
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    if (rest(a) < rest(b)) high = b;
    else low = a;
  }
  const double decay_time = at((low + high) / 2);
  const Line line = line_of_decay(time, y, decay_time);
  constexpr double rounding = 1e-9;   // what a constant, summed, may seem to fall by
  if (!(line.slope > rounding * std::abs(line.mean_y))) return std::nullopt;
  const double error = error_of(time, line, decay_time);
  if (!(error < decay_time)) return std::nullopt;
  const double last = line.mean_y - line.slope * line.mean_x;
  return Decay{decay_time, error, last + line.slope, last};
}

}   // namespace bedload

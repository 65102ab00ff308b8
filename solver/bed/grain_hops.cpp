// One pass over the grains per step; most of them rest, and cost a comparison.
#include "solver/bed/grain_hops.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "solver/bed/incipient_motion.hpp"

namespace bedload {

namespace {

constexpr double before_the_hold = std::numeric_limits<double>::lowest();
constexpr int first_exponent = -6;   // the first bin begins at 2^-6 units

}   // namespace

double Spread::lower_edge(std::size_t bin) { return std::ldexp(1, static_cast<int>(bin) + first_exponent); }

double Spread::median(std::span<const double> histogram) {
  const double half = std::accumulate(histogram.begin(), histogram.end(), 0.0) / 2;
  double below = 0;
  std::size_t bin = 0;
  while (bin + 1 < bins && below + histogram[bin] < half) below += histogram[bin++];
  if (half == 0 || bin == 0 || bin + 1 == bins) return std::numeric_limits<double>::quiet_NaN();
  return lower_edge(bin) * std::exp2((half - below) / histogram[bin]);
}

void Spread::add(double measure, double unit) {
  sum += measure, squares += measure * measure;
  const double units = measure / unit;
  const bool first = !(units > lower_edge(0));
  const int bin = first ? 0 : std::min(std::ilogb(units) - first_exponent, static_cast<int>(bins) - 1);
  histogram[static_cast<std::size_t>(bin)] += 1;
}

double Spread::count() const { return std::accumulate(histogram.begin(), histogram.end(), 0.0); }

double Spread::mean() const { return count() > 0 ? sum / count() : 0; }

double Spread::standard_deviation() const {
  const double n = count();
  return n > 1 ? std::sqrt(std::max(0.0, squares - sum * sum / n) / (n - 1)) : 0;
}

void begin_hops(const Grains& grains, double now, const RestRule& rule, GrainHops& hops) {
  const std::size_t n = grains.size();
  hops.resting.resize(n), hops.last_fast.resize(n);
  for (std::size_t p = 0; p < n; ++p) {
    hops.resting[p] = norm2(grains.velocity[p]) <= rule.speed * rule.speed;
    hops.last_fast[p] = hops.resting[p] ? before_the_hold : now;
  }
  hops.left_rest.assign(n, before_the_hold);
  hops.way.assign(n, 0), hops.way_when_fast.assign(n, 0);
}

void follow_hops(const Grains& grains, std::span<const double> x_before, double period, double before, double now,
                 const RestRule& rule, GrainHops& hops, HopSums* counted) {
  const double limit = rule.speed * rule.speed;
  for (std::size_t p = 0; p < grains.size(); ++p) {
    const bool fast = norm2(grains.velocity[p]) > limit;
    if (hops.resting[p]) {
      if (!fast) continue;
      if (counted) {
        counted->entrained += 1;
        if (hops.last_fast[p] > before_the_hold) counted->rest_time.add(before - hops.last_fast[p], rule.time);
      }
      hops.resting[p] = 0, hops.left_rest[p] = before, hops.way[p] = 0;
    }
    hops.way[p] += way_along_x(x_before[p], grains.position[p].x, period);
    if (fast) {
      hops.last_fast[p] = now, hops.way_when_fast[p] = hops.way[p];
    } else if (now - hops.last_fast[p] > rule.time) {
      hops.resting[p] = 1;
      if (!counted) continue;
      counted->deposited += 1;
      if (hops.left_rest[p] == before_the_hold) continue;
      counted->hop_length.add(hops.way_when_fast[p], rule.diameter);
      counted->hop_duration.add(hops.last_fast[p] - hops.left_rest[p], rule.time);
    }
  }
}

}   // namespace bedload

// Averages of the pace at work, and the work left divided by the cores.
#include "scheduler/time_left.hpp"

#include <algorithm>

namespace bedload {

double TimeLeft::of(const UnfinishedCase& c) { return c.rate > 0 ? std::max(0.0, 1 - c.fraction) / c.rate : -1; }

void TimeLeft::learn(const std::vector<UnfinishedCase>& cases) {
  for (const bool bed : {false, true}) {
    double sum = 0;
    int count = 0;
    for (const auto& c : cases)
      if (c.is_bed == bed && c.rate > 0) sum += 1 / c.rate, ++count;
    if (count > 0) whole_[bed] = sum / count;
  }
}

double TimeLeft::of_all(const std::vector<UnfinishedCase>& cases, int cores) {
  learn(cases);
  double sum = 0, longest = 0;
  for (const auto& c : cases) {
    const double left = c.rate > 0 ? of(c) : whole_[c.is_bed] < 0 ? -1 : (1 - c.fraction) * whole_[c.is_bed];
    if (left < 0) return -1;
    sum += left;
    longest = std::max(longest, left);
  }
  return std::max(longest, sum / std::max(1, cores));
}

}   // namespace bedload

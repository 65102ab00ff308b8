// How long a study has yet to run, from the pace of the cases at work.
#pragma once

#include <array>
#include <vector>

namespace bedload {

/// One unfinished case or bed.
struct UnfinishedCase {
  bool is_bed = false;
  double fraction = 0;   // of its planned model time that is done
  double rate = 0;       // fraction per wall second; 0 = not at work, or not known yet
};

/// Wall seconds; negative = unknown.
class TimeLeft {
 public:
  /// Of one case at its present rate.
  static double of(const UnfinishedCase&);
  /// Of all, shared by `cores`. Cases that have not started are taken to last as long as those at work, or as those that
  /// were at work last. An upper bound as far as plans are: a ramp ends soon after onset.
  double of_all(const std::vector<UnfinishedCase>&, int cores);

 private:
  void learn(const std::vector<UnfinishedCase>&);

  std::array<double, 2> whole_ = {-1, -1};   // usual wall time of a whole case [0] and bed [1]
};

}   // namespace bedload

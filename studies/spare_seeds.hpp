// Which packings a study still needs: seeds are used in batches until the threshold is known as well as was asked for.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scheduler/database.hpp"

namespace bedload {

struct Case;

/// When the seeds of a parameter set are enough.
struct SeedRule {
  std::optional<double>
      interval;    // half the width of the 95 % interval of theta_50, relative to it; none: all are run
  int batch = 4;   // judged after every so many
};

/// Ids of the cases that nobody needs as far as the stored thresholds go: the seeds of each parameter set are used in the
/// order of their numbers, a batch at a time, and the next batch is needed once all cases of those before are finished and
/// `enough_seeds` says no. A pure function of their thresholds: kills and the number of cores change nothing.
std::vector<std::string> spare_seeds(const Database&, const std::vector<Case>&, const SeedRule&);

}   // namespace bedload

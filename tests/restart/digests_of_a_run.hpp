// A run as the list of its digests, one per step, whatever happens to its scratch and memory on the way.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "solver/experiment.hpp"

namespace bedload::test {

/// Begins and runs to the end. Before each step calls disturb(state, experiment).
template <class Disturb>
std::vector<std::string> digests_of_a_run(const Scene& scene, Disturb&& disturb) {
  auto experiment = std::make_unique<Experiment>(scene);
  State state = experiment->begin();
  std::vector<std::string> digests;
  while (!Experiment::finished(state)) {
    disturb(state, experiment);
    experiment->step(state);
    digests.push_back(state_digest(state));
  }
  return digests;
}

inline std::vector<std::string> digests_of_a_run(const Scene& scene) {
  return digests_of_a_run(scene, [](State&, std::unique_ptr<Experiment>&) {});
}

}   // namespace bedload::test

// The checkpoints of one case directory: ck-<step>.h5, the newest two.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "solver/state.hpp"

namespace bedload {

struct CheckpointPosition {
  std::uint64_t step = 0;
  bool finished = false;
};

class CheckpointSeries {
 public:
  using Say = std::function<void(const std::string&)>;   // told of every fall back and quarantine
  CheckpointSeries(std::filesystem::path directory, int keep, Say say);

  /// The newest checkpoint that is whole. Broken ones are renamed to ck-<step>.h5.broken and reported. Nothing if there
  /// is none; Error corrupt if there were some and none is whole, or if the newest was written by a newer bedload.
  std::optional<State> newest();
  /// Publishes ck-<step>.h5, then removes all but the newest `keep`, and stray temporary files.
  void publish(const State&);

 private:
  std::filesystem::path directory_;
  int keep_;
  Say say_;
};

// For whoever does not hold the case's lock: these change nothing on disk. Broken checkpoints are skipped; nothing is
// returned if there is no whole one. Error corrupt (WrittenByNewer) if the newest was written by a newer bedload.

/// The newest whole checkpoint. `say` is told of each broken one that was passed over.
std::optional<State> newest_whole(const std::filesystem::path& directory, const CheckpointSeries::Say& say);
/// The steps of all files named ck-<step>.h5, whole or not, rising.
std::vector<std::uint64_t> checkpoint_steps(const std::filesystem::path& directory);
/// Its step and finished flag, without loading it all.
std::optional<CheckpointPosition> newest_position(const std::filesystem::path& directory);

}   // namespace bedload

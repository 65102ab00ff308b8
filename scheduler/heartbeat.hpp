// status.json: how far a worker has come. Progress, never truth: losing it costs nothing.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace bedload {

struct Heartbeat {
  std::int64_t pid = 0;
  std::uint64_t step = 0;
  double time = 0;               // model time of the case so far [s]
  double planned_time = 0;       // model time if it runs to the end of its plan [s]; a ramp may end earlier
  std::string phase;             // "packing", "ramp" ...
  int hold = 0, holds = 0;       // this step of the ramp, counted from 1, of how many
  double shields = 0;            // imposed now [-]
  double steps_per_second = 0;   // wall seconds
  double core_seconds = 0;       // CPU time of this attempt so far

  /// Of the planned time; 0 where nothing is planned.
  double fraction() const { return planned_time > 0 ? std::clamp(time / planned_time, 0.0, 1.0) : 0; }
  bool operator==(const Heartbeat&) const = default;
};

/// Replaces status.json without waiting for the disk. Never throws: a full disk must not end a run by its heartbeat.
void write_heartbeat(const std::filesystem::path& case_directory, const Heartbeat&) noexcept;

/// Nothing if there is none that can be read; members that are missing keep their defaults.
std::optional<Heartbeat> read_heartbeat(const std::filesystem::path& case_directory);

}   // namespace bedload

// Heartbeats as JSON, written cheaply and read leniently.
#include "scheduler/heartbeat.hpp"

#include <exception>
#include <nlohmann/json.hpp>

#include "base/durable_file.hpp"

namespace bedload {
namespace {

using Json = nlohmann::ordered_json;

}   // namespace

void write_heartbeat(const std::filesystem::path& directory, const Heartbeat& h) noexcept try {
  const Json json = {{"pid", h.pid},
                     {"step", h.step},
                     {"time", h.time},
                     {"planned_time", h.planned_time},
                     {"phase", h.phase},
                     {"hold", h.hold},
                     {"holds", h.holds},
                     {"shields", h.shields},
                     {"steps_per_second", h.steps_per_second},
                     {"core_seconds", h.core_seconds}};
  publish_unsynced(directory / "status.json", json.dump() + "\n");
} catch (const std::exception&) {   // the next one may get through
}

std::optional<Heartbeat> read_heartbeat(const std::filesystem::path& directory) try {
  const Json json = Json::parse(read_text(directory / "status.json"));
  Heartbeat h;
  h.pid = json.value("pid", h.pid);
  h.step = json.value("step", h.step);
  h.time = json.value("time", h.time);
  h.planned_time = json.value("planned_time", h.planned_time);
  h.phase = json.value("phase", h.phase);
  h.hold = json.value("hold", h.hold);
  h.holds = json.value("holds", h.holds);
  h.shields = json.value("shields", h.shields);
  h.steps_per_second = json.value("steps_per_second", h.steps_per_second);
  h.core_seconds = json.value("core_seconds", h.core_seconds);
  return h;
} catch (const std::exception&) {
  return std::nullopt;
}

}   // namespace bedload

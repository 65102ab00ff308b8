// request: a word left in a case directory for its worker, which reads it at every heartbeat.
#pragma once

#include <filesystem>
#include <optional>

namespace bedload {

/// Both: checkpoint and end with exit code 75. After `stop` the next `bedload run` goes on; a case on `hold` stays
/// aside until the request is cleared.
enum class Request { stop, hold };

void write_request(const std::filesystem::path& case_directory, Request);
std::optional<Request> read_request(const std::filesystem::path& case_directory);
void clear_request(const std::filesystem::path& case_directory);

}   // namespace bedload

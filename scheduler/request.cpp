// Requests: one word in one file.
#include "scheduler/request.hpp"

#include <string>

#include "base/durable_file.hpp"
#include "base/error.hpp"

namespace bedload {

void write_request(const std::filesystem::path& directory, Request request) {
  publish(directory / "request", request == Request::stop ? "stop\n" : "hold\n");
}

std::optional<Request> read_request(const std::filesystem::path& directory) try {
  const std::string text = read_text(directory / "request");
  if (text.starts_with("stop")) return Request::stop;
  if (text.starts_with("hold")) return Request::hold;
  return std::nullopt;
} catch (const Error&) {   // no request
  return std::nullopt;
}

void clear_request(const std::filesystem::path& directory) {
  std::error_code ignored;   // gone already, or it will be seen again
  std::filesystem::remove(directory / "request", ignored);
}

}   // namespace bedload

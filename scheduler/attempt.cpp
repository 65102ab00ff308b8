// Attempts as JSON files; the numbers go out through publish_once, which one rival wins on any file system.
#include "scheduler/attempt.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <ctime>
#include <nlohmann/json.hpp>

#include "base/durable_file.hpp"

namespace bedload {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 12> words = {"running",   "finished", "stopped",       "wall_limit",
                                                    "crash",     "killed",   "out_of_memory", "user_error",
                                                    "numerical", "io",       "corrupt",       "fenced"};

fs::path file_of(const fs::path& directory, int number) { return directory / fmt::format("attempt.{}.json", number); }

/// The n of attempt.<n>.json; 0 for any other name.
int number_in(const std::string& name) {
  constexpr std::string_view head = "attempt.", tail = ".json";
  if (!name.starts_with(head) || !name.ends_with(tail) || name.size() <= head.size() + tail.size()) return 0;
  int number = 0;
  const char* const first = name.data() + head.size();
  const char* const last = name.data() + name.size() - tail.size();
  const auto [end, error] = std::from_chars(first, last, number);
  return error == std::errc() && end == last ? number : 0;
}

std::vector<int> numbers_in(const fs::path& directory) {
  std::vector<int> numbers;
  std::error_code none;   // a directory that does not exist has no attempts
  for (const auto& entry : fs::directory_iterator(directory, none))
    if (const int number = number_in(entry.path().filename().string()); number > 0) numbers.push_back(number);
  std::ranges::sort(numbers);
  return numbers;
}

Json optional_step(const std::optional<std::uint64_t>& step) { return step ? Json(*step) : Json(nullptr); }

std::string text_of(const Attempt& a) {
  const Json json = {{"number", a.number},
                     {"host", a.host},
                     {"pid", a.pid},
                     {"boot_id", a.boot_id},
                     {"start", a.start},
                     {"end", a.end},
                     {"cause", word(a.cause)},
                     {"message", a.message},
                     {"from_step", optional_step(a.from_step)},
                     {"step", optional_step(a.step)},
                     {"core_seconds", a.core_seconds},
                     {"version", a.version},
                     {"compiler", a.compiler}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::optional<std::uint64_t> step_in(const Json& json, const char* key) {
  const auto found = json.find(key);
  if (found == json.end() || found->is_null()) return std::nullopt;
  return found->get<std::uint64_t>();
}

Attempt attempt_in(const std::string& text) {
  const Json json = Json::parse(text);
  Attempt a;
  a.number = json.at("number").get<int>();
  a.host = json.at("host").get<std::string>();
  a.pid = json.at("pid").get<std::int64_t>();
  a.boot_id = json.at("boot_id").get<std::string>();
  a.start = json.at("start").get<std::string>();
  a.end = json.at("end").get<std::string>();
  const auto found = std::ranges::find(words, json.at("cause").get<std::string>());
  a.cause = found == words.end() ? Cause::crash : static_cast<Cause>(found - words.begin());
  a.message = json.at("message").get<std::string>();
  a.from_step = step_in(json, "from_step");
  a.step = step_in(json, "step");
  a.core_seconds = json.at("core_seconds").get<double>();
  a.version = json.at("version").get<std::string>();
  a.compiler = json.at("compiler").get<std::string>();
  return a;
}

}   // namespace

std::string_view word(Cause cause) { return words[static_cast<std::size_t>(cause)]; }

Cause cause_of(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::usage:
    case ErrorKind::study_invalid:
    case ErrorKind::not_found:
    case ErrorKind::unavailable: return Cause::user_error;
    case ErrorKind::locked:
    case ErrorKind::fenced: return Cause::fenced;
    case ErrorKind::io: return Cause::io;
    case ErrorKind::stopped: return Cause::stopped;
    case ErrorKind::corrupt: return Cause::corrupt;
    case ErrorKind::numerical: return Cause::numerical;
    case ErrorKind::some_failed:
    case ErrorKind::internal: break;
  }
  return Cause::crash;
}

Attempt open_attempt(const fs::path& directory) {
  Attempt a;
  a.number = highest_attempt(directory) + 1;
  a.host = host_name();
  a.pid = ::getpid();
  a.boot_id = boot_id();
  a.start = utc_now();
  if (!publish_once(file_of(directory, a.number), text_of(a)))
    throw Error(ErrorKind::fenced,
                fmt::format("{}: attempt {} was taken by another process", directory.string(), a.number),
                "one worker at a time runs a case; the other one goes on");
  return a;
}

void write_attempt(const fs::path& directory, const Attempt& a) { publish(file_of(directory, a.number), text_of(a)); }

void close_attempt(const fs::path& directory, Attempt a, Cause cause, const std::string& message) {
  a.cause = cause;
  a.message = message;
  a.end = utc_now();
  write_attempt(directory, a);
}

std::vector<Attempt> read_attempts(const fs::path& directory) {
  std::vector<Attempt> attempts;
  for (const int number : numbers_in(directory)) try {
      attempts.push_back(attempt_in(read_text(file_of(directory, number))));
    } catch (const Json::exception& e) {
      throw Error(ErrorKind::corrupt, fmt::format("{}: {}", file_of(directory, number).string(), e.what()),
                  "remove the file: it records an attempt and holds no physics");
    }
  return attempts;
}

int highest_attempt(const fs::path& directory) {
  const auto numbers = numbers_in(directory);
  return numbers.empty() ? 0 : numbers.back();
}

std::string utc_now() { return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))); }

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

std::string boot_id() {
  std::string id;
  try {
    id = read_text("/proc/sys/kernel/random/boot_id");
  } catch (const Error&) {   // no /proc: pids of this host are then never trusted
    return {};
  }
  while (!id.empty() && id.back() == '\n') id.pop_back();
  return id;
}

}   // namespace bedload

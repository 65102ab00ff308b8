// Lines on stderr, one write each, so that several processes do not mix within a line.
#include "base/log.hpp"

#include <cstdlib>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

namespace bedload {

namespace {

Verbosity verbosity = Verbosity::normal;

std::string marked(std::string_view word, std::string_view colour) {
  static const bool coloured = colour_wanted(STDERR_FILENO);
  return coloured ? fmt::format("\033[{}m{}\033[0m ", colour, word) : fmt::format("{} ", word);
}

void write_line(std::string line) {
  line += '\n';
  if (::write(STDERR_FILENO, line.data(), line.size()) < 0) return;   // stderr closed: there is nobody to tell
}

}   // namespace

void set_verbosity(Verbosity v) { verbosity = v; }

bool colour_wanted(int descriptor) {
  const auto value = [](const char* name) { return std::string_view(std::getenv(name) ? std::getenv(name) : ""); };
  return ::isatty(descriptor) == 1 && value("NO_COLOR").empty() && value("TERM") != "dumb";
}

void log_detail(std::string_view line) {
  if (verbosity == Verbosity::verbose) write_line(std::string(line));
}

void log_note(std::string_view line) {
  if (verbosity != Verbosity::quiet) write_line(std::string(line));
}

void log_warning(std::string_view line) { write_line(marked("warning:", "33") + std::string(line)); }

void log_error(const Error& error) {
  const std::string_view message = error.what();
  const bool placed = message.find(": error: ") != message.npos;
  write_line(placed ? std::string(message) : marked("error:", "31") + std::string(message));
  if (!error.hint.empty()) write_line(marked("hint:", "36") + error.hint);
}

}   // namespace bedload

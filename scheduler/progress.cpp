// Text of the progress, and the escape sequences that repaint it.
#include "scheduler/progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/counted.hpp"
#include "base/log.hpp"

namespace bedload {
namespace {

constexpr double line_every = 60;        // [s], where nothing can be repainted
constexpr std::size_t most_lines = 16;   // of cases at work, on a terminal
constexpr int bar_width = 10;

std::string bar(double fraction) {
  const auto full = static_cast<std::size_t>(std::lround(std::clamp(fraction, 0.0, 1.0) * bar_width));
  return fmt::format("[{:.<{}}]", std::string(full, '#'), bar_width);
}

std::string position_of(const RunningCase& c) {
  if (c.phase.empty()) return "starting";
  if (c.holds > 0) return fmt::format("{} {}/{}, Shields {:.3g}", c.phase, c.hold, c.holds, c.shields);
  return c.shields > 0 ? fmt::format("{}, hold {}, Shields {:.3g}", c.phase, c.hold, c.shields) : c.phase;
}

std::string line_of(const RunningCase& c) {
  std::string line =
      fmt::format("  {:<20} {} {:3.0f} %  {}", c.label, bar(c.fraction), 100 * c.fraction, position_of(c));
  if (c.left >= 0) line += fmt::format(", {} left", duration_text(c.left));
  if (c.silent > line_every) line += fmt::format(", silent for {}", duration_text(c.silent));
  return line;
}

std::string cut(std::string line, int width) {
  if (static_cast<int>(line.size()) > width) line.resize(static_cast<std::size_t>(std::max(0, width)));
  return line;
}

}   // namespace

std::string duration_text(double seconds) {
  if (seconds < 90) return fmt::format("{:.0f} s", seconds);
  if (seconds < 90 * 60) return fmt::format("{:.0f} min", seconds / 60);
  if (seconds < 36 * 3600) return fmt::format("{:.1f} h", seconds / 3600);
  return fmt::format("{:.1f} d", seconds / 86400);
}

std::string summary(const Progress& p) {
  std::string text = fmt::format("{} of {} done", p.done, counted(p.cases, "case"));
  if (p.beds_done < p.beds) text += fmt::format(", {} of {} ready", p.beds_done, counted(p.beds, "bed"));
  if (!p.running.empty()) text += fmt::format(", {} at work", p.running.size());
  if (p.failed > 0) text += fmt::format(", {} failed", p.failed);
  if (p.stopped > 0) text += fmt::format(", {} stopped", p.stopped);
  if (p.stopping) text += ", stopping";
  else if (p.left > 0) text += fmt::format(", about {} left", duration_text(p.left));
  return text;
}

ProgressPrinter::Style ProgressPrinter::style_of(int descriptor) {
  const char* const terminal = std::getenv("TERM");
  Style style;
  style.terminal = ::isatty(descriptor) == 1 && terminal && std::string_view(terminal) != "dumb";
  style.colour = colour_wanted(descriptor);
  struct winsize size {};
  if (::ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) style.width = size.ws_col;
  return style;
}

ProgressPrinter::ProgressPrinter(Style style, Write write, Clock clock)
    : style_(style), write_(std::move(write)), clock_(std::move(clock)), last_line_(clock_()) {}

ProgressPrinter::~ProgressPrinter() { erase_block(); }

void ProgressPrinter::event(const std::string& line) {
  const std::string standing = block_;
  erase_block();
  write_(line + "\n" + standing);
  block_ = standing;
}

void ProgressPrinter::update(const Progress& p) {
  if (style_.terminal) {
    std::string block = block_of(p);
    if (block == block_) return;
    erase_block();
    write_(block);
    block_ = std::move(block);
  } else if (clock_() - last_line_ >= line_every) {
    last_line_ = clock_();
    write_(summary(p) + "\n");
  }
}

std::string ProgressPrinter::block_of(const Progress& p) const {
  const std::string total =
      fmt::format("{} {}", bar(p.cases > 0 ? static_cast<double>(p.done) / p.cases : 0), summary(p));
  const bool red = style_.colour && p.failed > 0;
  std::string block = fmt::format("{}{}{}\n", red ? "\x1b[31m" : "", cut(total, style_.width), red ? "\x1b[0m" : "");
  for (std::size_t i = 0; i < std::min(p.running.size(), most_lines); ++i)
    block += cut(line_of(p.running[i]), style_.width) + "\n";
  if (p.running.size() > most_lines) block += fmt::format("  and {} more\n", p.running.size() - most_lines);
  return block;
}

void ProgressPrinter::erase_block() {
  const auto lines = std::ranges::count(block_, '\n');
  if (lines > 0) write_(fmt::format("\x1b[{}A\x1b[J", lines));   // up, and clear to the end of the screen
  block_.clear();
}

}   // namespace bedload

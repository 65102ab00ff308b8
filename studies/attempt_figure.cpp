// Rows of bars over time.
#include "studies/attempt_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "studies/database_values.hpp"
#include "studies/svg_plot.hpp"

namespace bedload {

namespace {

constexpr double width = 940, legend_width = 210, margins = 56;   // [px]
constexpr double tallest_row = 18, most_of_all_rows = 900;        // [px]
constexpr double least_labelled_row = 11;                         // [px], what a letter needs

struct Group {
  std::string_view causes, name, colour;   // causes between spaces
};
constexpr std::array<Group, 6> groups{{{" finished ", "finished", "var(--green)"},
                                       {" stopped wall_limit ", "stopped, wall limit", "var(--blue)"},
                                       {" killed crash out_of_memory ", "killed, crash, memory", "var(--red)"},
                                       {" numerical ", "numerical", "var(--purple)"},
                                       {" user_error io corrupt fenced ", "user, io, corrupt, fenced", "var(--ochre)"},
                                       {" running ", "running, or not heard of", "var(--still)"}}};

const Group& group_of(const std::string& cause) {
  const auto found = std::ranges::find_if(
      groups, [&](const Group& group) { return group.causes.find(" " + cause + " ") != std::string_view::npos; });
  return found == groups.end() ? groups.back() : *found;
}

struct Bar {
  std::size_t row;
  double from, to;   // [s] since the first start
  std::string cause;
  std::int64_t number;
};

struct TimeLine {
  std::vector<std::string> labels;
  std::vector<Bar> bars;
  double end = 0;   // [s]
};

/// Times are text in ISO 8601 to a second.
TimeLine time_line(const Database& database) {
  const Rows found = database.query(
      "WITH times AS (SELECT min(unixepoch(start_utc)) AS first, max(unixepoch(coalesce(end_utc, start_utc))) AS last "
      "FROM attempts) SELECT label, c.case_id, number, unixepoch(start_utc) - first, "
      "coalesce(unixepoch(end_utc), last) - first, cause, last - first FROM attempts a JOIN cases c USING (case_id), "
      "times ORDER BY c.position, number");
  TimeLine line;
  std::string id;
  for (const auto& row : found.rows) {
    if (text_in(row[1]) != id) line.labels.push_back(text_in(row[0]));
    id = text_in(row[1]);
    line.bars.push_back({line.labels.size() - 1, number_in(row[3]), number_in(row[4]), text_in(row[5]),
                         std::int64_t(number_in(row[2]))});
    line.end = number_in(row[6]);
  }
  return line;
}

struct Unit {
  std::string_view name;
  double seconds;
};
Unit unit_for(double seconds) {
  if (seconds < 300) return {"s", 1};
  if (seconds < 3 * 3600) return {"min", 60};
  return seconds < 72 * 3600 ? Unit{"h", 3600} : Unit{"days", 86400};
}

}   // namespace

std::string attempt_figure(const Database& database) {
  if (!has_table(database, "attempts") || !has_table(database, "cases")) return {};
  const TimeLine line = time_line(database);
  if (line.bars.empty()) return {};
  const auto rows = double(line.labels.size());
  const double row_height = std::min(tallest_row, most_of_all_rows / rows);
  const double height = std::max(rows * row_height, 130.0);   // the legend's, at least
  auto labels = line.labels;
  if (height / rows < least_labelled_row) std::ranges::fill(labels, "");
  const Unit unit = unit_for(line.end);
  const double end = std::max(1.0, line.end), least = end / 300;   // an attempt of no length can be seen
  SvgPlot plot(width, height + margins,
               {fmt::format("time since the first attempt began  [{}]", unit.name), 0, (end + least) / unit.seconds},
               {.label = "", .low = 0, .high = rows, .logarithmic = false, .rows = labels}, legend_width);
  for (const Bar& bar : line.bars) {
    const double below = rows - double(bar.row) - 1;
    plot.shade({bar.from / unit.seconds, below + 0.15},
               {std::max(bar.to, bar.from + least) / unit.seconds, below + 0.85}, group_of(bar.cause).colour, 0.85,
               fmt::format("{}, attempt {}: {}, {:.3g} {}", line.labels[bar.row], bar.number, bar.cause,
                           (bar.to - bar.from) / unit.seconds, unit.name));
  }
  plot.legend_heading("attempts, by their end");
  for (const Group& group : groups)
    if (std::ranges::any_of(line.bars, [&](const Bar& bar) { return &group_of(bar.cause) == &group; }))
      plot.legend_shade(group.name, group.colour, 0.85);
  return plot.svg();
}

}   // namespace bedload

// Rows of the matrix to Markdown.
#include "studies/extremes_document.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "base/build_info.hpp"

namespace bedload {
namespace {

constexpr std::string_view preface = R"(# Extremes

Written by `{}`, bedload {} ({}). Do not edit: run the command. Links to study files hold
in docs/ of the sources.

Scenes at the edges of what can be asked for: one factor at a time around two beds, special arrangements of grains, and a set
in which every pair of levels of seven factors occurs. Each is a study file of [studies/validation](../studies/validation) and
the keys that are put in place of the file's. A scene is run once without an end, to see how much time its fluid steps take, and
then for that time (drive.dwell). Each runs to its end, is refused, or fails with a word; what it was to do stands
in the verdict. Books are the worst over all steps (docs/physics_coupling.md): *volume* of the fluid against box less grains,
*momentum* that a step made, of all that changed hands (periodic scenes), *divergence* div(eps u + J) T that a step left (bounded
where grains move, else at most 1e-8; both limits in the first row), *energy* made without a source, of what was exchanged. *resumed*: the run, saved and
loaded half way, ends in the same bytes. {} of {} scenes are as they must be; {:.1f} core minutes.
)";

std::string number(double value) { return value == 0 ? "0" : fmt::format("{:.1e}", value); }
std::string number(const std::optional<double>& value) { return value ? number(*value) : "-"; }

std::string line_of(const std::vector<std::string>& cells) { return fmt::format("| {} |\n", fmt::join(cells, " | ")); }

std::string line_of(const ExtremeRow& row) {
  auto cells = extremes_cells(row);
  if (!row.wrong().empty()) cells.back() = "**" + cells.back() + "**";
  return line_of(cells);
}

std::string head_of(const std::string& base) {
  const auto columns = extremes_columns();
  std::string rule = "|";
  for (std::size_t n = 0; n < columns.size(); ++n) rule += "---|";
  return fmt::format("\n## {}\n\n{}{}\n{}", base, line_of(columns), rule, line_of(extremes_limits()));
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

}   // namespace

std::vector<std::string> extremes_columns() {
  return {"scene",  "outcome",  "grains",     "steps",  "retries", "CFL",    "overlap/d",
          "volume", "momentum", "divergence", "energy", "resumed", "verdict"};
}

std::vector<std::string> extremes_limits() {
  return {"limit",
          "",
          fmt::format("{}", most_grains),
          fmt::format("{}..{}", fewest_steps, most_steps),
          "",
          "",
          "",
          fmt::format("{:.0e}", exact_volume),
          fmt::format("{:.0e}", exact_momentum),
          fmt::format("{} or {:.0e}", most_left, exact_divergence),
          fmt::format("{}", energy_made),
          "same",
          ""};
}

std::vector<std::string> extremes_cells(const ExtremeRow& row) {
  const std::string wrong = row.wrong(), verdict = wrong.empty() ? "right" : wrong;
  std::vector<std::string> cells(extremes_columns().size());
  cells.front() = row.scene.name, cells[1] = name_of(row.outcome), cells.back() = verdict;
  if (row.outcome == Outcome::refused) return cells;
  const Books& books = row.books;
  return {row.scene.name,
          cells[1],
          fmt::format("{}", row.grains),
          fmt::format("{}", row.steps),
          fmt::format("{}", row.retries),
          fmt::format("{:.2f}", row.cfl),
          fmt::format("{:.3f}", row.overlap),
          number(books.fluid_volume),
          number(books.momentum),
          number(books.divergence),
          number(books.energy),
          row.resumed_is_straight ? "same" : "no",
          verdict};
}

DocumentFile extremes_document(const std::vector<ExtremeRow>& rows, const std::string& command) {
  const auto right = std::ranges::count_if(rows, [](const ExtremeRow& row) { return row.wrong().empty(); });
  double core_seconds = 0;
  std::string base, tables, messages;
  std::vector<ExtremeRow> sorted = rows;
  std::ranges::stable_sort(sorted, {}, [](const ExtremeRow& row) { return row.scene.base; });
  for (const ExtremeRow& row : sorted) {
    core_seconds += row.core_seconds;
    if (row.scene.base != base) {
      base = row.scene.base;
      tables += head_of(base);
    }
    tables += line_of(row);
    if (!row.message.empty())
      messages += fmt::format("- {}, {}: {}\n", row.scene.base, row.scene.name, first_line(row.message));
  }
  const auto build = build_info();
  std::string text =
      fmt::format(fmt::runtime(preface), command, build.version, build.commit, right, rows.size(), core_seconds / 60);
  text += tables;
  if (!messages.empty()) text += "\n## What was said\n\n" + messages;
  return {"extremes.md", text};
}

}   // namespace bedload

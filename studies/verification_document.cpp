// Rows to Markdown.
#include "studies/verification_document.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

#include "base/build_info.hpp"
#include "studies/mesh_table.hpp"
#include "studies/svg_plot.hpp"

namespace bedload {

namespace {

std::string of_row(const ValidationRow& row, double number, bool with_sign) {
  const auto text = with_sign ? fmt::format("{:+.2g}", row.band.relative ? 100 * number : number)
                              : fmt::format("{:.3g}", row.band.relative ? 100 * number : number);
  return row.band.relative ? text + " %" : text;
}

/// A phrase as the beginning of a sentence.
std::string capital(std::string_view phrase) {
  std::string text(phrase);
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

std::string table_of(const Findings& findings) {
  std::string text = "| | reference | ours | deviation | band | | against |\n|---|---|---|---|---|---|---|\n";
  for (const auto& row : findings.rows)
    if (row.decides())
      text += fmt::format("| {} | {:.5g} | {:.5g} | {} | {} | {} | {}: {} |\n", row.name, row.reference, row.ours,
                          shown_deviation(row), shown_band(row), row.in_band() ? "pass" : "**no**", shown_against(row),
                          row.source);
    else text += fmt::format("| {} | | {:.5g} | | | note | {} |\n", row.name, row.ours, row.source);
  return text;
}

std::string section_of(const RungResult& rung) {
  auto text = fmt::format(
      "### {}\n\n{} ([study file](../studies/validation/{}.toml), {} case{}, {:.1f} core seconds).\n\n", rung.study,
      capital(rung.what), rung.study, rung.cases, rung.cases == 1 ? "" : "s", rung.core_seconds);
  if (!rung.failure.empty()) return text + fmt::format("**Not run to its end**: {}\n\n", rung.failure);
  text += table_of(rung.findings) + "\n";
  for (const auto& figure : rung.findings.figures)
    text += fmt::format("![{}](verification/{}.svg)\n\n{}\n\n", figure.name, figure.name, figure.caption);
  return text;
}

std::string section_of(const std::vector<MeshFall>& falls, const ValidationFigure& figure) {
  const auto columns = mesh_columns();
  auto text = fmt::format("### The meshes side by side\n\n{}\n\n| {} |\n", mesh_caption, fmt::join(columns, " | "));
  for (std::size_t n = 0; n < columns.size(); ++n) text += "|---";
  text += "|\n";
  for (const auto& fall : falls) text += fmt::format("| {} |\n", fmt::join(mesh_cells(fall), " | "));
  return text + fmt::format("\n![{}](verification/{}.svg)\n\n{}\n\n", figure.name, figure.name, figure.caption);
}

constexpr std::string_view preface = R"(# Verification

Written by `{}`, bedload {} ({}). Do not edit: run the command. Links to study files hold
in docs/ of the sources.

Every row is a run of this program, read from its record or its last state, and held against a reference of another origin:
*code*, the exact answer of the equations that are solved; or *experiment*, what was measured in nature. A *note* is for
information and decides nothing. A band with % is of the reference, one without is in the unit of the row; a single number is
allowed above and below, "at most +0 %" is a bound: any value up to the reference passes. The study files are
in [studies/validation](../studies/validation); `bedload run` takes them like any other. `bedload validate [GROUP]` runs them
in memory and prints these tables, `--quick` a part of them in three minutes on two cores. {} of {} rows are in band;
{:.1f} core minutes.

)";

}   // namespace

std::string_view shown_against(const ValidationRow& row) {
  constexpr std::string_view words[] = {"code", "experiment", "nothing"};
  return words[static_cast<int>(row.against)];
}

std::string_view shown_verdict(const ValidationRow& row) {
  return !row.decides() ? "note" : row.in_band() ? "pass" : "NO";
}

std::string shown_deviation(const ValidationRow& row) {
  return std::isfinite(row.deviation()) ? of_row(row, row.deviation(), true) : "none";
}

std::string shown_band(const ValidationRow& row) {
  if (!row.decides()) return "none";
  const auto& [below, above, relative] = row.band;
  if (below == above) return of_row(row, above, false);
  if (std::isinf(below)) return fmt::format("at most {}", of_row(row, above, true));
  if (std::isinf(above)) return fmt::format("at least {}", of_row(row, -below, true));
  return fmt::format("{} to {}", of_row(row, -below, true), of_row(row, above, true));
}

std::vector<DocumentFile> verification_document(const std::vector<RungResult>& rungs, const std::string& command) {
  std::size_t rows = 0, good = 0;
  double core_seconds = 0;
  for (const auto& rung : rungs) {
    rows += rung.findings.deciding(), good += rung.findings.in_band();
    core_seconds += rung.core_seconds;
  }
  const auto build = build_info();
  std::vector<DocumentFile> files{{"verification.md", fmt::format(fmt::runtime(preface), command, build.version,
                                                                  build.commit, good, rows, core_seconds / 60)}};
  std::string group, body;
  const auto add_figure = [&](const ValidationFigure& figure) {
    files.push_back({fmt::format("verification/{}.svg", figure.name), standing_alone(figure.svg)});
  };
  const auto meshes = mesh_falls(rungs);
  const auto meshes_figure = mesh_figure(meshes);
  const auto close_group = [&] {
    if (group == mesh_group && meshes_figure) body += section_of(meshes, *meshes_figure), add_figure(*meshes_figure);
  };
  for (const auto& rung : rungs) {
    if (rung.group != group) {
      close_group();
      group = rung.group;
      const auto named = std::ranges::find(validation_groups(), group, &ValidationGroup::name);
      body += fmt::format("## {}\n\n", group);
      if (named != validation_groups().end()) body += fmt::format("{}.\n\n", capital(named->what));
    }
    body += section_of(rung);
    for (const auto& figure : rung.findings.figures) add_figure(figure);
  }
  close_group();
  files.front().text += body;
  return files;
}

}   // namespace bedload

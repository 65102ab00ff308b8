// `bedload validate`: the ladder, climbed and printed.
#include <algorithm>
#include <chrono>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "app/tables.hpp"
#include "base/durable_file.hpp"
#include "base/log.hpp"
#include "studies/extremes_document.hpp"
#include "studies/stop_signals.hpp"
#include "studies/validation.hpp"
#include "studies/verification_document.hpp"

namespace bedload {

namespace fs = std::filesystem;

namespace {

/// Studies of the ladder, then scenes of the extremes: one line each.
int list_studies(const std::vector<ValidationGroup>& groups, bool extremes, Form form) {
  Rows rows{{"group", "study", "cases", "quick", "what"}, {}};
  for (const auto& group : groups)
    for (const auto& rung : group.rungs())
      rows.rows.push_back(
          {std::string(group.name), std::string(rung.study), static_cast<std::int64_t>(cases_of(rung, false).size()),
           static_cast<std::int64_t>(rung.quick ? cases_of(rung, true).size() : 0), std::string(rung.what)});
  if (extremes)
    for (const auto& scene : extreme_scenes(false))
      rows.rows.push_back(
          {std::string("extremes"), scene.base, std::int64_t{1}, std::int64_t{scene.quick}, scene.name});
  fmt::print("{}", form == Form::table ? printed_with_text(rows) : printed(rows, form));
  return 0;
}

Rows as_rows(const std::vector<RungResult>& rungs) {
  Rows rows{{"study", "row", "reference", "ours", "deviation", "band", "pass", "source"}, {}};
  for (const auto& rung : rungs) {
    for (const auto& row : rung.findings.rows)
      rows.rows.push_back({rung.study, row.name, row.decides() ? Value(row.reference) : Value(), row.ours,
                           shown_deviation(row), shown_band(row), std::string(shown_verdict(row)),
                           row.decides() ? fmt::format("{}: {}", shown_against(row), row.source) : row.source});
    if (!rung.failure.empty())
      rows.rows.push_back({rung.study, std::string("all rows"), {}, {}, {}, {}, std::string("NOT RUN"), rung.failure});
  }
  return rows;
}

nlohmann::ordered_json as_json(const RungResult& rung) {
  auto rows = nlohmann::ordered_json::array();
  for (const auto& row : rung.findings.rows)
    rows.push_back({{"row", row.name},
                    {"reference", row.reference},
                    {"source", row.source},
                    {"against", shown_against(row)},
                    {"ours", row.ours},
                    {"deviation", row.deviation()},
                    {"relative", row.band.relative},
                    {"band_below", row.band.below},
                    {"band_above", row.band.above},
                    {"pass", row.decides() ? nlohmann::json(row.in_band()) : nlohmann::json()}});
  return {{"group", rung.group},
          {"study", rung.study},
          {"what", rung.what},
          {"cases", rung.cases},
          {"core_seconds", rung.core_seconds},
          {"failure", rung.failure},
          {"pass", rung.passed()},
          {"rows", std::move(rows)}};
}

void print_json(const std::vector<RungResult>& rungs, bool passed) {
  nlohmann::ordered_json json = {{"pass", passed}, {"rungs", nlohmann::ordered_json::array()}};
  for (const auto& rung : rungs) json["rungs"].push_back(as_json(rung));
  fmt::print("{}\n", json.dump(2));
}

/// A word as a shell reads it.
std::string quoted(const std::string& word) {
  constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./+,:@%";
  if (!word.empty() && word.find_first_not_of(plain) == word.npos) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

/// What was run, as it stands in the document.
std::string command_line(const ValidateOptions& options) {
  std::string line = "bedload validate";
  for (const auto& group : options.groups) line += " " + group;
  if (options.quick) line += " --quick";
  if (options.cores) line += fmt::format(" --cores {}", *options.cores);
  return line + " --write " + quoted(*options.write);
}

void write_document(const ValidateOptions& options, const std::vector<RungResult>& rungs) {
  const fs::path folder = *options.write;
  for (const auto& file : verification_document(rungs, command_line(options))) publish(folder / file.path, file.text);
  log_note(fmt::format("wrote {}", (folder / "verification.md").string()));
}

/// The document is of the whole ladder: a group's rows do not take its place.
void make_room_for_document(const ValidateOptions& options) {
  if (!options.groups.empty())
    throw Error(ErrorKind::usage,
                fmt::format("verification.md holds all groups: --write with {} would leave the others out",
                            fmt::join(options.groups, ", ")),
                fmt::format("bedload validate{} --write {} runs them all; --json or --csv keep the rows of a group",
                            options.quick ? " --quick" : "", quoted(*options.write)));
  make_writable_directory(fs::path(*options.write) / "verification");
}

void print_summary(const std::vector<RungResult>& rungs, double wall) {
  std::size_t rows = 0, good = 0;
  double core_seconds = 0;
  for (const auto& rung : rungs) {
    rows += rung.findings.deciding(), good += rung.findings.in_band();
    core_seconds += rung.core_seconds;
    if (!rung.failure.empty()) log_warning(fmt::format("{} was not run to its end: {}", rung.study, rung.failure));
  }
  log_note(fmt::format("{} of {} rows in band; {:.0f} s, {:.0f} core seconds", good, rows, wall, core_seconds));
}

/// What workers ask before every step. They end with their steps under way; a second signal ends the program.
bool stop_asked() {
  if (!StopSignals::arrived()) return false;
  StopSignals::release();
  return true;
}

/// The rows so far are printed; a document is written of a whole ladder only.
int stopped_after(std::size_t done, std::size_t all, std::string_view what) {
  log_note(fmt::format("stopped after {} of {} {}", done, all, what));
  return static_cast<int>(ErrorKind::stopped);
}

/// The matrix of the extremes: scenes that must end well, or be refused, with their books in order.
int validate_extremes(const ValidateOptions& options) {
  if (options.write) make_writable_directory(*options.write);
  const StopSignals signals;
  const auto rows = run_extremes({.quick = options.quick,
                                  .cores = options.cores.value_or(0),
                                  .progress = [](const std::string& line) { log_note(line); },
                                  .stop = stop_asked});
  fmt::print("{}", printed(extremes_table(rows), options.form));
  if (const auto all = extreme_scenes(options.quick).size(); rows.size() < all)
    return stopped_after(rows.size(), all, "scenes");
  if (options.write) {
    const auto file = extremes_document(rows, command_line(options));
    publish(fs::path(*options.write) / file.path, file.text);
    log_note(fmt::format("wrote {}", (fs::path(*options.write) / file.path).string()));
  }
  const auto wrong = std::ranges::count_if(rows, [](const ExtremeRow& row) { return !row.wrong().empty(); });
  log_note(fmt::format("{} of {} scenes as they must be", std::ssize(rows) - wrong, rows.size()));
  return wrong == 0 ? 0 : static_cast<int>(ErrorKind::some_failed);
}

}   // namespace

int validate_command(const ValidateOptions& options) {
  auto names = options.groups;
  const bool extremes = std::erase(names, "extremes") > 0;
  const auto groups = extremes && names.empty() ? std::vector<ValidationGroup>{} : groups_named(names);
  if (options.list) return list_studies(groups, extremes || names.empty(), options.form);
  if (extremes && !groups.empty())
    throw Error(ErrorKind::usage, "the extremes are run by themselves: they are no rows of the ladder",
                "bedload validate extremes [--quick] [--json] [--write docs]");
  if (extremes) return validate_extremes(options);
  if (options.write) make_room_for_document(options);
  const auto began = std::chrono::steady_clock::now();
  const StopSignals signals;
  auto rungs = climb(groups, {.quick = options.quick,
                              .cores = options.cores.value_or(0),
                              .progress = [](const std::string& line) { log_note(line); },
                              .stop = stop_asked});
  const auto all = rungs.size();
  std::erase_if(rungs, &RungResult::stopped);
  const bool passed = rungs.size() == all && std::ranges::all_of(rungs, &RungResult::passed);
  if (options.form == Form::json) print_json(rungs, passed);
  else fmt::print("{}", printed(as_rows(rungs), options.form));
  if (rungs.size() < all) return stopped_after(rungs.size(), all, "studies");
  if (options.write) write_document(options, rungs);
  print_summary(rungs, std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count());
  return passed ? 0 : static_cast<int>(ErrorKind::some_failed);
}

}   // namespace bedload

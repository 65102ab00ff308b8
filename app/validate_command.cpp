// `bedload validate`: the ladder, climbed and printed.
#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "app/commands.hpp"
#include "app/tables.hpp"
#include "app/validate_tables.hpp"
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

/// The sum of it all: below the table that people read, else as a note, since programs read the rest.
void conclude(const std::string& sum, Form form) {
  if (form == Form::table) fmt::print("{}\n", sum);
  else log_note(sum);
}

int exit_code(bool stopped, bool good) {
  return stopped ? static_cast<int>(ErrorKind::stopped) : good ? 0 : static_cast<int>(ErrorKind::some_failed);
}

void print_ladder(const Climbed& ladder, Form form) {
  if (form == Form::json) fmt::print("{}", ladder_as_json(ladder));
  else fmt::print("{}", form == Form::csv ? ladder_as_csv(ladder.rungs) : ladder_for_people(ladder.rungs));
  conclude(ladder_summary(ladder), form);
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

/// What workers ask before every step. They end with their steps under way; a second signal ends the program.
bool stop_asked() {
  if (!StopSignals::arrived()) return false;
  StopSignals::release();
  return true;
}

/// The matrix of the extremes: scenes that must end well, or be refused, with their books in order.
int validate_extremes(const ValidateOptions& options) {
  if (options.write) make_writable_directory(*options.write);
  const StopSignals signals;
  const auto rows = run_extremes({.quick = options.quick,
                                  .cores = options.cores.value_or(0),
                                  .progress = [](const std::string& line) { log_note(line); },
                                  .stop = stop_asked});
  const auto all = extreme_scenes(options.quick).size();
  const bool stopped = rows.size() < all;
  const auto wrong = std::ranges::count_if(rows, [](const ExtremeRow& row) { return !row.wrong().empty(); });
  fmt::print("{}",
             options.form == Form::table ? extremes_for_people(rows) : printed(extremes_table(rows), options.form));
  conclude(fmt::format("{}{} of {} scenes as they must be",
                       stopped ? fmt::format("stopped after {} of {} scenes; ", rows.size(), all) : "",
                       std::ssize(rows) - wrong, rows.size()),
           options.form);
  if (options.write && !stopped) {
    const auto file = extremes_document(rows, command_line(options));
    publish(fs::path(*options.write) / file.path, file.text);
    log_note(fmt::format("wrote {}", (fs::path(*options.write) / file.path).string()));
  }
  return exit_code(stopped, wrong == 0);
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
  Climbed ladder{.rungs = climb(groups, {.quick = options.quick,
                                         .cores = options.cores.value_or(0),
                                         .progress = [](const std::string& line) { log_note(line); },
                                         .stop = stop_asked}),
                 .quick = options.quick};
  ladder.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  ladder.studies = ladder.rungs.size();
  std::erase_if(ladder.rungs, &RungResult::stopped);
  print_ladder(ladder, options.form);
  if (options.write && !ladder.stopped()) write_document(options, ladder.rungs);
  return exit_code(ladder.stopped(), ladder.passed());
}

}   // namespace bedload

// `bedload plan` and `bedload explain`: what would run, at which cost, with which models, and why.
#include <algorithm>
#include <cmath>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "app/tables.hpp"
#include "base/counted.hpp"
#include "base/durable_file.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "base/units.hpp"
#include "scheduler/bed_sharing.hpp"
#include "scheduler/progress.hpp"
#include "solver/required_models.hpp"
#include "studies/accuracy.hpp"
#include "studies/case_entry.hpp"
#include "studies/case_identity.hpp"
#include "studies/case_warnings.hpp"
#include "studies/database_values.hpp"
#include "studies/explain.hpp"
#include "studies/plan.hpp"
#include "studies/study_file.hpp"

namespace bedload {

namespace fs = std::filesystem;

namespace {

std::vector<CaseEntry> known_cases(const fs::path& results) {
  if (!fs::exists(database_file(results))) return {};
  return read_cases(Database(database_file(results), Database::Mode::query));
}

Rows case_rows(const Plan& plan) {
  Rows rows{{"case", "label", "plan", "grains", "cells", "young_modulus_pa", "dem_step_s", "fluid_step_s",
             "grain_time_s", "galileo", "core_hours"},
            {}};
  for (const auto& c : plan.cases) {
    const auto& scene = c.one.scene;
    const auto n = numbers_of(scene);
    rows.rows.push_back({short_id(c.one.id), c.one.label, std::string(word(c.fate)) + (c.done ? ", done" : ""),
                         static_cast<std::int64_t>(scene.bed.source.count),
                         static_cast<std::int64_t>(scene.grid.cell_count()), scene.bed.grains.young_modulus,
                         scene.bed.dem_step, scene.steps.fluid_interval, real_or_null(n.grain_time),
                         real_or_null(n.galileo), c.done ? 0.0 : predicted_cost(c.one).core_seconds / 3600});
  }
  for (const auto& entry : plan.dropped)
    rows.rows.push_back({short_id(entry.id),
                         entry.label,
                         std::string("dropped: not in the study file any more"),
                         {},
                         {},
                         {},
                         {},
                         {},
                         {},
                         {},
                         0.0});
  return rows;
}

/// What dimensionless groups of the study file have picked, a row per parameter set, digit by digit as a study file takes it.
Rows picked_rows(const Plan& plan) {
  Rows rows{{"label", "diameter", "grain density", "viscosity"}, {}};
  for (const auto& c : plan.cases) {
    const auto& bed = c.one.scene.bed;
    std::vector<Value> row{c.one.set_label, shortest(bed.grains.diameter) + " m",
                           shortest(bed.grains.density) + " kg/m3", shortest(bed.fluid.viscosity) + " m2/s"};
    if (std::ranges::find(rows.rows, row) == rows.rows.end()) rows.rows.push_back(std::move(row));
  }
  return rows;
}

void print_picked(const Study& study, const Plan& plan) {
  const auto uses = [&](std::string_view group) {
    return study.settings.contains(group) || std::ranges::find(study.axes, group, &Axis::key) != study.axes.end();
  };
  if (!uses("fluid.galileo") && !uses("grains.density_ratio")) return;
  fmt::print("\nPicked by dimensionless groups:\n{}", printed(picked_rows(plan), Form::table));
}

using Cases = std::vector<const Case*>;

/// Scenes that differ only in numbers decide alike: groups of cases whose decisions agree, in order of the study.
std::vector<Cases> groups_that_agree(const Plan& plan) {
  std::vector<std::string> seen;
  std::vector<Cases> groups;
  for (const auto& c : plan.cases) {
    std::string decisions;
    for (const auto& m : decisions_of(c.one.scene)) decisions += fmt::format("{} {} {};", m.term, m.on, m.wanted);
    const auto known = std::ranges::find(seen, decisions) - seen.begin();
    if (known == std::ssize(seen)) seen.push_back(decisions), groups.emplace_back();
    groups[static_cast<std::size_t>(known)].push_back(&c.one);
  }
  return groups;
}

/// The name of a number without the level at which it is quoted.
std::string without_level(const std::string& name) { return name.substr(0, name.find(" at theta = ")); }

/// Least and greatest value of a column over cases. Rows are told apart by their first column; a level that not all share
/// is left out of it.
Rows over_cases(const Cases& cases, Rows (*rows_of)(const Scene&), std::size_t column) {
  Rows all = rows_of(cases.front()->scene);
  std::vector<std::pair<double, double>> ranges;
  for (const auto& row : all.rows) ranges.emplace_back(number_in(row[column]), number_in(row[column]));
  const auto name = [](const std::vector<Value>& row) { return without_level(text_in(row[0])); };
  for (const auto* one : cases)
    for (const auto& row : rows_of(one->scene).rows) {
      auto known = std::ranges::find(all.rows, name(row), name);
      if (known == all.rows.end()) {
        ranges.emplace_back(number_in(row[column]), number_in(row[column]));
        all.rows.push_back(row);
        continue;
      }
      auto& [low, high] = ranges[static_cast<std::size_t>(known - all.rows.begin())];
      low = std::fmin(low, number_in(row[column])), high = std::fmax(high, number_in(row[column]));
      if (text_in((*known)[0]) != text_in(row[0])) (*known)[0] = name(row);
    }
  for (std::size_t n = 0; n < ranges.size(); ++n) {
    const auto low = fmt::format("{:.4g}", ranges[n].first), high = fmt::format("{:.4g}", ranges[n].second);
    all.rows[n][column] = low == high ? real_or_null(ranges[n].first) : Value(fmt::format("{} ... {}", low, high));
  }
  return all;
}

/// The terms that are on, as a study file would list them.
std::string terms_line(const Scene& scene) {
  std::string list;
  for (const auto& [name, term] : named_terms)
    if (scene.terms.*term) list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", name);
  return fmt::format("terms = [{}]", list);
}

void print_models(const Plan& plan) {
  for (const auto& cases : groups_that_agree(plan)) {
    const auto& first = *cases.front();
    const auto others = fmt::format(
        " and {} more (ratios from least to greatest; reasons with the numbers of the first)", cases.size() - 1);
    const auto heading = fmt::format("Models of {}{}:", first.label, cases.size() > 1 ? others : "");
    fmt::print("\n{}\n{}", wrapped(heading, 0), printed_with_text(over_cases(cases, scene_models, 3)));
    fmt::print("what is on, for a study file:\n  {}\n", wrapped(terms_line(first.scene), 2));
    fmt::print("\n{}", printed(over_cases(cases, scene_numbers, 1), Form::table));
  }
}

void print_warning(const std::string& warning) { fmt::print("\n{}\n", wrapped("warning: " + warning, 0)); }

void print_warnings(const Plan& plan) {
  std::vector<CaseWarning> all;
  for (const auto& c : plan.cases)
    for (const auto& text : warnings_of(c.one.scene)) all.push_back({c.one.label, text});
  for (const auto& warning : shared_warnings(all))
    print_warning(fmt::format("{}: {}", cases_in_words(warning), warning.text));
}

/// What plan and explain say of a scene, for programs.
void add_scene(nlohmann::ordered_json& object, const Scene& scene) {
  object["models"] = nlohmann::ordered_json::parse(printed(scene_models(scene), Form::json));
  object["numbers"] = nlohmann::ordered_json::parse(printed(scene_numbers(scene), Form::json));
  object["warnings"] = warnings_of(scene);
}

std::optional<AccuracyChoice> accuracy_of(const Study& study) {
  Problems none(study.file.string());   // what is wrong with it has been said
  return chosen_accuracy(study, read_text, none);
}

void print_plan_as_json(const Study& study, const Plan& plan) {
  const auto accuracy = accuracy_of(study);
  auto cases = nlohmann::ordered_json::parse(printed(case_rows(plan), Form::json));
  for (std::size_t n = 0; n < plan.cases.size(); ++n) {
    const auto& bed = plan.cases[n].one.scene.bed;
    cases[n]["diameter_m"] = bed.grains.diameter;
    cases[n]["grain_density_kg_per_m3"] = bed.grains.density;
    cases[n]["viscosity_m2_per_s"] = bed.fluid.viscosity;
    if (accuracy)
      cases[n]["accuracy"] = {{"target", accuracy->target},
                              {"setting", accuracy->setting},
                              {"error", accuracy->error},
                              {"cost", accuracy->cost},
                              {"from", accuracy->from}};
    add_scene(cases[n], plan.cases[n].one.scene);
  }
  fmt::print("{}\n", cases.dump(2));
}

void print_summary(const Study& study, const Plan& plan, const fs::path& results, int cores) {
  const auto count = [&](Fate fate) { return std::ranges::count(plan.cases, fate, &PlannedCase::fate); };
  double core_seconds = 0, bytes = 0;
  const auto add = [&](const Cost& cost, bool done) {
    if (!done) core_seconds += cost.core_seconds;
    bytes += cost.bytes;
  };
  for (const auto& c : plan.cases) add(predicted_cost(c.one), c.done);
  for (const auto& bed : plan.beds) add(predicted_cost(scene_of(bed)), has_bed(bed_directory(results, case_id(bed))));
  const auto done = std::ranges::count(plan.cases, true, &PlannedCase::done);
  fmt::print("{}: {} ({} new, {} kept, {} extended; {} done), {} dropped, {}; results in {}\n", study.name,
             counted(plan.cases.size(), "case"), count(Fate::fresh), count(Fate::kept), count(Fate::extended), done,
             plan.dropped.size(), counted(plan.beds.size(), "bed"), results.string());
  const bool searches = std::ranges::any_of(
      plan.cases, [](const PlannedCase& c) { return c.one.scene.onset.method == Onset::Method::bisect; });
  fmt::print("about {:.2g} core-hours for {}, about {} on {}; about {:.2g} MB on disk\n\n", core_seconds / 3600,
             searches ? "searches of usual length" : "whole ramps (a ramp ends two holds after onset)",
             duration_text(core_seconds /
                           std::max<double>(1, std::min<double>(cores, static_cast<double>(plan.cases.size())))),
             counted(cores, "core"), bytes / 1e6);
  if (const auto chosen = accuracy_of(study)) fmt::print("{}\n\n", wrapped(chosen->in_words(), 0));
}

/// The case in the study file as it stands, or one that left it.
CaseDirectory inputs_of(const CaseEntry& entry, const std::vector<Case>& cases, const fs::path& results) {
  for (const auto& one : cases)
    if (one.id == entry.id) return {one.label, one.inputs, one.scene, {}};
  return read_case_directory(results / entry.directory);
}

void explain_one(const CaseEntry& entry, const std::vector<Case>& cases, const fs::path& results) {
  const auto one = inputs_of(entry, cases, results);
  fmt::print("{}  {}  ({})\n", entry.label, short_id(entry.id), (results / entry.directory).string());
  for (const auto& line : story_of(entry, results / entry.directory)) fmt::print("  {}\n", line);
  fmt::print("\n{}\n{}", printed_with_text(scene_models(one.scene)), printed(scene_numbers(one.scene), Form::table));
  for (const auto& warning : warnings_of(one.scene)) print_warning(warning);
}

void explain_as_json(const CaseEntry& entry, const std::vector<Case>& cases, const fs::path& results) {
  const auto one = inputs_of(entry, cases, results);
  nlohmann::ordered_json json = {
      {"case", entry.id}, {"label", entry.label}, {"story", story_of(entry, results / entry.directory)}};
  add_scene(json, one.scene);
  fmt::print("{}\n", json.dump(2));
}

/// The cases of the study file and those that left it.
std::vector<CaseEntry> all_entries(const std::vector<Case>& cases, const std::vector<CaseEntry>& known) {
  std::vector<CaseEntry> entries;
  for (const auto& one : cases) entries.push_back(case_entry(one));
  for (const auto& entry : known) {
    const bool there = std::ranges::any_of(entries, [&](const CaseEntry& e) { return e.id == entry.id; });
    if (!there && !entry.is_bed) entries.push_back(entry);
  }
  return entries;
}

/// The words by which cases are named; without a word, the id of the only case.
std::vector<std::string> names_of_cases(const StudyOptions& options, const std::vector<Case>& cases,
                                        const std::vector<CaseEntry>& entries) {
  if (!options.cases.empty()) return options.cases;
  if (cases.size() == 1) return {cases.front().id};
  throw Error(ErrorKind::usage, fmt::format("{} has {} cases, and none is named", options.study, cases.size()),
              fmt::format("bedload explain {} CASE; {}", options.study, naming_of_cases(entries)));
}

}   // namespace

int plan_command(const StudyOptions& options) {
  const auto place = find_study(options.study, options.out);
  const auto study = read_study(place.file);
  const auto plan = make_plan(unfold(study), known_cases(place.directory), place.directory);
  if (options.form == Form::json) return print_plan_as_json(study, plan), 0;
  if (options.form == Form::csv) return fmt::print("{}", printed(case_rows(plan), Form::csv)), 0;
  const int cores =
      study.run.cores > 0 ? study.run.cores : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  print_summary(study, plan, place.directory, cores);
  fmt::print("{}", printed(case_rows(plan), Form::table));
  print_picked(study, plan);
  print_models(plan);
  print_warnings(plan);
  return 0;
}

int explain_command(const StudyOptions& options) {
  const auto place = find_study(options.study, options.out);
  const auto cases = unfold(read_study(place.file));
  const auto entries = all_entries(cases, known_cases(place.directory));
  for (const auto& word : names_of_cases(options, cases, entries))
    for (const auto& entry : matching_cases(entries, word))
      (options.form == Form::json ? explain_as_json : explain_one)(entry, cases, place.directory);
  return 0;
}

}   // namespace bedload

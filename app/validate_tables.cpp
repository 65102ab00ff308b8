#include "app/validate_tables.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/tables.hpp"
#include "base/build_info.hpp"
#include "studies/extremes_document.hpp"
#include "studies/mesh_table.hpp"
#include "studies/verification_document.hpp"

namespace bedload {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t widest_name = 46, widest_scene = 24;   // longer ones stand on a line of their own

/// "speed of fall [mm/s]" taken apart.
struct Quantity {
  std::string name, unit;

  explicit Quantity(const std::string& both) : name(both) {
    const auto open = both.rfind(" [");
    if (open == both.npos || !both.ends_with(']')) return;
    name = both.substr(0, open);
    unit = both.substr(open + 2, both.size() - open - 3);
  }
};

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json record_of(const ValidationRow& row) {
  const Quantity what(row.name);
  return {{"row", what.name},
          {"unit", what.unit},
          {"reference", number_or_null(row.reference)},
          {"source", row.source},
          {"against", shown_against(row)},
          {"ours", number_or_null(row.ours)},
          {"deviation", number_or_null(row.deviation())},
          {"relative", row.band.relative},
          {"band_below", number_or_null(row.band.below)},
          {"band_above", number_or_null(row.band.above)},
          {"pass", row.decides() ? Json(row.in_band()) : Json()}};
}

Json records_of(const RungResult& rung) {
  Json records = Json::array();
  for (const auto& row : rung.findings.rows) records.push_back(record_of(row));
  return records;
}

Value value_of(const Json& member) {
  if (member.is_null()) return {};
  if (member.is_boolean()) return std::string(member.get<bool>() ? "true" : "false");
  if (member.is_number()) return member.get<double>();
  return member.get<std::string>();
}

/// Where a source stands in the list below its table, from 1; put there if it is new.
std::size_t place_of(const std::string& source, std::vector<std::string>& sources) {
  const auto found = std::ranges::find(sources, source);
  if (found != sources.end()) return static_cast<std::size_t>(found - sources.begin()) + 1;
  sources.push_back(source);
  return sources.size();
}

std::string study_for_people(const RungResult& rung) {
  auto text = wrapped(fmt::format("{}: {}", rung.study, rung.what), 0) + "\n";
  if (!rung.failure.empty()) return text + wrapped("NOT RUN to its end: " + rung.failure, 0) + "\n";
  Rows rows{{"", "reference", "ours", "deviation", "band", "", "against"}, {}};
  std::vector<std::string> sources;
  for (const auto& row : rung.findings.rows) {
    const auto place = place_of(row.source, sources);
    if (row.decides())
      rows.rows.push_back({row.name, row.reference, row.ours, shown_deviation(row), shown_band(row),
                           std::string(shown_verdict(row)), fmt::format("{} [{}]", shown_against(row), place)});
    else rows.rows.push_back({row.name, {}, row.ours, {}, {}, std::string("note"), fmt::format("[{}]", place)});
  }
  text += printed_below_long_names(rows, widest_name);
  for (std::size_t n = 0; n < sources.size(); ++n) {
    const auto mark = fmt::format("  [{}] ", n + 1);
    text += mark + wrapped(sources[n], mark.size()) + "\n";
  }
  return text;
}

std::string meshes_for_people(const std::vector<MeshFall>& falls) {
  Rows table{mesh_columns(), {}};
  for (const auto& fall : falls) {
    const auto cells = mesh_cells(fall);
    table.rows.emplace_back(cells.begin(), cells.end());
  }
  return wrapped(mesh_caption, 0) + "\n" + printed(table, Form::table);
}

std::string scenes_for_people(const std::vector<ExtremeRow>& rows, const std::string& base) {
  Rows table{extremes_columns(), {}};
  const auto add = [&](const std::vector<std::string>& cells) { table.rows.emplace_back(cells.begin(), cells.end()); };
  add(extremes_limits());
  for (const auto& row : rows)
    if (row.scene.base == base) add(extremes_cells(row));
  return base + "\n" + printed_below_long_names(table, widest_scene);
}

}   // namespace

bool Climbed::passed() const { return !stopped() && std::ranges::all_of(rungs, &RungResult::passed); }

std::string ladder_for_people(const std::vector<RungResult>& rungs) {
  std::string text;
  const auto falls = mesh_falls(rungs);
  for (std::size_t n = 0; n < rungs.size(); ++n) {
    text += study_for_people(rungs[n]) + "\n";
    const bool last = n + 1 == rungs.size() || rungs[n + 1].group != rungs[n].group;
    if (last && rungs[n].group == mesh_group && !falls.empty()) text += meshes_for_people(falls) + "\n";
  }
  return text;
}

std::string ladder_summary(const Climbed& ladder) {
  std::size_t rows = 0, good = 0;
  double core_seconds = 0;
  for (const auto& rung : ladder.rungs) {
    rows += rung.findings.deciding(), good += rung.findings.in_band();
    core_seconds += rung.core_seconds;
  }
  const auto broken = std::ranges::count_if(ladder.rungs, [](const auto& rung) { return !rung.failure.empty(); });
  return fmt::format(
      "{}{} of {} rows in band{}; {:.0f} s, {:.0f} core seconds",
      ladder.stopped() ? fmt::format("stopped after {} of {} studies; ", ladder.rungs.size(), ladder.studies) : "",
      good, rows, broken > 0 ? fmt::format(", {} studies not run to their end", broken) : "", ladder.wall,
      core_seconds);
}

std::string ladder_as_json(const Climbed& ladder) {
  const auto build = build_info();
  Json json = {
      {"pass", ladder.passed()},   {"version", build.version},
      {"commit", build.commit},    {"date", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)))},
      {"quick", ladder.quick},     {"stopped", ladder.stopped()},
      {"studies", ladder.studies}, {"rungs", Json::array()}};
  for (const auto& rung : ladder.rungs)
    json["rungs"].push_back({{"group", rung.group},
                             {"study", rung.study},
                             {"what", rung.what},
                             {"cases", rung.cases},
                             {"core_seconds", rung.core_seconds},
                             {"failure", rung.failure},
                             {"pass", rung.passed()},
                             {"rows", records_of(rung)}});
  return json.dump(2) + "\n";
}

std::string ladder_as_csv(const std::vector<RungResult>& rungs) {
  Rows rows{{"group", "study"}, {}};
  const Json any = record_of({});
  for (const auto& [name, member] : any.items()) rows.columns.push_back(name);
  for (const auto& rung : rungs) {
    Json records = records_of(rung);
    if (!rung.failure.empty()) {   // a rung that could not be run is a row that did not pass
      ValidationRow none{.name = "not run to its end", .source = rung.failure};
      none.ours = none.reference = std::nan("");
      records.push_back(record_of(none));
    }
    for (const auto& record : records) {
      auto& row = rows.rows.emplace_back(std::vector<Value>{rung.group, rung.study});
      for (const auto& member : record) row.push_back(value_of(member));
    }
  }
  return printed(rows, Form::csv);
}

std::string extremes_for_people(const std::vector<ExtremeRow>& rows) {
  std::vector<std::string> bases;
  std::string text, messages;
  for (const auto& row : rows) {
    place_of(row.scene.base, bases);
    if (row.message.empty()) continue;
    const auto line =
        fmt::format("{}, {}: {}", row.scene.base, row.scene.name, row.message.substr(0, row.message.find('\n')));
    messages += "  " + wrapped(line, 4) + "\n";
  }
  for (const auto& base : bases) text += scenes_for_people(rows, base) + "\n";
  text += fmt::format("Divergence: at most {} where grains move, else {:.0e}.\n", most_left, exact_divergence);
  return messages.empty() ? text : text + "\nWhat was said\n" + messages;
}

}   // namespace bedload

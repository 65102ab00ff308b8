// `bedload curve`, `query`, `report`: results out of the database.
#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "app/commands.hpp"
#include "app/tables.hpp"
#include "base/durable_file.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "checkpoint/checkpoint_series.hpp"
#include "scheduler/attempt.hpp"
#include "solver/dimensionless.hpp"
#include "studies/case_file.hpp"
#include "studies/report.hpp"
#include "studies/report_figures.hpp"
#include "studies/study_directory.hpp"
#include "studies/study_file.hpp"
#include "studies/svg_plot.hpp"
#include "studies/threshold_curve.hpp"

namespace bedload {

namespace {

constexpr std::size_t most_pictures = 4;

BedView view_of(const CaseEntry& entry, const CaseDirectory& one, State state) {
  const auto& bed = one.scene.bed;
  const double weight = reduced_gravity(bed.grains.density / bed.fluid.density, norm(bed.gravity));
  return {.label = entry.label,
          .moment = fmt::format("after hold {}, theta = {:.3g}", state.record.holds.hold.size(), state.search.shields),
          .grains = std::move(state.grains),
          .length = bed.length,
          .diameter = bed.grains.diameter,
          .speed_scale = std::sqrt(weight * bed.grains.diameter)};
}

/// A case as it stands in its newest whole checkpoint; nothing if it has none.
std::optional<BedView> view_in(const std::filesystem::path& directory, const CaseEntry& entry) try {
  if (!std::filesystem::exists(directory / "case.toml")) return {};
  bool broken = false;
  auto state = newest_whole(directory, [&](const std::string& line) {
    broken = true;
    log_warning(line);
  });
  if (!state && broken) log_warning(fmt::format("the report has no picture of {}", entry.label));
  if (!state || state->grains.size() == 0) return {};
  return view_of(entry, read_case_directory(directory), std::move(*state));
} catch (const Error& error) {   // the rest of the report rests on the database
  log_warning(fmt::format("the report has no picture of {}: {}", entry.label, error.what()));
  return {};
}

/// The first cases that have a checkpoint.
std::vector<BedView> views(const std::vector<CaseEntry>& cases, const std::filesystem::path& results) {
  std::vector<BedView> made;
  for (const auto& entry : cases) {
    if (entry.is_bed || !entry.in_study || made.size() >= most_pictures) continue;
    if (auto view = view_in(results / entry.directory, entry)) made.push_back(std::move(*view));
  }
  return made;
}

}   // namespace

int curve_command(const StudyOptions& options) {
  const auto place = find_study(options.study, options.out);
  const auto results = open_results(place);
  const auto curve = threshold_curve(results);
  if (curve.empty())
    log_note(seeks_onset(read_study(place.file)) ? "no case that seeks an onset has finished yet"
                                                 : "no case of this study has a ramp: there is no threshold to show");
  if (curve.empty() && options.form == Form::table) return 0;
  fmt::print("{}", options.form == Form::csv    ? curve_as_csv(curve)
                   : options.form == Form::json ? curve_as_json(curve)
                   : options.form == Form::svg  ? standing_alone(threshold_figure(curve))
                                                : curve_as_table(curve, error_budget(results)));
  return 0;
}

int query_command(const StudyOptions& options, const std::string& sql) {
  const auto place = find_study(options.study, options.out);
  fmt::print("{}", printed(open_results(place).query(sql), options.form));
  return 0;
}

std::filesystem::path write_report(const StudyPlace& place) {
  const auto database = open_results(place);
  const auto file = place.directory / "report.html";
  const ReportRequest request{.study = place.directory.filename().string(),
                              .command = fmt::format("bedload run {}", place.file.filename().string()),
                              .written = utc_now(),
                              .beds = views(read_cases(database), place.directory)};
  publish(file, report_html(database, request));
  return file;
}

int report_command(const StudyOptions& options) {
  fmt::print("{}\n", write_report(find_study(options.study, options.out)).string());
  return 0;
}

}   // namespace bedload

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
#include "checkpoint/checkpoint.hpp"
#include "checkpoint/checkpoint_series.hpp"
#include "scheduler/attempt.hpp"
#include "solver/bed/onset_moment.hpp"
#include "solver/dimensionless.hpp"
#include "studies/case_file.hpp"
#include "studies/report.hpp"
#include "studies/report_figures.hpp"
#include "studies/results.hpp"
#include "studies/study_directory.hpp"
#include "studies/study_file.hpp"
#include "studies/svg_plot.hpp"
#include "studies/threshold_curve.hpp"

namespace bedload {

namespace {

constexpr std::size_t most_pictured = 4;

BedView view_of(const CaseDirectory& one, State state, std::string moment) {
  const auto& bed = one.scene.bed;
  const double weight = reduced_gravity(bed.grains.density / bed.fluid.density, norm(bed.gravity));
  return {.moment = std::move(moment),
          .grains = std::move(state.grains),
          .length = bed.length,
          .diameter = bed.grains.diameter,
          .speed_scale = std::sqrt(weight * bed.grains.diameter)};
}

/// The settled bed that the holds of a case began with; nothing if it is not there yet.
std::optional<BedView> view_at_rest(const std::filesystem::path& directory, const CaseDirectory& one) {
  const bool has_history = one.scene.shear.time > 0;
  const auto file = directory / (has_history ? "sheared.h5" : "bed.h5");
  if (!std::filesystem::exists(file)) return {};
  return view_of(one, read_checkpoint(file), has_history ? "at rest, after its shear" : "at rest");
}

/// A case at the end of the hold in which its bed began to move; nothing where none did by the criterion of now.
std::optional<BedView> view_at_onset(const std::filesystem::path& directory, const CaseDirectory& one) {
  const auto file = directory / "onset.h5";
  if (!std::filesystem::exists(file)) return {};
  State state = read_checkpoint(file);
  if (!ends_at_onset(state.record, one.scene.onset)) return {};
  const auto& holds = state.record.holds;
  auto moment = fmt::format("at onset: end of hold {}, θ = {:.3g}", holds.hold.size(), holds.shields_measured.back());
  return view_of(one, std::move(state), std::move(moment));
}

/// A case as it stands in its newest whole checkpoint; nothing if it has none. Error corrupt if all are broken.
std::optional<BedView> newest_view(const std::filesystem::path& directory, const CaseDirectory& one) {
  bool broken = false;
  auto state = newest_whole(directory, [&](const std::string& line) {
    broken = true;
    log_warning(line);
  });
  if (!state && broken) throw Error(ErrorKind::corrupt, "none of its checkpoints is whole");
  if (!state || state->grains.size() == 0) return {};
  auto moment = fmt::format("after hold {}, θ = {:.3g}", state->record.holds.hold.size(), state->search.shields);
  return view_of(one, std::move(*state), std::move(moment));
}

std::optional<BedView> view_in_motion(const std::filesystem::path& directory, const CaseDirectory& one) {
  auto at_onset = view_at_onset(directory, one);
  return at_onset ? std::move(at_onset) : newest_view(directory, one);
}

/// The pictures of a case that can be drawn. What cannot be read is said, and costs its picture alone: the rest of the
/// report rests on the database.
CaseViews views_of(const std::filesystem::path& directory, const CaseEntry& entry) {
  CaseViews of{.label = entry.label, .views = {}};
  if (!std::filesystem::exists(directory / "case.toml")) return of;
  using View = std::optional<BedView>(const std::filesystem::path&, const CaseDirectory&);
  const std::pair<std::string_view, View*> moments[] = {{"at rest", view_at_rest}, {"in motion", view_in_motion}};
  for (const auto& [when, view] : moments) try {
      if (auto drawn = view(directory, read_case_directory(directory))) of.views.push_back(std::move(*drawn));
    } catch (const Error& error) {
      log_warning(fmt::format("the report has no picture of {} {}: {}", entry.label, when, error.what()));
    }
  return of;
}

/// The first cases that have a bed to show.
std::vector<CaseViews> views(const std::vector<CaseEntry>& cases, const std::filesystem::path& results) {
  std::vector<CaseViews> made;
  for (const auto& entry : cases) {
    if (entry.is_bed || !entry.in_study || made.size() >= most_pictured) continue;
    auto of = views_of(results / entry.directory, entry);
    if (!of.views.empty()) made.push_back(std::move(of));
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
                   : options.form == Form::json ? curve_as_json(curve, motion_measures(results))
                   : options.form == Form::svg
                       ? standing_alone(of_one_grain(curve) ? side_by_side_figure(curve) : threshold_figure(curve))
                       : curve_as_table(curve, error_budget(results)) + motion_as_table(motion_measures(results)));
  const std::string unsteady = options.form == Form::table ? unsteady_holds(results) : "";
  if (!unsteady.empty()) fmt::print("warning: {}\n", unsteady);
  return 0;
}

int query_command(const StudyOptions& options, const std::string& sql) {
  const auto place = find_study(options.study, options.out);
  fmt::print("{}", printed(open_results(place).query(sql), options.form));
  return 0;
}

namespace {

/// What a study with [[trade]] has measured so far, without lone falls, which take their time.
std::optional<Trade> trade_of(const Database& database, const StudyPlace& place) {
  try {
    const auto study = read_study(place.file);
    if (!study.trades.empty()) return measured_trade(database, study, unfold(study));
  } catch (const Error& error) {
    log_note(fmt::format("the report has no trade: {}", error.what()));
  }
  return {};
}

}   // namespace

std::filesystem::path write_report(const StudyPlace& place) {
  const auto database = open_results(place);
  const auto file = place.directory / "report.html";
  const ReportRequest request{.study = place.directory.filename().string(),
                              .command = fmt::format("bedload run {}", place.file.filename().string()),
                              .written = utc_now(),
                              .beds = views(read_cases(database), place.directory),
                              .trade = trade_of(database, place)};
  publish(file, report_html(database, request));
  return file;
}

int report_command(const StudyOptions& options) {
  fmt::print("{}\n", write_report(find_study(options.study, options.out)).string());
  return 0;
}

}   // namespace bedload

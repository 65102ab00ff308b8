// `bedload trade`: runs what a study's [[trade]] asks for, then says what each setting costs and changes.
#include <fmt/format.h>

#include <algorithm>

#include "app/commands.hpp"
#include "base/durable_file.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "studies/case_entry.hpp"
#include "studies/plan.hpp"
#include "studies/study_file.hpp"
#include "studies/svg_plot.hpp"
#include "studies/trade.hpp"

namespace bedload {

namespace {

/// The cases that a budget allows: the finest setting's, then of the others, in the order of the study file, each that still fits with all its
/// packings.
std::vector<std::string> within(double core_hours, const std::vector<Case>& cases) {
  std::vector<std::string> ids;
  double left = core_hours;
  for (auto first = cases.begin(); first != cases.end();) {
    const auto end = std::find_if(first, cases.end(), [&](const Case& c) { return c.variation != first->variation; });
    double hours = 0;
    for (auto one = first; one != end; ++one) hours += predicted_cost(one->scene).core_seconds / 3600;
    if (hours <= left || ids.empty()) {
      left -= hours;
      for (auto one = first; one != end; ++one) ids.push_back(one->id);
    }
    first = end;
  }
  if (ids.size() < cases.size())
    log_note(fmt::format("the budget allows {} of {} cases, by `bedload plan`'s prediction", ids.size(), cases.size()));
  return ids;
}

}   // namespace

int trade_command(RunOptionsOfCommand options, std::optional<double> core_hours) {
  const auto place = find_study(options.study.study, options.study.out);
  const auto study = read_study(place.file);
  refuse_without_trades(study);
  const auto cases = unfold(study);
  if (core_hours) options.study.cases = within(*core_hours, cases);
  const int code = run_command(options);
  const bool complete = code == 0 || code == static_cast<int>(ErrorKind::some_failed);   // what failed is not compared
  if (!complete) return code;
  auto trade = measured_trade(open_results(place), study, cases);
  add_lone_falls(trade, cases);
  Database results(place.directory / "study.db", Database::Mode::write);
  store_trade(results, trade);
  publish(place.directory / "trade.json", trade_as_json(trade));
  publish(place.directory / "trade.svg", standing_alone(trade_figure(trade)));
  fmt::print("{}", options.study.form == Form::json ? trade_as_json(trade) : trade_as_table(trade));
  log_note(fmt::format("{} and trade.svg beside it; another study uses it with models.accuracy",
                       (place.directory / "trade.json").string()));
  return code;
}

}   // namespace bedload

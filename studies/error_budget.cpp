#include "studies/error_budget.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "studies/database_values.hpp"
#include "studies/study.hpp"

namespace bedload {

namespace {

std::string_view words_for(const std::string& source) {
  if (source == "bracket") return "bracket / 4";
  if (source == "hold") return "hold x 3";
  if (source == "mesh") return "mesh x 2";
  return source == "area" ? "area x 4" : std::string_view(source);
}

}   // namespace

void store_variations(Database& database, const std::vector<Case>& cases) {
  Database::Transaction transaction(database);
  database.execute("DELETE FROM variations");
  for (const Case& one : cases)
    if (!one.base_id.empty())
      database.execute("INSERT INTO variations VALUES (?, ?, ?)", {one.id, one.variation, one.base_id});
  transaction.commit();
}

std::vector<BudgetEntry> error_budget(const Database& database) {
  std::vector<BudgetEntry> budget;
  if (!has_table(database, "error_budget")) return budget;
  std::vector<Differences> all;
  const auto rows = database.query(
      "SELECT source, set_label, shields_base, base_lower, base_upper, shields_pair, pair_lower, pair_upper, base_id "
      "FROM "
      "error_budget WHERE source IN ('bracket', 'hold', 'mesh', 'area') ORDER BY source, seed");
  for (const auto& row : rows.rows) {
    const std::string source = text_in(row[0]);
    if (budget.empty() || budget.back().source != source) {
      budget.push_back({.source = source, .label = text_in(row[1])});
      all.emplace_back();
    }
    auto single = log_ratio(number_in(row[2]), number_in(row[3]), number_in(row[4]), number_in(row[5]),
                            number_in(row[6]), number_in(row[7]));
    single.packing = text_in(row[8]);
    if (std::isfinite(single.difference)) all.back().push_back(single), ++budget.back().packings;
  }
  Scatter scatter = scatter_of(all);
  const bool known = scatter.freedom > 0;
  if (!known) scatter = {0, std::numeric_limits<double>::infinity()};   // the brackets alone, and the words say so
  for (std::size_t n = 0; n < budget.size(); ++n)
    budget[n].theta = relative(paired(all[n], scatter)), budget[n].scatter_known = known;
  return budget;
}

namespace {

double size_of(const BudgetEntry& e) { return e.theta.seen() ? std::abs(e.theta.mean) : e.theta.worst(); }

}   // namespace

void store_error_sources(Database& database) {
  database.execute("DELETE FROM error_sources");
  for (const BudgetEntry& e : error_budget(database))
    database.execute("INSERT INTO error_sources VALUES (?, ?, ?, ?, ?, ?, ?, ?)",
                     {e.source, e.label, static_cast<std::int64_t>(e.packings), real_or_null(e.theta.mean),
                      real_or_null(e.theta.low), real_or_null(e.theta.high), std::int64_t{e.scatter_known},
                      real_or_null(size_of(e))});
}

double systematic_error(const std::vector<BudgetEntry>& budget) {
  if (std::ranges::none_of(budget, [](const BudgetEntry& e) { return e.source == "mesh" && e.packings > 0; }))
    return std::numeric_limits<double>::quiet_NaN();
  double squares = 0;
  for (const BudgetEntry& e : budget)
    if (e.packings > 0) squares += size_of(e) * size_of(e);
  return std::sqrt(squares);
}

std::string budget_in_words(const std::vector<BudgetEntry>& budget) {
  if (budget.empty()) return "mesh not tested";
  std::string text;
  std::size_t packings = 0;
  for (const BudgetEntry& e : budget) {
    if (!text.empty()) text += ", ";
    text += std::string(words_for(e.source)) + " ";
    if (e.packings == 0) text += "unknown (one of each pair is censored)";
    else if (!e.theta.seen()) text += fmt::format("< {:.2g} %", 100 * e.theta.worst());
    else text += fmt::format("{:+.2g} %", 100 * e.theta.mean);
    packings = std::max(packings, e.packings);
  }
  const double together = systematic_error(budget);
  const bool all = std::ranges::all_of(budget, [](const BudgetEntry& e) { return e.packings > 0; });
  if (std::isfinite(together)) text += fmt::format("; together {}{:.2g} %", all ? "" : "at least ", 100 * together);
  else text += "; mesh not tested";
  text += fmt::format(" ({} packing{} of {}", packings, packings == 1 ? "" : "s", budget.front().label);
  return text + (budget.front().scatter_known ? ")" : ": how far it scatters is not known)");
}

}   // namespace bedload

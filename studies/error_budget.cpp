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

double BudgetEntry::size() const { return std::fmax(std::abs(difference), uncertainty); }

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
  for (const auto& row :
       database.query("SELECT source, label, difference, uncertainty FROM error_budget ORDER BY source").rows)
    budget.push_back({text_in(row[0]), text_in(row[1]), number_in(row[2]), number_in(row[3])});
  return budget;
}

double systematic_error(const std::vector<BudgetEntry>& budget) {
  const auto known = [](const BudgetEntry& e) { return std::isfinite(e.difference); };
  if (std::ranges::none_of(budget, [&](const BudgetEntry& e) { return e.source == "mesh" && known(e); }))
    return std::numeric_limits<double>::quiet_NaN();
  double squares = 0;
  for (const BudgetEntry& e : budget)
    if (known(e)) squares += e.size() * e.size();
  return std::sqrt(squares);
}

std::string budget_in_words(const std::vector<BudgetEntry>& budget) {
  std::string text;
  for (const BudgetEntry& e : budget) {
    if (!text.empty()) text += ", ";
    text += std::string(words_for(e.source)) + " ";
    if (!std::isfinite(e.difference)) text += "unknown (one of the pair is censored)";
    else if (std::abs(e.difference) <= e.uncertainty) text += fmt::format("< {:.2g} %", 100 * e.uncertainty);
    else text += fmt::format("{:+.2g} %", 100 * e.difference);
  }
  const double together = systematic_error(budget);
  if (std::isfinite(together)) text += fmt::format("; together {:.2g} %", 100 * together);
  else text += text.empty() ? "mesh not tested" : "; mesh not tested";
  return budget.empty() ? text : fmt::format("{} (pairs of {})", text, budget.front().label);
}

}   // namespace bedload

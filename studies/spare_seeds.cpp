#include "studies/spare_seeds.hpp"

#include <algorithm>
#include <map>

#include "studies/database_values.hpp"
#include "studies/study.hpp"
#include "studies/threshold_curve.hpp"

namespace bedload {

namespace {

using Brackets = std::map<std::string, SeedBracket, std::less<>>;   // by case

Brackets stored_brackets(const Database& database) {
  Brackets found;
  const auto rows = database.query(
      "SELECT case_id, s.seed, t.shields_lower, t.shields_upper FROM thresholds t JOIN scenes s USING (case_id) "
      "WHERE t.decides = 1");
  for (const auto& row : rows.rows)
    found[text_in(row[0])] =
        seed_bracket(static_cast<std::uint64_t>(number_in(row[1])), number_in(row[2]), number_in(row[3]));
  return found;
}

/// How many of the seeds, in their order, are needed.
std::size_t needed(const std::vector<const Case*>& seeds, const Brackets& stored, const SeedRule& rule) {
  const auto batch = static_cast<std::size_t>(rule.batch);
  std::vector<SeedBracket> finished;
  for (const Case* one : seeds) {
    const auto bracket = stored.find(one->id);
    if (bracket == stored.end()) break;
    finished.push_back(bracket->second);
    const bool whole_batch = finished.size() % batch == 0;
    if (whole_batch && enough_seeds(finished, rule.batch, *rule.interval, static_cast<int>(seeds.size())))
      return finished.size();
  }
  return std::min(seeds.size(), (finished.size() / batch + 1) * batch);
}

}   // namespace

std::vector<std::string> spare_seeds(const Database& database, const std::vector<Case>& cases, const SeedRule& rule) {
  if (!rule.interval) return {};
  std::map<std::string, std::vector<const Case*>> sets;
  for (const Case& one : cases)
    if (one.scene.onset.method != Onset::Method::none) sets[one.set].push_back(&one);
  const auto stored = stored_brackets(database);
  std::vector<std::string> spare;
  for (auto& [set, seeds] : sets) {
    std::ranges::sort(seeds, {}, &Case::seed);
    for (std::size_t k = needed(seeds, stored, rule); k < seeds.size(); ++k) spare.push_back(seeds[k]->id);
  }
  return spare;
}

}   // namespace bedload

// Axes to cases.
#include "studies/study.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "base/error.hpp"
#include "solver/expected_bed.hpp"
#include "solver/grains/bed_packing.hpp"
#include "solver/grains/suspension.hpp"
#include "solver/scene_range.hpp"
#include "studies/accuracy.hpp"
#include "studies/case_identity.hpp"
#include "studies/case_warnings.hpp"
#include "studies/setting_text.hpp"
#include "studies/setting_value.hpp"
#include "studies/study_keys.hpp"
#include "studies/variation.hpp"

namespace bedload {

namespace fs = std::filesystem;

namespace {

using Choice = std::vector<const Setting*>;   // one value per axis

/// All combinations; the last axis varies fastest.
std::vector<Choice> product(const std::vector<Axis>& axes) {
  std::vector<Choice> choices{{}};
  for (const auto& axis : axes) {
    std::vector<Choice> longer;
    for (const auto& choice : choices)
      for (const auto& value : axis.values) {
        longer.push_back(choice);
        longer.back().push_back(&value);
      }
    choices = std::move(longer);
  }
  return choices;
}

bool excluded(const Study& study, const Choice& choice) {
  const auto matches = [&](const Settings& exclusion) {
    if (exclusion.empty()) return false;
    return std::ranges::all_of(exclusion, [&](const auto& entry) {
      for (std::size_t a = 0; a < study.axes.size(); ++a)
        if (study.axes[a].key == entry.first) return same_value(*choice[a], entry.second);
      return false;
    });
  };
  return std::ranges::any_of(study.exclusions, matches);
}

/// Text as it may stand in a label, which is a file name and meets globs.
std::string fit_for_label(const std::string& text) {
  std::string fit;
  for (const char c : text) {
    if (c == ' ') continue;
    fit += c == '/' || c == '*' || c == '[' || c == ']' || c == ',' ? '_' : c;
  }
  return fit;
}

/// The value as it stands in a label: "0.5 mm" -> 0.5mm, "2000 kg/m3" -> 2000, a list of terms -> its initials.
std::string in_label(const Setting& setting) {
  if (const auto* words = std::get_if<std::vector<std::string>>(&setting.value)) {
    std::string initials;
    for (const auto& word : *words) initials += word[0];
    return initials;
  }
  const bool density = std::holds_alternative<Quantity>(setting.value) &&
                       std::get<Quantity>(setting.value).dimension == dimension::density;
  const auto end = density && setting.text.ends_with("kg/m3") ? setting.text.size() - 5 : setting.text.size();
  return fit_for_label(setting.text.substr(0, end));
}

void append(std::string& label, const std::string& part) { label += (label.empty() ? "" : "-") + part; }

/// Label of a set: its place on every axis but the seed's; the study's name where there is none.
std::string label_of(const Study& study, const Choice& choice) {
  std::string label;
  for (std::size_t a = 0; a < study.axes.size(); ++a) {
    const auto& key = study.axes[a].key;
    if (key != "bed.seed") append(label, std::string(find_key(key)->label) + in_label(*choice[a]));
  }
  return label.empty() ? fit_for_label(study.name) : label;
}

Settings settings_of(const Study& study, const Choice& choice) {
  Settings settings = study.settings;
  for (std::size_t a = 0; a < study.axes.size(); ++a) settings[study.axes[a].key] = *choice[a];
  return settings;
}

Place place_in(const Settings& settings, std::string_view key) {
  if (const auto found = settings.find(key); found != settings.end()) return found->second.place;
  const auto table = fmt::format("{}.", key.substr(0, key.find('.')));
  for (const auto& [other, setting] : settings)
    if (other.starts_with(table)) return setting.place;   // the key is left out: its table
  return {};
}

void add_problems(const std::vector<SceneProblem>& found, const Settings& settings, Problems& problems) {
  for (const auto& p : found)
    problems.add(place_in(settings, p.parameter), fmt::format("{}: {}", p.parameter, p.message), p.hint);
}

/// Grains that cannot be placed: found by placing them, once per bed; those of a suspension take long.
void check_placing(const Scene& scene, const Settings& settings, Problems& problems) {
  try {
    if (scene.bed.source.kind == BedSource::Kind::suspension)
      check_suspension_fits(scene.bed, largest_diameter(scene.bed));
    else place_grains(scene.bed);
  } catch (const Error& error) {
    const std::string key = scene.bed.source.kind == BedSource::Kind::file ? "bed.file" : "bed.count";
    problems.add(place_in(settings, key), fmt::format("{}: {}", key, error.what()), error.hint);
  }
}

/// Where the cases leave the range of their models: each value of the file is blamed once for all cases that it puts there.
class RangeProblems {
 public:
  explicit RangeProblems(const Study& study) : study_(study) {}
  void add(const Case&, const Choice&, const Settings&);
  void report(Problems&) const;

 private:
  struct Value {
    std::string name;   // "grains.diameter[2]"
    Place place;
    std::vector<CaseWarning> found;
    std::vector<std::string> hints;   // of each found
  };
  Value& value_of(const Choice&, const Settings&, const std::string& key);

  const Study& study_;
  std::vector<Value> values_;   // in order of first appearance
};

RangeProblems::Value& RangeProblems::value_of(const Choice& choice, const Settings& settings, const std::string& key) {
  auto name = key;
  for (std::size_t a = 0; a < study_.axes.size(); ++a)
    if (study_.axes[a].key == key)
      name = indexed(key, static_cast<std::size_t>(choice[a] - study_.axes[a].values.data()) + 1);
  const auto known = std::ranges::find(values_, name, &Value::name);
  return known != values_.end() ? *known : values_.emplace_back(Value{name, place_in(settings, key), {}, {}});
}

void RangeProblems::add(const Case& one, const Choice& choice, const Settings& settings) {
  for (const auto& p : range_problems_of(one.scene)) {
    auto& value = value_of(choice, settings, p.parameter);
    value.found.push_back({one.label, p.message});
    value.hints.push_back(p.hint);
  }
}

void RangeProblems::report(Problems& problems) const {
  for (const auto& value : values_)
    for (const auto& shared : shared_warnings(value.found)) {
      const auto first = std::ranges::find(value.found, shared.text, &CaseWarning::text) - value.found.begin();
      problems.add(value.place, fmt::format("{}: {} ({})", value.name, shared.text, cases_in_words(shared)),
                   value.hints[static_cast<std::size_t>(first)]);
    }
}

bool is_strict(const Settings& settings) {
  const auto found = settings.find("models.strict");
  return found != settings.end() && std::get<std::string>(found->second.value) == "true";
}

Case make_case(const std::string& set_label, CaseInputs inputs) {
  Case made;
  made.id = case_id(inputs), made.set = parameter_set_id(inputs), made.bed_id = bed_id(inputs);
  made.set_label = set_label;
  made.label = made.set_label;
  if (inputs.has("bed.seed")) {
    made.seed = static_cast<std::uint64_t>(inputs.number("bed.seed"));
    append(made.label, fmt::format("s{}", made.seed));
  }
  made.scene = scene_of(inputs);
  made.inputs = std::move(inputs);
  return made;
}

/// Two ways to write the same case ("0.5 mm" and "1 d") would be run once and counted twice.
void check_twins(const std::vector<Case>& cases, Problems& problems) {
  std::map<std::string, std::string> seen;
  for (const auto& one : cases) {
    const auto [earlier, is_new] = seen.emplace(one.id, one.label);
    if (!is_new)
      problems.add({}, fmt::format("{} and {} are the same case", earlier->second, one.label),
                   "remove one of the values");
  }
}

/// Makes cases one by one, and gathers what is wrong with them.
class Unfolding {
 public:
  Unfolding(const Study& study, const TableReader& read_table)
      : study_(study), read_table_(read_table), problems_(study.file.string()), out_of_range_(study) {}

  std::vector<Case> all();

 private:
  void add(const Choice&, const Variation* = nullptr, const std::string& base_id = {});
  void choose_settings(Settings&);
  Settings base_settings(const Choice&);
  void judge_distance(Case&);
  void add_budget(const std::vector<const Choice*>&);
  void add_trades(const std::vector<const Choice*>&);

  const Study& study_;
  const TableReader& read_table_;
  Problems problems_;
  RangeProblems out_of_range_;
  std::vector<Case> cases_;
  std::optional<AccuracyChoice> accuracy_;
  std::set<std::string> placed_;   // beds whose grains have been placed
};

/// What the trade says; a value of the study's own beside it would be one of the two only. "auto" leaves it to the trade.
void Unfolding::choose_settings(Settings& settings) {
  for (const auto& [key, chosen] : accuracy_->settings) {
    const auto [there, is_new] = settings.insert({key, chosen});
    if (there->second.text == "auto") there->second = chosen;
    if (!is_new && !same_value(there->second, chosen))
      problems_.add(there->second.place,
                    fmt::format("{}: {} stands beside models.accuracy, which chooses it", key, there->second.text),
                    fmt::format("leave it out, or models.accuracy ({} = {})", key, as_toml(chosen)));
  }
}

void Unfolding::judge_distance(Case& one) {
  one.pace = accuracy_->pace;
  auto why = too_far(*accuracy_, one.scene);
  if (why.empty()) why = of_another_scale(*accuracy_, one.scene);
  if (!why.empty())
    problems_.add(place_in(study_.settings, "models.accuracy.from"),
                  fmt::format("models.accuracy: {}: {}", one.label, why),
                  "a trade of a scene like this one: bedload trade");
}

/// Of a case of the axes: what its variations change.
Settings Unfolding::base_settings(const Choice& choice) {
  auto settings = settings_of(study_, choice);
  if (accuracy_) choose_settings(settings);
  return settings;
}

/// A case of the axes, or a variation of one.
void Unfolding::add(const Choice& choice, const Variation* variation, const std::string& base_id) {
  auto settings = base_settings(choice);
  if (variation)
    for (const auto& [key, setting] : variation->changes) settings[key] = setting;
  auto inputs = resolve(settings, study_.file.parent_path(), problems_, read_table_);
  if (!problems_.empty()) return;
  auto one = make_case(label_of(study_, choice) + (variation ? "-" + variation->name : ""), std::move(inputs));
  if (variation) one.variation = variation->name, one.changes = variation->changes, one.base_id = base_id;
  if (accuracy_) judge_distance(one);
  add_problems(problems_of(one.scene), settings, problems_);
  if (problems_.empty() && is_strict(study_.settings)) out_of_range_.add(one, choice, settings);
  if (problems_.empty() && placed_.insert(one.bed_id.empty() ? one.id : one.bed_id).second)
    check_placing(one.scene, settings, problems_);
  cases_.push_back(std::move(one));
}

/// Some packings of the first scene pay for all: seeds that any run of the study needs.
void Unfolding::add_budget(const std::vector<const Choice*>& kept) {
  std::vector<std::size_t> packings;
  for (std::size_t n = 0; n < kept.size(); ++n)
    if (cases_[n].set == cases_[0].set) packings.push_back(n);
  std::ranges::sort(packings, {}, [&](std::size_t n) { return cases_[n].seed; });
  const auto sure = study_.seeds.interval ? std::min(budget_packings, study_.seeds.batch) : budget_packings;
  packings.resize(std::min(packings.size(), static_cast<std::size_t>(sure)));
  for (const std::size_t n : packings)
    for (const auto& pair : budget_pairs(base_settings(*kept[n]), study_.budget)) {
      if (cases_[n].scene.onset.method != Onset::Method::bisect)
        return problems_.add(place_in(study_.settings, "onset.budget"),
                             "onset.budget: a ramp is a screening and has no error budget",
                             "onset.method = \"bisect\"");
      if (problems_.empty()) add(*kept[n], &pair, cases_[n].id);
    }
}

/// Every packing, each against itself.
void Unfolding::add_trades(const std::vector<const Choice*>& packings) {
  std::set<std::string> names{"finest", "bracket", "hold", "mesh",
                              "area"};   // of the study itself, and of error budgets
  for (Variation trade : study_.trades) {
    if (trade.name.empty())
      for (const auto& [key, setting] : trade.changes)
        append(trade.name, std::string(find_key(key)->label) + in_label(setting));
    trade.name = fit_for_label(trade.name);
    if (!names.insert(trade.name).second)
      problems_.add(trade.changes.begin()->second.place, fmt::format("trade: {} is called so already", trade.name),
                    "name = \"...\", another for each [[trade]]");
    for (std::size_t n = 0; n < packings.size(); ++n)
      if (problems_.empty()) add(*packings[n], &trade, cases_[n].id);
  }
}

std::vector<Case> Unfolding::all() {
  accuracy_ = chosen_accuracy(study_, read_table_, problems_);
  const auto choices = product(study_.axes);
  std::vector<const Choice*> kept;
  for (const auto& choice : choices) {
    if (excluded(study_, choice)) continue;
    kept.push_back(&choice);
    add(choice);
  }
  if (!study_.budget.empty() && !study_.trades.empty())
    problems_.add(place_in(study_.settings, "onset.budget"),
                  "onset.budget: this study has [[trade]], which measures such pairs for every packing",
                  "leave one of the two out");
  if (problems_.empty()) add_budget(kept);
  add_trades(kept);
  if (problems_.empty()) out_of_range_.report(problems_);
  check_twins(cases_, problems_);
  if (problems_.empty() && cases_.empty()) problems_.add({}, "every case is excluded", "remove an [[exclude]]");
  problems_.throw_if_any();
  return std::move(cases_);
}

}   // namespace

std::vector<Case> unfold(const Study& study, const TableReader& read_table) {
  return Unfolding(study, read_table).all();
}

bool seeks_onset(const Study& study) {
  return std::ranges::any_of(unfold(study),
                             [](const Case& one) { return one.scene.onset.method != Onset::Method::none; });
}

fs::path result_directory(const Study& study, const std::optional<fs::path>& out) {
  return out ? *out : study.file.parent_path() / study.name;
}

}   // namespace bedload

// TOML to settings: every value is checked against its key where it stands. The only file that includes toml++.
#include "studies/study_file.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "base/durable_file.hpp"
#include "base/error.hpp"
#include "studies/study_keys.hpp"

namespace bedload {

namespace {

using Kind = StudyKey::Kind;
using Range = StudyKey::Range;

Place place_of(const toml::node& node) {
  return {static_cast<int>(node.source().begin.line), static_cast<int>(node.source().begin.column)};
}
Place place_of(const toml::key& key) {
  return {static_cast<int>(key.source().begin.line), static_cast<int>(key.source().begin.column)};
}

/// The value as it would be written in the file, for messages.
std::string shown(const toml::node& node) {
  if (const auto* number = node.as_floating_point()) return shortest(number->get());
  std::ostringstream out;
  node.visit([&](const auto& n) { out << n; });
  auto text = out.str();
  for (auto& c : text) c = c == '\n' ? ' ' : c;
  return text;
}

/// Where a refused value stood: "grains.diameter" or, in a list, "grains.diameter[2]", counted from 1.
std::string indexed(std::string_view path, std::size_t number) { return fmt::format("{}[{}]", path, number); }

/// "lid|pressure|none" as "lid, pressure, none".
std::string listed(std::string_view choices) {
  std::string text;
  for (const char c : choices) text += c == '|' ? std::string(", ") : std::string(1, c);
  return text;
}

/// Reads one file: walks its tables, fills settings and axes, notes every problem.
class Reader {
 public:
  Reader(Problems& problems, bool case_file) : problems_(problems), case_file_(case_file) {}

  void read(const toml::table& root);

  Settings settings;
  std::vector<Axis> axes;
  std::vector<Settings> exclusions;
  bool bed_only = false;

 private:
  void walk(const toml::table&, const std::string& prefix, Settings& into, bool axes_allowed);
  void entry(const std::string& path, const toml::key&, const toml::node&, Settings& into, bool axes_allowed);
  void value_or_axis(const StudyKey&, const toml::node&, Settings& into, bool axes_allowed);
  void axis(const StudyKey&, const toml::array&);
  void counted_seeds(const StudyKey&, const toml::table&, bool axes_allowed);
  void unknown(const std::string& path, Place);
  void exclusions_of(const toml::node&);
  void check_format(const toml::table&);

  std::optional<Setting> value(const StudyKey&, const std::string& name, const toml::node&);
  std::optional<SettingValue> number(const StudyKey&, const std::string& name, const toml::node&);
  std::optional<SettingValue> count(const StudyKey&, const std::string& name, const toml::node&);
  std::optional<SettingValue> quantity(const StudyKey&, const std::string& name, const toml::node&);
  std::optional<SettingValue> word(const StudyKey&, const std::string& name, const toml::node&);
  std::optional<SettingValue> words(const StudyKey&, const std::string& name, const toml::node&);
  std::optional<SettingValue> ids(const std::string& name, const toml::node&);
  bool in_range(const StudyKey&, const std::string& name, const toml::node&, double value);

  Problems& problems_;
  bool case_file_;
};

void Reader::read(const toml::table& root) {
  check_format(root);
  walk(root, "", settings, true);
  if (const auto* node = root.get("exclude")) exclusions_of(*node);
}

void Reader::check_format(const toml::table& root) {
  const auto* node = root.get("format");
  if (!node) return problems_.add({1, 1}, "format is missing", "the first line of a study file is: format = 1");
  const auto format = node->value_exact<std::int64_t>();
  if (format == 1) return;
  problems_.add(place_of(*node), fmt::format("format: {} is not a format that this bedload reads", shown(*node)),
                "this version reads format = 1");
}

void Reader::walk(const toml::table& table, const std::string& prefix, Settings& into, bool axes_allowed) {
  for (const auto& [key, node] : table) {
    const std::string path = prefix + std::string(key.str());
    if (prefix.empty() && (path == "format" || path == "exclude")) continue;
    if (path == "bed_only" && case_file_ && node.is_boolean()) {
      bed_only = node.as_boolean()->get();
      continue;
    }
    entry(path, key, node, into, axes_allowed);
  }
}

void Reader::entry(const std::string& path, const toml::key& key, const toml::node& node, Settings& into,
                   bool axes_allowed) {
  if (const auto* known = find_key(path)) return value_or_axis(*known, node, into, axes_allowed);
  if (!is_table(path)) return unknown(path, place_of(key));
  if (const auto* table = node.as_table()) return walk(*table, path + ".", into, axes_allowed);
  if (const auto* from = find_key(path + ".from")) return value_or_axis(*from, node, into, axes_allowed);   // one level
  problems_.add(place_of(node), fmt::format("{}: {} is not a table", path, shown(node)),
                fmt::format("write [{}] and its keys below it", path));
}

void Reader::unknown(const std::string& path, Place place) {
  if (const auto what = later_key(path); !what.empty())
    return problems_.add(place, fmt::format("{}: {} are not in this version", path, what), "leave the key out");
  const auto nearest = nearest_key(path);
  problems_.add(place, fmt::format("{} is not a key of a study file", path),
                nearest.empty() ? "docs/study_files.md lists the keys" : fmt::format("did you mean {}?", nearest));
}

void Reader::value_or_axis(const StudyKey& key, const toml::node& node, Settings& into, bool axes_allowed) {
  const std::string path(key.path);
  if (const auto* table = node.as_table(); table && path == "bed.seed") return counted_seeds(key, *table, axes_allowed);
  const auto* list = node.as_array();
  const bool by_nature = key.kind == Kind::words || key.kind == Kind::ids;
  const bool is_axis = list && (!by_nature || (!list->empty() && list->is_homogeneous(toml::node_type::array)));
  if (!is_axis) {
    if (auto one = value(key, path, node)) into.insert_or_assign(path, std::move(*one));
    return;
  }
  if (axes_allowed) return axis(key, *list);
  problems_.add(place_of(node), fmt::format("{}: a list cannot stand here", path), "write one [[exclude]] per value");
}

void Reader::axis(const StudyKey& key, const toml::array& list) {
  const std::string path(key.path);
  if (case_file_ || !key.physics) {
    return problems_.add(
        place_of(list),
        fmt::format("{}: a list is an axis, and this key is not physics: it cannot vary within a study", path),
        "give one value");
  }
  if (list.empty())
    return problems_.add(place_of(list), fmt::format("{}: the list is empty", path), "an axis needs a value");
  Axis made{path, {}};
  for (std::size_t n = 0; n < list.size(); ++n) {
    auto one = value(key, indexed(path, n + 1), list[n]);
    if (!one) continue;
    const bool twice =
        std::ranges::any_of(made.values, [&](const Setting& earlier) { return same_value(earlier, *one); });
    if (twice)
      problems_.add(one->place, fmt::format("{}: {} stands twice in this list", indexed(path, n + 1), one->text),
                    "remove one");
    else made.values.push_back(std::move(*one));
  }
  axes.push_back(std::move(made));
}

/// seed = { count = 3 } is the axis 1, 2, 3: adding packings later keeps those that were run.
void Reader::counted_seeds(const StudyKey& key, const toml::table& table, bool axes_allowed) {
  const auto* node = table.get("count");
  const std::string path(key.path);
  if (!node || table.size() != 1 || !axes_allowed || case_file_) {
    return problems_.add(place_of(table), fmt::format("{}: {} is not a seed", path, shown(table)),
                         "write seed = { count = 3 } or seed = 1");
  }
  const auto counted = value(key, path + ".count", *node);
  if (!counted) return;
  Axis made{path, {}};
  for (int n = 1; n <= std::get<double>(counted->value); ++n)
    made.values.push_back({double(n), fmt::format("{}", n), place_of(*node)});
  axes.push_back(std::move(made));
}

void Reader::exclusions_of(const toml::node& node) {
  const auto* list = node.as_array();
  if (!list || !list->is_homogeneous(toml::node_type::table) || case_file_) {
    return problems_.add(place_of(node), "exclude: this is not a list of tables",
                         "write [[exclude]] and below it, for example, grains.diameter = \"0.5 mm\"");
  }
  for (const auto& table : *list) {
    Settings one;
    walk(*table.as_table(), "", one, false);
    for (const auto& [path, setting] : one) {
      const bool varies =
          std::ranges::any_of(axes, [&, p = std::string_view(path)](const Axis& a) { return a.key == p; });
      if (!varies)
        problems_.add(setting.place, fmt::format("exclude: {} does not vary in this study", path),
                      "name keys that are axes");
    }
    exclusions.push_back(std::move(one));
  }
}

std::optional<Setting> Reader::value(const StudyKey& key, const std::string& name, const toml::node& node) {
  const auto read = [&]() -> std::optional<SettingValue> {
    switch (key.kind) {
      case Kind::number: return number(key, name, node);
      case Kind::count: return count(key, name, node);
      case Kind::quantity: return quantity(key, name, node);
      case Kind::text:
      case Kind::word: return word(key, name, node);
      case Kind::words: return words(key, name, node);
      case Kind::ids: return ids(name, node);
    }
    return std::nullopt;
  }();
  if (!read) return std::nullopt;
  return Setting{*read, node.is_string() ? node.as_string()->get() : shown(node), place_of(node)};
}

bool Reader::in_range(const StudyKey& key, const std::string& name, const toml::node& node, double value) {
  const bool good = std::isfinite(value) &&
                    (key.range == Range::any || value > 0 || (key.range == Range::not_negative && value == 0));
  if (good) return true;
  const auto wanted = !std::isfinite(value)          ? "finite"
                      : key.range == Range::positive ? "greater than zero"
                                                     : "zero or greater";
  problems_.add(place_of(node), fmt::format("{}: {} must be {}", name, shown(node), wanted),
                fmt::format("give a value that is {}", wanted));
  return false;
}

std::optional<SettingValue> Reader::number(const StudyKey& key, const std::string& name, const toml::node& node) {
  const auto read = node.is_number() ? node.value<double>() : std::nullopt;
  if (!read) {
    problems_.add(place_of(node), fmt::format("{}: {} is not a number", name, shown(node)),
                  "write a bare number, without quotes and unit");
    return std::nullopt;
  }
  if (!in_range(key, name, node, *read)) return std::nullopt;
  return *read;
}

std::optional<SettingValue> Reader::count(const StudyKey& key, const std::string& name, const toml::node& node) {
  if (const auto* text = node.as_string(); text && is_one_of(text->get(), key.choices)) return text->get();
  const auto read = node.value_exact<std::int64_t>();
  if (!read || *read > 4'000'000'000) {
    const auto instead = key.choices.empty() ? std::string() : fmt::format(" or \"{}\"", key.choices);
    problems_.add(place_of(node), fmt::format("{}: {} is not a whole number", name, shown(node)),
                  fmt::format("write a whole number{}", instead));
    return std::nullopt;
  }
  if (!in_range(key, name, node, static_cast<double>(*read))) return std::nullopt;
  return static_cast<double>(*read);
}

std::optional<SettingValue> Reader::quantity(const StudyKey& key, const std::string& name, const toml::node& node) {
  const auto* text = node.as_string();
  if (text && is_one_of(text->get(), key.choices)) return text->get();
  try {
    const auto read = parse_quantity(text ? text->get() : shown(node), key.dimension);
    if (!text) throw UnitError(fmt::format("{} is not a quoted quantity", shown(node)));
    if (!in_range(key, name, node, read.value)) return std::nullopt;
    return read;
  } catch (const UnitError& problem) {
    const auto instead = key.choices.empty() ? std::string() : fmt::format("; or \"{}\"", key.choices);
    problems_.add(place_of(node), fmt::format("{}: {}", name, problem.what()),
                  problem.hint.empty() ? "" : problem.hint + instead);
    return std::nullopt;
  }
}

std::optional<SettingValue> Reader::word(const StudyKey& key, const std::string& name, const toml::node& node) {
  const auto* text = node.as_string();
  const auto alternatives = "one of " + listed(key.choices);
  if (!text || text->get().empty()) {
    problems_.add(place_of(node), fmt::format("{}: {} is not a word in quotes", name, shown(node)),
                  key.choices.empty() ? "" : alternatives);
    return std::nullopt;
  }
  if (key.choices.empty() || is_one_of(text->get(), key.choices)) return text->get();
  if (is_one_of(text->get(), key.later)) {
    problems_.add(place_of(node), fmt::format("{}: \"{}\" is not in this version", name, text->get()), alternatives);
    return std::nullopt;
  }
  const auto nearest = nearest_word(text->get(), key.choices);
  problems_.add(place_of(node), fmt::format("{}: \"{}\" is not known", name, text->get()),
                nearest.empty() ? alternatives : fmt::format("did you mean \"{}\"? It is {}", nearest, alternatives));
  return std::nullopt;
}

std::optional<SettingValue> Reader::words(const StudyKey& key, const std::string& name, const toml::node& node) {
  if (const auto* text = node.as_string(); text && text->get() == "auto") return text->get();
  const auto* list = node.as_array();
  if (!list) {
    problems_.add(place_of(node), fmt::format("{}: {} is not a list", name, shown(node)),
                  "write \"auto\" or a list such as [\"drag\", \"buoyancy\"]");
    return std::nullopt;
  }
  std::vector<std::string> read;
  for (std::size_t n = 0; n < list->size(); ++n) {
    const auto one = word(key, indexed(name, n + 1), (*list)[n]);
    if (!one) return std::nullopt;
    read.push_back(std::get<std::string>(*one));
  }
  std::ranges::sort(read);
  return read;
}

std::optional<SettingValue> Reader::ids(const std::string& name, const toml::node& node) {
  const auto* list = node.as_array();
  std::vector<std::uint64_t> read;
  for (std::size_t n = 0; list && n < list->size(); ++n) {
    const auto one = (*list)[n].value_exact<std::int64_t>();
    if (one && *one >= 0) read.push_back(static_cast<std::uint64_t>(*one));
  }
  if (list && read.size() == list->size()) return read;
  problems_.add(place_of(node), fmt::format("{}: {} is not a list of grain ids", name, shown(node)),
                "ids are whole numbers from 0: [0, 12]");
  return std::nullopt;
}

/// Parses TOML; the first syntax error is reported alone, since nothing after it can be trusted.
toml::table parse(const std::string& text, const std::string& name) {
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    const auto at = error.source().begin;
    throw Error(ErrorKind::study_invalid,
                fmt::format("{}:{}:{}: error: {}", name, at.line, at.column, error.description()),
                "values with a unit stand in quotes: diameter = \"0.5 mm\"");
  }
}

double si_number(const Settings& settings, std::string_view path) {
  const auto found = settings.find(path);
  const auto setting = found == settings.end() ? *fallback_of(*find_key(path)) : found->second;
  return std::get<Quantity>(setting.value).si();
}

/// [run]: how, not what.
RunOptions run_options(const Settings& settings, Problems& problems) {
  RunOptions run;
  const auto find = [&](std::string_view path) -> const Setting* {
    const auto found = settings.find(path);
    return found == settings.end() ? nullptr : &found->second;
  };
  if (const auto* ranks = find("run.ranks"); ranks && std::get<double>(ranks->value) != 1)
    problems.add(ranks->place, fmt::format("run.ranks: {} ranks per case are not in this version", ranks->text),
                 "ranks = 1; cases run side by side on all cores");
  if (const auto* cores = find("run.cores"); cores && std::holds_alternative<double>(cores->value))
    run.cores = int(std::get<double>(cores->value));
  if (const auto* keep = find("run.checkpoint.keep")) run.checkpoint_keep = int(std::get<double>(keep->value));
  run.checkpoint_every = si_number(settings, "run.checkpoint.every");
  run.stall_limit = si_number(settings, "run.stall_limit");
  return run;
}

void check_name(const Setting* name, Problems& problems) {
  if (!name || std::get<std::string>(name->value).find_first_of("/\\ \t\n") == std::string::npos) return;
  problems.add(name->place, fmt::format("name: \"{}\" cannot be the name of a directory", name->text),
               "letters, digits, - and _");
}

}   // namespace

Study parse_study(const std::string& text, const std::string& name) {
  const auto root = parse(text, name);
  Problems problems(name);
  Reader reader(problems, false);
  reader.read(root);
  const auto run = run_options(reader.settings, problems);
  const auto title = reader.settings.find("name");
  check_name(title == reader.settings.end() ? nullptr : &title->second, problems);
  problems.throw_if_any();
  const auto order = [](const Axis& a) { return find_key(a.key); };   // of the table of keys, whatever the file's
  std::ranges::sort(reader.axes, std::less<>(), order);
  const auto given = title == reader.settings.end() ? std::filesystem::path(name).stem().string() : title->second.text;
  return {given, name, text, std::move(reader.settings), std::move(reader.axes), std::move(reader.exclusions), run};
}

CaseFile parse_case_file(const std::string& text, const std::string& name) {
  const auto root = parse(text, name);
  Problems problems(name);
  Reader reader(problems, true);
  reader.read(root);
  const auto run = run_options(reader.settings, problems);
  problems.throw_if_any();
  return {std::move(reader.settings), run, reader.bed_only};
}

Study read_study(const std::filesystem::path& file) { return parse_study(read_text(file), file.string()); }

CaseFile read_case_file(const std::filesystem::path& file) { return parse_case_file(read_text(file), file.string()); }

}   // namespace bedload

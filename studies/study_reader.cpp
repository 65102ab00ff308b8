#include "studies/study_reader.hpp"

#include <algorithm>
#include <functional>
#include <limits>

#include <fmt/format.h>

#include "studies/setting_value.hpp"
#include "studies/study_keys.hpp"

namespace bedload {

namespace {

using Kind = StudyKey::Kind;
using Node = StudyNode;

constexpr double most_seeds = 10'000;

class Reader {
 public:
  Reader(StudyFileKind kind, Problems& problems) : problems_(problems), case_file_(kind == StudyFileKind::case_file) {}

  StudyContents read(const Node& root);

 private:
  void check_format(const Node& root);
  void walk(const Node& table, const std::string& prefix, Settings& into, bool axes_allowed);
  void entry(const std::string& path, const Node&, Settings& into, bool axes_allowed);
  void unknown(const std::string& path, Place);
  void value_or_axis(const StudyKey&, const Node&, Settings& into, bool axes_allowed);
  void axis(const StudyKey&, const Node& list);
  void counted_seeds(const StudyKey&, const Node& table, bool axes_allowed);
  void exclusions_of(const Node&);
  void check_exclusion(const Settings&);
  void trades_of(const Node&);

  Problems& problems_;
  bool case_file_;
  StudyContents found_;
};

StudyContents Reader::read(const Node& root) {
  check_format(root);
  walk(root, "", found_.settings, true);
  const auto order = [](const Axis& a) { return find_key(a.key); };   // of the table of keys, whatever the file's
  std::ranges::sort(found_.axes, std::less<>(), order);
  if (const auto* node = root.find("exclude")) exclusions_of(*node);
  if (const auto* node = root.find("trade")) trades_of(*node);
  return std::move(found_);
}

void Reader::check_format(const Node& root) {
  const auto* node = root.find("format");
  if (!node) return problems_.add({1, 1}, "format is missing", "the first line of a study file is: format = 1");
  if (node->is(Node::Kind::whole) && node->whole == 1) return;
  problems_.add(node->place, fmt::format("format: {} is not a format that this bedload reads", node->shown),
                "this version reads format = 1");
}

void Reader::walk(const Node& table, const std::string& prefix, Settings& into, bool axes_allowed) {
  for (const auto& node : table.items) {
    const std::string path = prefix + node.key;
    if (prefix.empty() && (path == "format" || path == "exclude" || path == "trade")) continue;
    if (path == "bed_only" && case_file_ && node.is(Node::Kind::truth)) {
      found_.bed_only = node.truth;
      continue;
    }
    entry(path, node, into, axes_allowed);
  }
}

void Reader::entry(const std::string& path, const Node& node, Settings& into, bool axes_allowed) {
  if (const auto* known = find_key(path)) return value_or_axis(*known, node, into, axes_allowed);
  if (!is_table(path)) return unknown(path, node.key_place);
  if (node.is(Node::Kind::table)) return walk(node, path + ".", into, axes_allowed);
  if (const auto* from = find_key(path + ".from")) return value_or_axis(*from, node, into, axes_allowed);   // one level
  problems_.add(node.place, fmt::format("{}: {} is not a table", path, node.shown),
                fmt::format("write [{}] and its keys below it", path));
}

void Reader::unknown(const std::string& path, Place place) {
  if (const auto what = later_key(path); !what.empty())
    return problems_.add(place, fmt::format("{} is not in this version ({})", path, what), "leave the key out");
  const auto nearest = nearest_key(path);
  problems_.add(place, fmt::format("{} is not a key of a study file", path),
                nearest.empty() ? fmt::format("its place takes {}; docs/study_files.md says more", keys_beside(path))
                                : fmt::format("did you mean {}?", nearest));
}

void Reader::value_or_axis(const StudyKey& key, const Node& node, Settings& into, bool axes_allowed) {
  const std::string path(key.path);
  if (node.is(Node::Kind::table) && path == "bed.seed") return counted_seeds(key, node, axes_allowed);
  const bool by_nature = key.kind == Kind::words || key.kind == Kind::ids;
  const bool is_axis = node.is(Node::Kind::list) && (!by_nature || node.is_list_of(Node::Kind::list));
  if (!is_axis) {
    if (auto one = read_value(key, path, node, problems_)) into.insert_or_assign(path, std::move(*one));
    return;
  }
  if (axes_allowed) return axis(key, node);
  problems_.add(node.place, fmt::format("{}: a list cannot stand here", path), "write one [[exclude]] per value");
}

void Reader::axis(const StudyKey& key, const Node& list) {
  const std::string path(key.path);
  if (case_file_ || !key.physics) {
    return problems_.add(
        list.place,
        fmt::format("{}: a list is an axis, and this key is not physics: it cannot vary within a study", path),
        "give one value");
  }
  if (list.items.empty())
    return problems_.add(list.place, fmt::format("{}: the list is empty", path), "an axis needs a value");
  Axis made{path, {}};
  for (std::size_t n = 0; n < list.items.size(); ++n) {
    const auto name = indexed(path, n + 1);
    auto one = read_value(key, name, list.items[n], problems_);
    if (!one) continue;
    if (std::ranges::any_of(made.values, [&](const Setting& earlier) { return same_value(earlier, *one); }))
      problems_.add(one->place, fmt::format("{}: {} stands twice in this list", name, one->text), "remove one");
    made.values.push_back(std::move(*one));
  }
  found_.axes.push_back(std::move(made));
}

/// seed = { count = 3 } is the axis 1, 2, 3: adding packings later keeps those that were run.
void Reader::counted_seeds(const StudyKey& key, const Node& table, bool axes_allowed) {
  const auto* node = table.find("count");
  const std::string path(key.path);
  if (!node || table.items.size() != 1 || !axes_allowed || case_file_) {
    return problems_.add(table.place, fmt::format("{}: {} is not a seed", path, table.shown),
                         "write seed = { count = 3 } or seed = 1");
  }
  const auto counted = read_value(key, path + ".count", *node, problems_);
  if (!counted) return;
  const double count = std::get<double>(counted->value);
  if (count > most_seeds)
    return problems_.add(node->place, fmt::format("{}.count: {} packings are too many", path, node->shown),
                         "at most 10000");
  Axis made{path, {}};
  for (int n = 1; n <= count; ++n) made.values.push_back({double(n), fmt::format("{}", n), node->place});
  found_.axes.push_back(std::move(made));
}

void Reader::exclusions_of(const Node& list) {
  if (!list.is_list_of(Node::Kind::table) || case_file_) {
    return problems_.add(list.place, "exclude: this is not a list of tables",
                         "write [[exclude]] and below it, for example, grains.diameter = \"0.5 mm\"");
  }
  for (const auto& table : list.items) {
    Settings one;
    walk(table, "", one, false);
    check_exclusion(one);
    found_.exclusions.push_back(std::move(one));
  }
}

void Reader::check_exclusion(const Settings& exclusion) {
  for (const auto& entry : exclusion) {
    if (std::ranges::find(found_.axes, entry.first, &Axis::key) != found_.axes.end()) continue;
    problems_.add(entry.second.place, fmt::format("exclude: {} does not vary in this study", entry.first),
                  "name keys that are axes");
  }
}

/// [[trade]]: what is changed, and a name for it if the keys are not to say.
void Reader::trades_of(const Node& list) {
  if (!list.is_list_of(Node::Kind::table) || case_file_)
    return problems_.add(list.place, "trade: this is not a list of tables",
                         "write [[trade]] and below it, for example, box.cell.z = \"1 d\"");
  for (const auto& axis : found_.axes)
    if (axis.key != "bed.seed")
      problems_.add(axis.values.front().place, fmt::format("{}: a trade is made around one scene", axis.key),
                    "one value; bed.seed alone may be an axis");
  for (const auto& table : list.items) {
    Variation one;
    walk(table, "", one.changes, false);
    if (const auto name = one.changes.extract("name")) one.name = name.mapped().text;
    for (const auto& [key, setting] : one.changes)
      if (!find_key(key)->physics || key == "bed.seed")
        problems_.add(setting.place, fmt::format("trade: {} is nothing that results hang on", key),
                      "keys of the scene, its models and its steps");
    if (one.changes.empty())
      problems_.add(table.place, "trade: nothing is changed", "for example box.cell.z = \"1 d\"");
    found_.trades.push_back(std::move(one));
  }
}

/// A count that may be larger than any int: then the largest int says as much.
int whole(const Setting& setting) {
  return static_cast<int>(std::min(std::get<double>(setting.value), double(std::numeric_limits<int>::max())));
}

double si_number(const Settings& settings, std::string_view path) {
  const auto found = settings.find(path);
  const auto setting = found == settings.end() ? *fallback_of(*find_key(path)) : found->second;
  return std::get<Quantity>(setting.value).si();
}

}   // namespace

StudyContents read_contents(const StudyNode& root, StudyFileKind kind, Problems& problems) {
  return Reader(kind, problems).read(root);
}

SeedRule seed_rule(const StudyContents& contents, Problems& problems) {
  SeedRule rule;
  const auto& settings = contents.settings;
  if (const auto batch = settings.find("onset.batch"); batch != settings.end()) rule.batch = whole(batch->second);
  const auto found = settings.find("onset.interval");
  if (found == settings.end()) return rule;
  const Setting& interval = found->second;
  rule.interval = std::get<Quantity>(interval.value).value;
  if (*rule.interval >= 1)
    problems.add(interval.place, fmt::format("onset.interval: {} is no interval of a threshold", interval.text),
                 "half its width relative to the threshold, for example \"15 %\"");
  if (std::ranges::find(contents.axes, "bed.seed", &Axis::key) == contents.axes.end())
    problems.add(interval.place, "onset.interval: there is one packing, which has no interval",
                 "bed.seed = { count = 16 }, the most that may be run");
  return rule;
}

std::vector<std::string> budget_wanted(const Settings& settings) {
  const auto found = settings.find("onset.budget");
  if (found == settings.end()) return {};
  if (const auto* words = std::get_if<std::vector<std::string>>(&found->second.value)) return *words;
  return {"bracket", "hold", "mesh", "area"};
}

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
    run.cores = whole(*cores);
  if (const auto* keep = find("run.checkpoint.keep")) run.checkpoint_keep = whole(*keep);
  for (const auto& [path, number] :
       {std::pair{"run.checkpoint.every", &run.checkpoint_every}, {"run.stall_limit", &run.stall_limit}}) {
    const auto* given = find(path);
    if (given && std::get<Quantity>(given->value).relative())
      problems.add(given->place, fmt::format("{}: \"{}\" is no wall time", path, given->text), "for example \"5 min\"");
    else *number = si_number(settings, path);
  }
  return run;
}

}   // namespace bedload

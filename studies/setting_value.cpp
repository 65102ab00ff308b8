#include "studies/setting_value.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace bedload {

namespace {

using Kind = StudyKey::Kind;
using Range = StudyKey::Range;
using Value = std::optional<SettingValue>;

constexpr std::int64_t largest_count = 4'000'000'000;   // grain ids have 32 bits

/// "lid|pressure|none" as "lid, pressure, none".
std::string listed(std::string_view choices) {
  std::string text;
  for (const char c : choices) text += c == '|' ? std::string(", ") : std::string(1, c);
  return text;
}

/// Reads one value as one kind; nothing, and a problem, if it is none.
struct ValueReader {
  const StudyKey& key;
  const std::string& name;
  const StudyNode& node;
  Problems& problems;

  bool is_text() const { return node.is(StudyNode::Kind::text); }
  bool stands_for_number() const { return is_text() && is_one_of(node.text, key.choices); }   // "auto"

  Value refuse(const std::string& what, const std::string& hint) const {
    problems.add(node.place, fmt::format("{}: {}", name, what), hint);
    return std::nullopt;
  }
  Value refuse_kind(std::string_view wanted, const std::string& hint) const {
    return refuse(fmt::format("{} is not {}", node.shown, wanted), hint);
  }

  Value in_range(double of, SettingValue value) const;
  Value number() const;
  Value count() const;
  Value quantity() const;
  Value word() const;
  Value words() const;
  Value ids() const;
  Value flag() const;
};

Value ValueReader::in_range(double of, SettingValue value) const {
  const bool allowed = key.range == Range::any || of > 0 || (key.range == Range::not_negative && of == 0);
  if (std::isfinite(of) && allowed) return value;
  const auto wanted = !std::isfinite(of)             ? "finite"
                      : key.range == Range::positive ? "greater than zero"
                                                     : "zero or greater";
  return refuse(fmt::format("{} must be {}", node.shown, wanted), fmt::format("give a value that is {}", wanted));
}

Value ValueReader::number() const {
  if (!node.is(StudyNode::Kind::real) && !node.is(StudyNode::Kind::whole))
    return refuse_kind("a number", "write a bare number, without quotes and unit");
  return in_range(node.real, node.real);
}

Value ValueReader::count() const {
  if (stands_for_number()) return node.text;
  if (node.is(StudyNode::Kind::whole) && node.whole > largest_count)
    return refuse(fmt::format("{} is too large", node.shown), fmt::format("at most {}", largest_count));
  if (node.is(StudyNode::Kind::whole)) return in_range(node.real, node.real);
  const auto instead = key.choices.empty() ? std::string() : fmt::format(" or \"{}\"", key.choices);
  return refuse_kind("a whole number", fmt::format("write a whole number{}", instead));
}

Value ValueReader::quantity() const {
  if (stands_for_number()) return node.text;
  try {
    const auto read = parse_quantity(is_text() ? node.text : node.shown, key.dimension);
    return in_range(read.value, read);
  } catch (const UnitError& problem) {
    const auto instead = key.choices.empty() ? std::string() : fmt::format("; or \"{}\"", key.choices);
    return refuse(problem.what(), problem.hint.empty() ? "" : problem.hint + instead);
  }
}

Value ValueReader::word() const {
  const auto alternatives = key.choices.empty() ? std::string() : "one of " + listed(key.choices);
  if (!is_text() || node.text.empty()) return refuse_kind("a word in quotes", alternatives);
  if (key.choices.empty() || is_one_of(node.text, key.choices)) return node.text;
  if (is_one_of(node.text, key.later))
    return refuse(fmt::format("\"{}\" is not in this version", node.text), alternatives);
  const auto nearest = nearest_word(node.text, key.choices);
  return refuse(fmt::format("\"{}\" is not known", node.text),
                nearest.empty() ? alternatives : fmt::format("did you mean \"{}\"? It is {}", nearest, alternatives));
}

/// Sorted: the order in which terms are named has no meaning.
Value ValueReader::words() const {
  if (is_text() && node.text == "auto") return node.text;
  if (!node.is(StudyNode::Kind::list))
    return refuse_kind("a list", "write \"auto\" or a list such as [\"drag\", \"buoyancy\"]");
  std::vector<std::string> read;
  for (std::size_t n = 0; n < node.items.size(); ++n) {
    const auto its_name = indexed(name, n + 1);
    if (node.items[n].text == "auto") {
      problems.add(node.items[n].place, fmt::format("{}: \"auto\" stands for a whole list, not in one", its_name),
                   "`bedload plan` prints the list that \"auto\" stands for: copy it and add to it");
      return std::nullopt;
    }
    const auto one = ValueReader{key, its_name, node.items[n], problems}.word();
    if (!one) return std::nullopt;
    const auto& word = std::get<std::string>(*one);
    if (std::ranges::find(read, word) != read.end()) {
      problems.add(node.items[n].place, fmt::format("{}: \"{}\" stands twice in this list", its_name, word),
                   "remove one");
      return std::nullopt;
    }
    read.push_back(word);
  }
  std::ranges::sort(read);
  return read;
}

Value ValueReader::ids() const {
  const auto is_id = [](const StudyNode& n) { return n.is(StudyNode::Kind::whole) && n.whole >= 0; };
  if (!node.is(StudyNode::Kind::list) || !std::ranges::all_of(node.items, is_id))
    return refuse_kind("a list of grain ids", "ids are whole numbers from 0: [0, 12]");
  std::vector<std::uint64_t> read;
  for (const auto& item : node.items) read.push_back(static_cast<std::uint64_t>(item.whole));
  return read;
}

Value ValueReader::flag() const {
  if (!node.is(StudyNode::Kind::truth)) return refuse_kind("true or false", "write true or false, without quotes");
  return std::string(node.truth ? "true" : "false");
}

Value read_kind(const ValueReader& reader) {
  switch (reader.key.kind) {
    case Kind::number: return reader.number();
    case Kind::count: return reader.count();
    case Kind::quantity: return reader.quantity();
    case Kind::text:
    case Kind::word: return reader.word();
    case Kind::words: return reader.words();
    case Kind::ids: return reader.ids();
    case Kind::flag: return reader.flag();
  }
  return std::nullopt;
}

}   // namespace

std::optional<Setting> read_value(const StudyKey& key, const std::string& name, const StudyNode& node,
                                  Problems& problems) {
  const ValueReader reader{key, name, node, problems};
  auto value = read_kind(reader);
  if (!value) return std::nullopt;
  return Setting{std::move(*value), reader.is_text() ? node.text : node.shown, node.place};
}

std::string indexed(std::string_view path, std::size_t number) { return fmt::format("{}[{}]", path, number); }

}   // namespace bedload

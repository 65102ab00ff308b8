// TOML in, study out. The only file that includes toml++.
#include "studies/study_file.hpp"

#include <algorithm>
#include <cstring>
#include <regex>
#include <sstream>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "base/durable_file.hpp"
#include "base/error.hpp"
#include "studies/study_node.hpp"
#include "studies/study_reader.hpp"

namespace bedload {

namespace {

Place place_of(const toml::source_region& region) {
  return {static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

/// The value as it would be written in the file, on one line.
std::string shown(const toml::node& node) {
  if (const auto* number = node.as_floating_point()) return shortest(number->get());
  std::ostringstream out;
  node.visit([&](const auto& n) { out << n; });
  auto text = out.str();
  std::ranges::replace(text, '\n', ' ');
  return text;
}

StudyNode tree_of(const toml::node& node) {
  using Kind = StudyNode::Kind;
  StudyNode made;
  made.place = place_of(node.source());
  made.shown = shown(node);
  if (const auto* truth = node.as_boolean()) made.kind = Kind::truth, made.truth = truth->get();
  if (const auto* whole = node.as_integer())
    made.kind = Kind::whole, made.whole = whole->get(), made.real = double(whole->get());
  if (const auto* real = node.as_floating_point()) made.kind = Kind::real, made.real = real->get();
  if (const auto* text = node.as_string()) made.kind = Kind::text, made.text = text->get();
  if (const auto* list = node.as_array()) {
    made.kind = Kind::list;
    for (const auto& item : *list) made.items.push_back(tree_of(item));
  }
  if (const auto* table = node.as_table()) {
    made.kind = Kind::table;
    for (const auto& [key, value] : *table) {
      made.items.push_back(tree_of(value));
      made.items.back().key = key.str();
      made.items.back().key_place = place_of(key.source());
    }
  }
  return made;
}

/// What a line that is no TOML most likely lacks; empty if that is not plain.
std::string missing_quotes(const std::string& text, int line) {
  std::istringstream lines(text);
  std::string found;
  for (int n = 0; n < line; ++n) std::getline(lines, found);
  found.resize(std::min<std::size_t>(found.size(), 200));   // std::regex recurses: a long line would overflow the stack
  static const std::regex with_unit(R"(=\s*\[?\s*[-+]?[0-9][0-9.eE+-]*\s*[A-Za-z%](?![\w\s]*=))"),
      word(R"(=\s*[A-Za-z_]+\s*(#|$))");
  if (std::regex_search(found, with_unit)) return "values with a unit stand in quotes: diameter = \"0.5 mm\"";
  if (std::regex_search(found, word)) return "words stand in quotes: kind = \"lid\"";
  return {};
}

/// The first syntax error is reported alone, since nothing after it can be trusted.
StudyNode parse(const std::string& text, const std::string& name) {
  try {
    return tree_of(toml::parse(text, name));
  } catch (const toml::parse_error& error) {
    const auto at = place_of(error.source());
    throw Error(ErrorKind::study_invalid,
                fmt::format("{}:{}:{}: error: {}", name, at.line, at.column, error.description()),
                missing_quotes(text, at.line));
  }
}

void check_name(const Setting& name, Problems& problems) {
  if (is_study_name(name.text)) return;
  problems.add(name.place, fmt::format("name: \"{}\" cannot be the name of a result directory", name.text),
               "letters, digits, - and _");
}

}   // namespace

bool is_study_name(std::string_view name) {
  const auto unfit = [](unsigned char c) { return c <= ' ' || c == 0x7f || std::strchr("/\\\"'", c); };
  return !name.empty() && name[0] != '.' && name[0] != '-' && std::ranges::none_of(name, unfit);
}

const StudyNode* StudyNode::find(std::string_view name) const {
  const auto found = std::ranges::find(items, name, &StudyNode::key);
  return kind != Kind::table || found == items.end() ? nullptr : &*found;
}

bool StudyNode::is_list_of(Kind k) const {
  return kind == Kind::list && !items.empty() &&
         std::ranges::all_of(items, [&](const StudyNode& n) { return n.kind == k; });
}

Study parse_study(const std::string& text, const std::string& name) {
  const auto root = parse(text, name);
  Problems problems(name);
  auto contents = read_contents(root, StudyFileKind::study, problems);
  const auto run = run_options(contents.settings, problems);
  const auto seeds = seed_rule(contents, problems);
  auto budget = budget_wanted(contents.settings);
  const auto title = contents.settings.find("name");
  const bool named = title != contents.settings.end();
  if (named) check_name(title->second, problems);
  problems.throw_if_any();
  const auto given = named ? title->second.text : std::filesystem::path(name).stem().string();
  return {given,
          name,
          text,
          std::move(contents.settings),
          std::move(contents.axes),
          std::move(contents.exclusions),
          run,
          seeds,
          std::move(budget),
          std::move(contents.trades)};
}

CaseFile parse_case_file(const std::string& text, const std::string& name) {
  const auto root = parse(text, name);
  Problems problems(name);
  auto contents = read_contents(root, StudyFileKind::case_file, problems);
  const auto run = run_options(contents.settings, problems);
  problems.throw_if_any();
  return {std::move(contents.settings), run, contents.bed_only};
}

Study read_study(const std::filesystem::path& file) { return parse_study(read_text(file), file.string()); }

CaseFile read_case_file(const std::filesystem::path& file) { return parse_case_file(read_text(file), file.string()); }

}   // namespace bedload

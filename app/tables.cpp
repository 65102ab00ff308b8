#include "app/tables.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/units.hpp"

namespace bedload {

namespace {

std::string exact(const Value& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *whole);
  if (const auto* real = std::get_if<double>(&value)) return shortest(*real);
  const auto* text = std::get_if<std::string>(&value);
  return text ? *text : std::string();
}

std::string for_people(const Value& value) {
  const auto* real = std::get_if<double>(&value);
  return real ? fmt::format("{:.4g}", *real) : exact(value);
}

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == text.npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

std::string as_csv(const Rows& rows) {
  std::vector<std::string> names;
  for (const auto& column : rows.columns) names.push_back(quoted(column));
  std::string text = fmt::format("{}\n", fmt::join(names, ","));
  for (const auto& row : rows.rows) {
    std::vector<std::string> fields;
    for (const auto& value : row) fields.push_back(quoted(exact(value)));
    text += fmt::format("{}\n", fmt::join(fields, ","));
  }
  return text;
}

std::string as_json(const Rows& rows) {
  auto array = nlohmann::ordered_json::array();
  for (const auto& row : rows.rows) {
    nlohmann::ordered_json object;
    for (std::size_t c = 0; c < row.size(); ++c) {
      auto& member = object[rows.columns[c]];
      if (const auto* whole = std::get_if<std::int64_t>(&row[c])) member = *whole;
      if (const auto* real = std::get_if<double>(&row[c])) member = *real;
      if (const auto* words = std::get_if<std::string>(&row[c])) member = *words;
    }
    array.push_back(std::move(object));
  }
  return array.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

constexpr std::size_t any_width = std::string::npos;

/// Heading and rows as text, each column but the last padded to one width; in the first what is wider than `widest` is
/// followed by a new line, padded.
std::vector<std::vector<std::string>> aligned(const Rows& rows, std::size_t widest = any_width) {
  std::vector<std::vector<std::string>> lines{rows.columns};
  for (const auto& row : rows.rows) {
    auto& line = lines.emplace_back();
    for (const auto& value : row) line.push_back(for_people(value));
  }
  for (std::size_t c = 0; c + 1 < rows.columns.size(); ++c) {
    std::size_t width = 0;
    const std::size_t most = c == 0 ? widest : any_width;
    for (const auto& line : lines)
      if (line[c].size() <= most) width = std::max(width, line[c].size());
    for (auto& line : lines)
      if (line[c].size() <= most) line[c].resize(width, ' ');
      else line[c] += "\n" + std::string(width, ' ');
  }
  return lines;
}

std::string as_table(const Rows& rows, std::size_t widest = any_width) {
  std::string text;
  for (const auto& line : aligned(rows, widest)) {
    const auto one = fmt::format("{}", fmt::join(line, "  "));
    text += one.substr(0, one.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

}   // namespace

std::string wrapped(const std::string& text, std::size_t indent) {
  const std::size_t room = page_width - std::min(indent, page_width / 2);
  std::string out;
  std::size_t from = 0;
  while (text.size() - from > room) {
    auto space = text.rfind(' ', from + room);
    if (space == text.npos || space <= from) space = text.find(' ', from);   // a word longer than a line
    if (space == text.npos) break;
    out += text.substr(from, space - from) + "\n" + std::string(indent, ' ');
    from = space + 1;
  }
  return out + text.substr(from);
}

std::string printed_with_text(const Rows& rows) {
  std::string text;
  for (const auto& line : aligned(rows)) {
    const auto fixed = fmt::format("{}  ", fmt::join(line.begin(), line.end() - 1, "  "));
    text += fixed + wrapped(line.back(), fixed.size()) + "\n";
  }
  return text;
}

std::string printed_below_long_names(const Rows& rows, std::size_t widest) { return as_table(rows, widest); }

std::string printed(const Rows& rows, Form form) {
  return form == Form::csv ? as_csv(rows) : form == Form::json ? as_json(rows) : as_table(rows);
}

}   // namespace bedload

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

std::string as_table(const Rows& rows) {
  std::vector<std::vector<std::string>> lines{rows.columns};
  for (const auto& row : rows.rows) {
    auto& line = lines.emplace_back();
    for (const auto& value : row) line.push_back(for_people(value));
  }
  std::vector<std::size_t> widths(rows.columns.size());
  for (const auto& line : lines)
    for (std::size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], line[c].size());
  std::string text;
  for (const auto& line : lines) {
    std::string one;
    for (std::size_t c = 0; c < line.size(); ++c) one += fmt::format("{:<{}}  ", line[c], widths[c]);
    text += one.substr(0, one.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

}   // namespace

std::string printed(const Rows& rows, Form form) {
  return form == Form::csv ? as_csv(rows) : form == Form::json ? as_json(rows) : as_table(rows);
}

}   // namespace bedload

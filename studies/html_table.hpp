// Tables of the report.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "studies/svg_plot.hpp"

namespace bedload {

inline std::string text_cell(std::string_view text) { return fmt::format("<td>{}</td>", escaped(text)); }
inline std::string number_cell(std::string_view text) { return fmt::format("<td class='n'>{}</td>", escaped(text)); }
inline std::string number_cell(double number, std::string_view format = "{:.4g}") {
  return number_cell(std::isfinite(number) ? fmt::format(fmt::runtime(format), number) : std::string("–"));
}

/// Names of the columns; those from `first_number` to `last_number` hold figures and stand to the right.
inline std::string header_row(const std::vector<std::string>& names, std::size_t first_number,
                              std::size_t last_number) {
  std::string row = "<tr>";
  for (std::size_t n = 0; n < names.size(); ++n)
    row += fmt::format("<th{}>{}</th>", n >= first_number && n <= last_number ? " class='n'" : "", escaped(names[n]));
  return row + "</tr>\n";
}

/// What is wider than the page scrolls within it.
inline std::string scrolling(std::string_view wide) { return fmt::format("<div class='scroll'>{}</div>\n", wide); }

inline std::string html_table(std::string_view rows) { return scrolling(fmt::format("<table>{}</table>", rows)); }

}   // namespace bedload

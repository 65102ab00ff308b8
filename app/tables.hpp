// Rows as people and as programs read them.
#pragma once

#include "app/commands.hpp"
#include "scheduler/database.hpp"

namespace bedload {

/// Aligned columns; CSV (RFC 4180); or a JSON array of objects. Numbers in CSV and JSON read back to the same bits.
std::string printed(const Rows&, Form);

inline constexpr std::size_t page_width = 100;   // of what people read

/// Lines of at most page_width letters, broken between words. The first has `indent` letters before it already, the others
/// begin with as many spaces.
std::string wrapped(const std::string& text, std::size_t indent);

/// A table for people whose last column is text: that is wrapped.
std::string printed_with_text(const Rows&);

/// A table for people whose first column is a name: one longer than `widest` stands on a line of its own, above its row.
std::string printed_below_long_names(const Rows&, std::size_t widest);

}   // namespace bedload

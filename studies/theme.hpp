// The colours of pages and figures, each in a light and a dark variant.
#pragma once

#include <string>

namespace bedload {

// In HTML, CSS and SVG a colour is named var(--ink), var(--blue) and so on; theme.cpp has all of them.

/// CSS that defines every name: dark where the reader's system prefers that, light otherwise and on paper.
std::string theme_style();

/// The same text with every name replaced by its light colour: what readers of SVG that know no CSS variables understand.
std::string in_light_colours(std::string text);

}   // namespace bedload

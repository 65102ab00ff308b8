// One table, and what is made of it.
#include "studies/theme.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>

namespace bedload {

namespace {

struct Colour {
  std::string_view name, light, dark;
};

// Figures take theirs from the palette of Okabe and Ito, which colour-blind readers tell apart; lighter on dark paper.
constexpr std::array<Colour, 30> colours{
    {{"page", "#f4f6f7", "#11161a"},     {"paper", "#ffffff", "#1a2127"},       {"ink", "#22292e", "#e4eaed"},
     {"text", "#333333", "#c9d2d8"},     {"soft", "#5b6770", "#9dabb5"},        {"border", "#e0e5e8", "#303b43"},
     {"rule", "#c6ced3", "#4b5861"},     {"row", "#edf0f2", "#283239"},         {"tag", "#e8edf0", "#2c373f"},
     {"tag-text", "#44515a", "#b9c5cd"}, {"good", "#dff1e8", "#153a2b"},        {"good-text", "#11633f", "#84d9b0"},
     {"open", "#fdf0d5", "#453610"},     {"open-text", "#7a5200", "#f0ca78"},   {"grid", "#dfe4e7", "#333e46"},
     {"fine", "#eff2f3", "#252e35"},     {"frame", "#7d8890", "#75838c"},       {"blue", "#0072b2", "#56b4e9"},
     {"red", "#d55e00", "#f28b46"},      {"green", "#009e73", "#35c99b"},       {"purple", "#aa4499", "#dc8fd0"},
     {"ochre", "#b8860b", "#e3bb4d"},    {"known", "#5b6770", "#a9b6bf"},       {"known-pale", "#a3adb5", "#6d7b85"},
     {"still", "#9aa5ad", "#7b8993"},    {"band", "#c9a227", "#d9b63f"},        {"water", "#eef5f9", "#1e2c36"},
     {"flow", "#4a6b80", "#93b8cf"},     {"outline", "#00000047", "#00000080"}, {"dash", "#555555", "#aab5bc"}}};

}   // namespace

std::string theme_style() {
  std::string light, dark;
  for (const Colour& c : colours) {
    light += fmt::format(" --{}: {};", c.name, c.light);
    dark += fmt::format(" --{}: {};", c.name, c.dark);
  }
  return fmt::format(
      "\n:root {{ color-scheme: light;{} }}\n"
      "@media screen and (prefers-color-scheme: dark) {{ :root {{ color-scheme: dark;{} }} }}",
      light, dark);
}

std::string in_light_colours(std::string text) {
  for (const Colour& c : colours) {
    const auto name = fmt::format("var(--{})", c.name);
    for (auto at = text.find(name); at != text.npos; at = text.find(name, at)) text.replace(at, name.size(), c.light);
  }
  return text;
}

}   // namespace bedload

#include "studies/setting_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace bedload {

std::string as_toml(const Setting& setting) {
  if (const auto* words = std::get_if<std::vector<std::string>>(&setting.value))
    return words->empty() ? "[]" : fmt::format("[\"{}\"]", fmt::join(*words, "\", \""));
  if (const auto* ids = std::get_if<std::vector<std::uint64_t>>(&setting.value))
    return fmt::format("[{}]", fmt::join(*ids, ", "));
  const bool bare = std::holds_alternative<double>(setting.value) || setting.text == "true" || setting.text == "false";
  return bare ? setting.text : fmt::format("\"{}\"", setting.text);
}

}   // namespace bedload

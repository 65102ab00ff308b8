#include "studies/case_warnings.hpp"

#include <algorithm>
#include <regex>

#include <fmt/format.h>

namespace bedload {

namespace {

/// The text without its numbers.
std::string kind_of(const std::string& text) {
  static const std::regex number(R"([-+]?\b[0-9]+(\.[0-9]+)?(e[-+]?[0-9]+)?)");
  return std::regex_replace(text, number, "#");
}

}   // namespace

std::vector<SharedWarning> shared_warnings(const std::vector<CaseWarning>& warnings) {
  std::vector<SharedWarning> shared;
  std::vector<std::string> kinds;
  for (const auto& [label, text] : warnings) {
    const auto kind = kind_of(text);
    const auto known = std::ranges::find(kinds, kind) - kinds.begin();
    if (known == std::ssize(kinds)) {
      kinds.push_back(kind);
      shared.push_back({.text = text, .labels = {}});
    }
    auto& one = shared[static_cast<std::size_t>(known)];
    one.labels.push_back(label);
    if (one.text != text) one.same_numbers = false;
  }
  return shared;
}

std::string cases_in_words(const SharedWarning& warning) {
  if (warning.labels.size() == 1) return warning.labels.front();
  return fmt::format("{} and {} more{}", warning.labels.front(), warning.labels.size() - 1,
                     warning.same_numbers ? "" : " with their own numbers");
}

}   // namespace bedload

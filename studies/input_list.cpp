#include "studies/input_list.hpp"

#include <cstdlib>

#include <fmt/format.h>

#include "studies/study_keys.hpp"

namespace bedload {

double significant(double value, int digits) {
  return std::strtod(fmt::format("{:.{}e}", value, digits - 1).c_str(), nullptr);
}

void InputList::problem(std::string_view key, const std::string& message, const std::string& hint) {
  const auto found = settings_.find(key);
  problems_.add(found == settings_.end() ? Place{} : found->second.place, fmt::format("{}: {}", key, message), hint);
}

void InputList::refuse(std::string_view key, const std::string& why) {
  if (given(key)) problem(key, why, "leave it out");
}

void InputList::missing(std::string_view key, const std::string& hint) {
  problems_.add({}, fmt::format("{} is missing", key), hint);
}

std::optional<Setting> InputList::setting(std::string_view key) const {
  const auto found = settings_.find(key);
  return found != settings_.end() ? found->second : fallback_of(*find_key(key));
}

bool InputList::is_auto(std::string_view key) const {
  const auto one = setting(key);
  const auto* text = one ? std::get_if<std::string>(&one->value) : nullptr;
  return text && *text == "auto";
}

void InputList::quantity(std::string_view key, const Quantity& value) {
  if (value.diameters != 0 && diameter_missing) return;
  if (value.grain_times != 0 && no_grain_time) {
    if (!no_grain_time->key.empty())
      problem(no_grain_time->key, no_grain_time->why, "heavier grains, or drive.dwell and record.every in s");
    return;
  }
  try {
    const int digits = value.grain_times != 0 ? time_digits : exact_digits;
    const double si = value.si(scales);
    inputs.values.insert_or_assign(std::string(key), value.relative() ? significant(si, digits) : si);
  } catch (const UnitError& error) {
    problem(key, error.what(), error.hint);
  }
}

void InputList::take(std::string_view key) {
  const auto one = setting(key);
  if (!one) return missing(key);
  if (const auto* q = std::get_if<Quantity>(&one->value)) return quantity(key, *q);
  std::visit(
      [&](const auto& value) {
        if constexpr (!std::is_same_v<std::decay_t<decltype(value)>, Quantity>)
          inputs.values.insert_or_assign(std::string(key), Input(value));
      },
      one->value);
}

void InputList::take_all(std::initializer_list<std::string_view> keys) {
  for (const auto key : keys) take(key);
}

}   // namespace bedload

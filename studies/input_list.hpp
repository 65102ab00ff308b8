// Settings taken over, one by one, as inputs in SI.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

#include "studies/case_inputs.hpp"

namespace bedload {

/// Rounded to so many significant digits. What comes out of powers and roots is rounded before it becomes an input, so
/// that the last bit of a mathematical library renames no case.
double significant(double value, int digits);
inline constexpr int exact_digits = 12;   // of products such as 20 d: hides 0.0077999999999999996
inline constexpr int time_digits = 6;     // of grain times
inline constexpr int auto_digits = 4;     // of a step that bedload chose

/// What is common to resolving every key: the setting or its default, its unit, the place of its problem.
class InputList {
 public:
  InputList(const Settings& settings, Problems& problems) : settings_(settings), problems_(problems) {}

  bool given(std::string_view key) const { return settings_.find(key) != settings_.end(); }
  /// The setting as it is written, or its default.
  std::optional<Setting> setting(std::string_view key) const;
  bool is_auto(std::string_view key) const;

  /// Takes a setting over, or its default; a key without either is a problem.
  void take(std::string_view key);
  void take_all(std::initializer_list<std::string_view> keys);

  void problem(std::string_view key, const std::string& message, const std::string& hint = {});
  void missing(std::string_view key, const std::string& hint = "docs/study_files.md shows every key with an example");
  /// A key that makes no sense beside the others.
  void refuse(std::string_view key, const std::string& why);
  bool no_problems() const { return problems_.empty(); }

  double number(std::string_view key) const { return inputs.number(key); }
  const std::string& word(std::string_view key) const { return inputs.word(key); }

  /// Why no grain time is known: the key to blame; no key if its problem has been told.
  struct NoGrainTime {
    std::string_view key;
    std::string why;
  };

  CaseInputs inputs;
  GrainScales scales;              // what "d" and "td" are, once that is known
  bool diameter_missing = false;   // told already: what counts in "d" is left out in silence
  std::optional<NoGrainTime> no_grain_time;

 private:
  void quantity(std::string_view key, const Quantity&);

  const Settings& settings_;
  Problems& problems_;
};

}   // namespace bedload

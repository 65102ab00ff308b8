// A setting: one value of a study file, read and checked against its key, not yet resolved.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "base/units.hpp"

namespace bedload {

/// Where a value stands in a study file, counted from 1; line 0 = nowhere (a default).
struct Place {
  int line = 0, column = 0;
};

/// number, quantity with its unit, word, list of words (terms), list of grain ids (tracks).
using SettingValue = std::variant<double, Quantity, std::string, std::vector<std::string>, std::vector<std::uint64_t>>;

struct Setting {
  SettingValue value;
  std::string text;   // as written, for labels and messages
  Place place;
};

/// By dotted key: "grains.diameter", "drive.shields.from".
using Settings = std::map<std::string, Setting, std::less<>>;

/// True when two settings mean the same ("0.2 mm" and "200 um").
bool same_value(const Setting&, const Setting&);

/// One thing wrong with a study file.
struct Problem {
  Place place;
  std::string message;   // begins with the key: `grains.diameter[2]: "0,8 mm" is not a length`
  std::string hint;      // the likely fix; may be empty
};

/// The problems found so far; a study is judged as a whole.
class Problems {
 public:
  explicit Problems(std::string file) : file_(std::move(file)) {}
  /// The same message twice is one problem.
  void add(Place, std::string message, std::string hint = {});
  bool empty() const { return problems_.empty(); }
  /// Throws Error study_invalid with a line "file:line:column: error: message" per problem, in order of place, each
  /// followed by its hint.
  void throw_if_any() const;

 private:
  std::string file_;
  std::vector<Problem> problems_;
};

}   // namespace bedload

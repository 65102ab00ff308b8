// A study file as a tree: values with their places, whatever library parsed them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "studies/setting.hpp"

namespace bedload {

struct StudyNode {
  enum class Kind { truth, whole, real, text, list, table, other };

  Kind kind = Kind::other;
  Place place;         // of the value
  std::string shown;   // as it would be written, for messages

  bool truth = false;
  std::int64_t whole = 0;
  double real = 0;   // also of a whole number
  std::string text;
  std::vector<StudyNode> items;   // of a list; of a table, each with its key
  std::string key;
  Place key_place;

  bool is(Kind k) const { return kind == k; }
  /// The member of a table; nullptr if it has none of that key.
  const StudyNode* find(std::string_view name) const;
  /// True for a list, not empty, all of whose items are of that kind.
  bool is_list_of(Kind) const;
};

}   // namespace bedload

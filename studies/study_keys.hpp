// The keys of a study file: what each may hold, whether it is physics, and what stands for it when it is left out.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/units.hpp"
#include "studies/setting.hpp"

namespace bedload {

struct StudyKey {
  enum class Kind { text, word, number, count, quantity, words, ids, flag };
  enum class Range { any, positive, not_negative };

  std::string_view path;   // dotted
  Kind kind = Kind::number;
  Dimension dimension = dimension::number;   // of a quantity
  Range range = Range::any;
  std::string_view choices = {};    // of a word: "lid|pressure|none"; or a word that may stand for a number: "auto"
  std::string_view later = {};      // words that a later version will know
  std::string_view fallback = {};   // stands for a key that is left out; empty: none
  bool physics = true;              // part of a case's identity, hence may vary within a study
  std::string_view label = {};      // its letter in labels of cases
};

/// All keys, in the order in which they are written.
std::span<const StudyKey> study_keys();
/// Nothing if there is no such key.
const StudyKey* find_key(std::string_view path);
/// The setting that stands for a key that is left out.
std::optional<Setting> fallback_of(const StudyKey&);
/// True for a table of the study file: "grains", "box.cell".
bool is_table(std::string_view path);

/// Why a key that is not of this version is refused; empty for a key that nobody knows.
std::string_view later_key(std::string_view path);

/// The known key nearest to a misspelt one, by edit distance whatever the case; empty if none is near.
std::string_view nearest_key(std::string_view path);
/// The keys and tables that may stand where `path` does: "from, ratio, step, steps" for drive.shields.to.
std::string keys_beside(std::string_view path);
/// The nearest of words parted by '|'; empty if none is near.
std::string_view nearest_word(std::string_view word, std::string_view choices);
/// True if `word` is one of the words parted by '|'.
bool is_one_of(std::string_view word, std::string_view choices);

}   // namespace bedload

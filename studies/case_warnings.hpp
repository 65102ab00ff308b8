// Warnings of many cases, said once each.
#pragma once

#include <string>
#include <vector>

namespace bedload {

/// What a case must be told (warnings_of its scene).
struct CaseWarning {
  std::string label;   // of the case
  std::string text;
};

/// One warning and every case that it holds for.
struct SharedWarning {
  std::string text;                  // with the numbers of the first case
  std::vector<std::string> labels;   // in the order given
  bool same_numbers = true;          // false: the text of some other case differs, by its numbers alone
};

/// Texts that differ by their numbers alone are one warning; in order of first appearance.
std::vector<SharedWarning> shared_warnings(const std::vector<CaseWarning>&);

/// "d0.5mm-s1", "d0.5mm-s1 and 2 more", "d0.5mm-s1 and 2 more with their own numbers".
std::string cases_in_words(const SharedWarning&);

}   // namespace bedload

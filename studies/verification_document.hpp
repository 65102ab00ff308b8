// docs/verification.md and its figures: the ladder as it was last climbed.
#pragma once

#include <string>
#include <vector>

#include "studies/validation.hpp"

namespace bedload {

/// "+0.12 %" or "-0.003": how far a row is off, as its band counts.
std::string shown_deviation(const ValidationRow&);
/// "1 %", "0.01", "at most +3 %"; "none" of a note.
std::string shown_band(const ValidationRow&);

/// "code", "experiment" or "nothing".
std::string_view shown_against(const ValidationRow&);
/// "pass", "NO" or "note".
std::string_view shown_verdict(const ValidationRow&);

/// A file of the document, its path relative to the document's folder.
struct DocumentFile {
  std::string path, text;
};

/// verification.md, first, and verification/<figure>.svg; `command` is what was run, and makes them again. Apart from computing times the same ladder gives the same bytes.
std::vector<DocumentFile> verification_document(const std::vector<RungResult>&, const std::string& command);

}   // namespace bedload

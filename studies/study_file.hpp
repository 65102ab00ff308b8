// Reads a study file: TOML with units, every problem reported with its place.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "studies/study.hpp"

namespace bedload {

/// Reads and checks a study file. Syntax errors are reported alone, all others together (Error study_invalid, one line
/// "file:line:column: error: ..." each); a missing file is not_found.
Study read_study(const std::filesystem::path&);

/// A case.toml: a study without axes, in which `bed_only` and `case` may stand.
struct CaseFile {
  Settings settings;
  RunOptions run;
  bool bed_only = false;
};
CaseFile read_case_file(const std::filesystem::path&);

/// The same from text; `name` stands in messages.
Study parse_study(const std::string& text, const std::string& name);
CaseFile parse_case_file(const std::string& text, const std::string& name);

/// True for what can be the name of a study, hence of its result directory.
bool is_study_name(std::string_view);

}   // namespace bedload

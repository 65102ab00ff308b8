// case.toml: one case, resolved, as a study file without axes that the same reader reads back.
#pragma once

#include <filesystem>
#include <string>

#include "studies/study.hpp"

namespace bedload {

/// The file's text: every input in SI with its unit, how it is run, the models with their reasons as comments.
std::string case_file_text(const CaseInputs&, const std::string& id, const std::string& label, const RunOptions&);

/// A case directory as its worker sees it.
struct CaseDirectory {
  std::string label;
  CaseInputs inputs;
  Scene scene;
  RunOptions run;
};

/// Makes or updates case.toml and inputs/ of a case. Files that hold the same bytes already are left alone.
void write_case_directory(const std::filesystem::path& directory, const CaseInputs&, const std::string& label,
                          const RunOptions&);

/// Reads case.toml and what it names, and validates the scene. Errors: not_found, study_invalid.
CaseDirectory read_case_directory(const std::filesystem::path& directory);

}   // namespace bedload

// Where a study's results stand, and how its cases are found in them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scheduler/ledger.hpp"
#include "studies/study.hpp"

namespace bedload {

/// A study named on the command line: its file, or its result directory, which keeps a copy of the file.
struct StudyPlace {
  std::filesystem::path file;        // study file
  std::filesystem::path directory;   // of the results; may not exist yet
  std::string name;                  // as the user named it
};

/// Finds the study; Error not_found if there is none, study_invalid if its file cannot be read.
StudyPlace find_study(const std::filesystem::path& named, const std::optional<std::filesystem::path>& out = {});

std::filesystem::path case_directory(const std::filesystem::path& results, const std::string& case_id);
std::filesystem::path bed_directory(const std::filesystem::path& results, const std::string& bed_id);
std::filesystem::path database_file(const std::filesystem::path& results);

/// The study's database for reading. Error not_found if it has not been run.
Database open_results(const StudyPlace&);

/// Cases (no beds) that a word names: id prefix, label, or glob of labels ("d0.5mm-*"). Error not_found, with the nearest
/// labels in the hint, if it names none.
std::vector<CaseEntry> matching_cases(const std::vector<CaseEntry>&, const std::string& word);

/// What a command line may name: the first labels, and how several are named at once.
std::string naming_of_cases(const std::vector<CaseEntry>&);

/// by-label/<label> -> ../cases/<id>, for every case; others are removed.
void link_labels(const std::filesystem::path& results, const std::vector<Case>&);

}   // namespace bedload

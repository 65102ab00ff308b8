// The ledger: tables of cases and attempts, and the views over them. It records; the case directories are the truth.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scheduler/attempt.hpp"
#include "scheduler/database.hpp"

namespace bedload {

/// Spare: a further seed, which waits until the others are known not to be enough.
enum class CaseState { pending, running, done, failed, stopped, spare };
std::string_view word(CaseState);

/// One row of `cases`.
struct CaseEntry {
  std::string id;                    // digest of its physics
  std::string label;                 // unique within the study
  bool is_bed = false;               // it prepares a bed for cases; column kind: 'bed' or 'case'
  std::filesystem::path directory;   // relative to the study's, so that a study can be moved
  std::string bed;                   // id of the bed it starts on; empty = none
  std::string parameters;            // all of them, JSON
  std::vector<std::pair<std::string, Value>>
      columns;   // the main ones, each a column named with its unit: {"diameter_m", 5e-4}

  // kept by the ledger
  CaseState state = CaseState::pending;
  std::string message;    // why it failed or stopped
  bool in_study = true;   // false: dropped from the study file, results kept
};

/// The ledger's rows in order of enrolment, from any database that is open; `columns` is left empty.
/// None if the tables are not there yet.
std::vector<CaseEntry> read_cases(const Database&);

/// The only writer of `cases` and `attempts`.
class Ledger {
 public:
  /// Makes the tables and views that are missing.
  Ledger(Database&, std::filesystem::path study_directory);

  /// In one transaction: rows that are new are added as pending, rows that are known are updated and keep their state,
  /// and rows that are not in the list leave the study.
  void enrol(const std::vector<CaseEntry>&);

  /// Those in the study, in order of enrolment.
  std::vector<CaseEntry> cases() const;
  void set_state(const std::string& id, CaseState, const std::string& message = {});
  void record_attempts(const std::string& id, const std::vector<Attempt>&);

  std::filesystem::path directory_of(const CaseEntry& entry) const { return study_ / entry.directory; }
  Database& database() { return *database_; }

 private:
  void add_columns(const std::vector<CaseEntry>&);

  Database* database_;
  std::filesystem::path study_;
};

}   // namespace bedload

// The commands of bedload: options as structs, each command a function that returns the exit code.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "studies/study_directory.hpp"

namespace bedload {

enum class Form { table, csv, json, svg };   // how results are printed; svg: the curve alone

struct StudyOptions {
  std::string study;                // study file or result directory
  std::optional<std::string> out;   // result directory instead of the one beside the file
  Form form = Form::table;
  std::vector<std::string> cases;   // id prefixes, labels, globs
};

struct RunOptionsOfCommand {
  StudyOptions study;
  std::optional<int> cores;
  bool prepare = false, rescan = false, recompute = false, replace = false, quiet = false;
};

int new_command(const std::string& name);
int plan_command(const StudyOptions&);
int explain_command(const StudyOptions&);
int run_command(const RunOptionsOfCommand&);
/// Runs what is left of a study with [[trade]], at most so many core-hours of it, and prints what it measured.
int trade_command(RunOptionsOfCommand, std::optional<double> core_hours);
int case_command(const std::string& directory, const std::optional<std::string>& until);
int stop_command(const StudyOptions&);
int retry_command(const StudyOptions&);
int status_command(const StudyOptions&, bool watch);
int curve_command(const StudyOptions&);
int query_command(const StudyOptions&, const std::string& sql);
int report_command(const StudyOptions&);
/// `named`: CASE or CASE@STEP.
int view_command(const StudyOptions&, const std::string& named);

struct ValidateOptions {
  std::vector<std::string> groups;   // none = all but extremes
  bool quick = false, list = false;
  std::optional<int> cores;
  std::optional<std::string> write;   // folder for verification.md and its figures
  Form form = Form::table;
};
int validate_command(const ValidateOptions&);

int inspect_command(const std::string& checkpoint, bool digest, bool verify, Form);

/// report.html of a study, published; its path.
std::filesystem::path write_report(const StudyPlace&);

}   // namespace bedload

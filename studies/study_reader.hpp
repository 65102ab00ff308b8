// A study file's tree as settings, axes and exclusions: walks its tables, knows its keys.
#pragma once

#include <vector>

#include "studies/study.hpp"
#include "studies/study_node.hpp"

namespace bedload {

enum class StudyFileKind { study, case_file };   // a case file has no axes, and may say bed_only

struct StudyContents {
  Settings settings;
  std::vector<Axis> axes;   // in order of study_keys()
  std::vector<Settings> exclusions;
  std::vector<Variation> trades;
  bool bed_only = false;
};

/// What is wrong is reported, and left out.
StudyContents read_contents(const StudyNode& root, StudyFileKind, Problems&);

/// onset.interval and onset.batch, which ask for an axis of seeds.
SeedRule seed_rule(const StudyContents&, Problems&);

/// onset.budget; "auto" is all pairs.
std::vector<std::string> budget_wanted(const Settings&);

/// [run]: how, not what.
RunOptions run_options(const Settings&, Problems&);

}   // namespace bedload

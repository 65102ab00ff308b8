// A scene in words: its dimensionless numbers, its models and their reasons.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "scheduler/database.hpp"
#include "studies/case_file.hpp"
#include "studies/study_directory.hpp"

namespace bedload {

/// The numbers that decide, each with its meaning: name, value, unit.
Rows scene_numbers(const Scene&);

/// term, on, wanted, ratio, reason.
Rows scene_models(const Scene&);

/// Why a case stands where it stands: what is on disk, what its attempts did, what the next run will do with it.
std::vector<std::string> story_of(const CaseEntry&, const std::filesystem::path& directory);

}   // namespace bedload

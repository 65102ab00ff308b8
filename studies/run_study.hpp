// `bedload run`: from a study file to a result database, however often it is interrupted.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scheduler/progress.hpp"
#include "studies/study_directory.hpp"

namespace bedload {

struct RunStudyRequest {
  StudyPlace place;
  std::optional<int> cores;        // instead of the study file's
  std::vector<std::string> only;   // cases by id prefix, label or glob; empty = all
  bool prepare = false;            // make the case directories and stop
  bool rescan = false;             // rebuild the database from the directories first
  bool recompute = false;          // go on although results of another physics_version will be left behind
  bool replace = false;            // go on although every case of the database leaves the study
  ProgressSink* sink = nullptr;
};

/// Returns the exit code: 0 all done, 1 some failed, 75 stopped with work left, 130 killed by a second Ctrl-C.
/// Nothing is written before the study has been read, resolved and validated, and its lock taken.
int run_study(const RunStudyRequest&);

}   // namespace bedload

// Where this program comes from: for `--version` and for the provenance of every result.
#pragma once

#include <string_view>

namespace bedload {

struct BuildInfo {
  std::string_view version;      // of the release, "0.1.0"
  std::string_view commit;       // git, with "-dirty" for changed sources; "unknown" outside a repository
  std::string_view build_type;   // Release, Debug
  std::string_view compiler;     // name and version
  std::string_view flags;        // those that could matter to results
  std::string_view libraries;    // names and versions
};

BuildInfo build_info();

}   // namespace bedload

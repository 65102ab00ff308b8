#include "studies/study_directory.hpp"

#include <fnmatch.h>

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "base/error.hpp"
#include "studies/case_identity.hpp"
#include "studies/study_file.hpp"

namespace bedload {

namespace fs = std::filesystem;

StudyPlace find_study(const fs::path& named, const std::optional<fs::path>& out) {
  const bool results = fs::is_directory(named);
  const auto file = results ? named / "study.toml" : named;
  if (!fs::exists(file)) {
    throw Error(ErrorKind::not_found,
                results ? fmt::format("{} is not a study: it has no study.toml", named.string())
                        : fmt::format("there is no study file {}", named.string()),
                "`bedload new NAME` makes one to start from");
  }
  if (results) return {file, out.value_or(named), named.string()};
  return {file, result_directory(read_study(file), out), named.string()};
}

fs::path case_directory(const fs::path& results, const std::string& id) { return results / "cases" / short_id(id); }
fs::path bed_directory(const fs::path& results, const std::string& id) { return results / "beds" / short_id(id); }
fs::path database_file(const fs::path& results) { return results / "study.db"; }

Database open_results(const StudyPlace& place) {
  if (!fs::exists(database_file(place.directory)))
    throw Error(ErrorKind::not_found,
                fmt::format("{} has no results: there is no {}", place.name, database_file(place.directory).string()),
                fmt::format("bedload run {}", place.name));
  return Database(database_file(place.directory), Database::Mode::query);
}

std::vector<CaseEntry> matching_cases(const std::vector<CaseEntry>& entries, const std::string& word) {
  std::vector<CaseEntry> found;
  for (const auto& entry : entries) {
    const bool by_id = word.size() >= 4 && entry.id.starts_with(word);
    if (!entry.is_bed && (by_id || fnmatch(word.c_str(), entry.label.c_str(), 0) == 0)) found.push_back(entry);
  }
  if (found.empty())
    throw Error(ErrorKind::not_found, fmt::format("no case is named {}", word), naming_of_cases(entries));
  return found;
}

std::string naming_of_cases(const std::vector<CaseEntry>& entries) {
  std::string some;
  for (const auto& entry : entries) {
    if (entry.is_bed) continue;
    if (some.size() >= 80) {
      some += ", ... (`bedload plan` lists all)";
      break;
    }
    some += fmt::format("{}{}", some.empty() ? "" : ", ", entry.label);
  }
  return fmt::format("cases are {}; a glob such as \"d0.5mm-*\" or an id prefix works too", some);
}

void link_labels(const fs::path& results, const std::vector<Case>& cases) {
  const auto links = results / "by-label";
  fs::create_directories(links);
  std::set<std::string> labels;
  for (const auto& one : cases) {
    labels.insert(one.label);
    const auto target = fs::path("..") / "cases" / short_id(one.id);
    const auto link = links / one.label;
    if (fs::is_symlink(link) && fs::read_symlink(link) == target) continue;
    fs::remove(link);
    fs::create_symlink(target, link);
  }
  for (const auto& entry : fs::directory_iterator(links))
    if (entry.is_symlink() && !labels.contains(entry.path().filename().string())) fs::remove(entry.path());
}

}   // namespace bedload

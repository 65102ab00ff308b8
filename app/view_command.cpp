// `bedload view`: checkpoints of a case as files for ParaView.
#include <algorithm>
#include <charconv>
#include <filesystem>

#include <fmt/format.h>

#include "app/commands.hpp"
#include "base/durable_file.hpp"
#include "base/error.hpp"
#include "checkpoint/checkpoint.hpp"
#include "checkpoint/checkpoint_series.hpp"
#include "studies/case_file.hpp"
#include "studies/study_directory.hpp"
#include "studies/vtk_files.hpp"

namespace bedload {

namespace fs = std::filesystem;

namespace {

struct Named {
  std::string word;                    // names the case
  std::optional<std::uint64_t> step;   // all, if none is given
};

Named parse(const std::string& named) {
  const auto at = named.rfind('@');
  if (at == std::string::npos) return {named, {}};
  std::uint64_t step = 0;
  const char *first = named.data() + at + 1, *last = named.data() + named.size();
  const auto [end, error] = std::from_chars(first, last, step);
  if (error != std::errc() || end != last)
    throw Error(ErrorKind::usage,
                fmt::format("\"{}\" is no step: CASE@STEP wants a whole number", named.substr(at + 1)));
  return {named.substr(0, at), step};
}

CaseEntry only_case(const StudyPlace& place, const std::string& word) {
  const auto found = matching_cases(read_cases(open_results(place)), word);
  if (found.size() > 1)
    throw Error(ErrorKind::usage, fmt::format("{} names {} cases; `bedload view` takes one", word, found.size()),
                naming_of_cases(found));
  return found[0];
}

/// Those asked for. Error not_found if there is none.
std::vector<std::uint64_t> steps_to_view(const fs::path& directory, const CaseEntry& entry, const Named& named) {
  const auto steps = checkpoint_steps(directory);
  if (steps.empty())
    throw Error(ErrorKind::not_found, fmt::format("{} has no checkpoint in {}", entry.label, directory.string()),
                "`bedload run` writes them every `checkpoint.every`");
  if (!named.step) return steps;
  if (std::find(steps.begin(), steps.end(), *named.step) == steps.end())
    throw Error(ErrorKind::not_found, fmt::format("{} has no checkpoint of step {}", entry.label, *named.step),
                fmt::format("it has those of steps {}", fmt::join(steps, ", ")));
  return {*named.step};
}

}   // namespace

int view_command(const StudyOptions& options, const std::string& text) {
  const auto named = parse(text);
  const auto place = find_study(options.study, options.out);
  const auto entry = only_case(place, named.word);
  const fs::path directory = place.directory / entry.directory, view = directory / "view";
  const auto steps = steps_to_view(directory, entry, named);
  const Scene scene = read_case_directory(directory).scene;
  std::vector<ViewedStep> viewed;
  make_writable_directory(view);
  for (const auto step : steps) {
    const State state = read_checkpoint(directory / fmt::format("ck-{}.h5", step));
    publish(view / fluid_file(step), fluid_for_vtk(scene, state));
    publish(view / grains_file(step), grains_for_vtk(state));
    viewed.push_back({step, state.clock.time, state.grains.size()});
  }
  publish(view / "case.xdmf", xdmf_index(scene, viewed));
  fmt::print("paraview '{}'\n", (view / "case.xdmf").string());
  return 0;
}

}   // namespace bedload

// `bedload view`: checkpoints of a case, and the beds that it keeps, as files for ParaView.
#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "app/commands.hpp"
#include "base/counted.hpp"
#include "base/durable_file.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "checkpoint/checkpoint.hpp"
#include "checkpoint/checkpoint_series.hpp"
#include "solver/initial_flow.hpp"
#include "studies/case_file.hpp"
#include "studies/study_directory.hpp"
#include "studies/vtk_files.hpp"

namespace bedload {

namespace fs = std::filesystem;

namespace {

struct Named {
  std::string word;                    // names the case
  std::optional<std::string> moment;   // all, if none is given
};

constexpr std::string_view kept[] = {"bed", "sheared", "onset"};   // <name>.h5, beside the checkpoints

bool is_moment(std::string_view word) {
  const bool is_step = !word.empty() && word.find_first_not_of("0123456789") == word.npos;
  return is_step || std::ranges::find(kept, word) != std::end(kept);
}

Named parse(const std::string& named) {
  const auto at = named.rfind('@');
  if (at == std::string::npos) return {named, {}};
  const auto moment = named.substr(at + 1);
  if (!is_moment(moment))
    throw Error(ErrorKind::usage,
                fmt::format("\"{}\" is no step: CASE@STEP wants a whole number, or {}", moment, fmt::join(kept, ", ")));
  return {named.substr(0, at), moment};
}

CaseEntry only_case(const StudyPlace& place, const std::string& word) {
  const auto found = matching_cases(read_cases(open_results(place)), word);
  if (found.size() > 1)
    throw Error(ErrorKind::usage, fmt::format("{} names {} cases; `bedload view` takes one", word, found.size()),
                naming_of_cases(found));
  return found[0];
}

/// A state of a case on disk.
struct Moment {
  std::string name;   // a step, or what `kept` names
  fs::path file;
};

std::vector<Moment> moments_in(const fs::path& directory) {
  std::vector<Moment> moments;
  for (const auto name : kept)
    if (const auto file = directory / fmt::format("{}.h5", name); fs::exists(file))
      moments.push_back({std::string(name), file});
  for (const auto step : checkpoint_steps(directory))
    moments.push_back({fmt::format("{}", step), directory / fmt::format("ck-{}.h5", step)});
  return moments;
}

/// Those asked for. Error not_found if there is none.
std::vector<Moment> moments_to_view(const fs::path& directory, const CaseEntry& entry, const Named& named) {
  const auto moments = moments_in(directory);
  if (moments.empty())
    throw Error(ErrorKind::not_found, fmt::format("{} has no checkpoint in {}", entry.label, directory.string()),
                "`bedload run` writes them every `checkpoint.every`");
  if (!named.moment) return moments;
  const auto found = std::ranges::find(moments, *named.moment, &Moment::name);
  if (found != moments.end()) return {*found};
  std::vector<std::string> names;
  for (const Moment& moment : moments) names.push_back(moment.name);
  throw Error(ErrorKind::not_found, fmt::format("{} has no checkpoint of step {}", entry.label, *named.moment),
              fmt::format("it has those of steps {}", fmt::join(names, ", ")));
}

/// Cases share a settled bed, and its clock and flow are those of its pouring: here it lies under the case's own fluid at rest.
State state_at(const Moment& moment, const Scene& scene) {
  State state = read_checkpoint(moment.file);
  if (moment.name != "bed") return state;
  state.fluid = initial_flow(scene);
  state.search = {};
  state.clock.time = -scene.shear.time;
  return state;
}

}   // namespace

int view_command(const StudyOptions& options, const std::string& text) {
  const auto named = parse(text);
  const auto place = find_study(options.study, options.out);
  const auto entry = only_case(place, named.word);
  const fs::path directory = place.directory / entry.directory, view = directory / "view";
  const auto moments = moments_to_view(directory, entry, named);
  const Scene scene = read_case_directory(directory).scene;
  std::vector<ViewedMoment> viewed;
  make_writable_directory(view);
  for (const Moment& moment : moments) try {
      const State state = state_at(moment, scene);
      publish(view / fluid_file(moment.name), fluid_for_vtk(scene, state));
      publish(view / grains_file(moment.name), grains_for_vtk(state));
      viewed.push_back({moment.name, state.clock.time, state.grains.size()});
    } catch (const Error& error) {
      const bool by_itself =
          error.kind == ErrorKind::corrupt || error.kind == ErrorKind::not_found;   // a worker removes old ones
      if (!by_itself || moments.size() == 1) throw;
      log_warning(fmt::format("left out: {}", error.what()));
    }
  if (viewed.empty()) throw Error(ErrorKind::corrupt, fmt::format("{}: none of its checkpoints is whole", entry.label));
  std::ranges::stable_sort(viewed, {}, &ViewedMoment::time);
  publish(view / "case.xdmf", xdmf_index(scene, viewed));
  fmt::print("paraview '{}'\n", (view / "case.xdmf").string());
  if (viewed.size() == moments.size()) return 0;
  log_warning(fmt::format("{} of {} viewed", viewed.size(), counted(moments.size(), "checkpoint")));
  return static_cast<int>(ErrorKind::some_failed);
}

}   // namespace bedload

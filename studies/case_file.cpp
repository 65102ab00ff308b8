#include "studies/case_file.hpp"

#include <fmt/format.h>

#include "base/durable_file.hpp"
#include "base/error.hpp"
#include "solver/required_models.hpp"
#include "solver/state.hpp"
#include "studies/case_identity.hpp"
#include "studies/study_file.hpp"
#include "studies/study_keys.hpp"

namespace bedload {

namespace fs = std::filesystem;

namespace {

constexpr const char* table_name = "inputs/bed.csv";

/// The SI unit of a quantity, as parse_quantity reads it.
std::string_view unit_of(const Dimension& d) {
  constexpr std::pair<Dimension, std::string_view> units[] = {{dimension::length, "m"},
                                                              {dimension::time, "s"},
                                                              {dimension::angle, "rad"},
                                                              {dimension::speed, "m/s"},
                                                              {dimension::acceleration, "m/s2"},
                                                              {dimension::density, "kg/m3"},
                                                              {dimension::viscosity, "m2/s"},
                                                              {dimension::pressure, "Pa"},
                                                              {dimension::pressure_gradient, "Pa/m"}};
  for (const auto& [dimension, unit] : units)
    if (dimension == d) return unit;
  throw Error(ErrorKind::internal, "a key of study files has a dimension without a unit");
}

std::string toml_value(const StudyKey& key, const Input& input) {
  if (const auto* number = std::get_if<double>(&input)) {
    if (key.kind == StudyKey::Kind::quantity)
      return fmt::format("\"{} {}\"", shortest(*number), unit_of(key.dimension));
    if (key.kind == StudyKey::Kind::count) return fmt::format("{:.0f}", *number);
    const auto text = shortest(*number);
    return text.find_first_of(".e") == text.npos ? text + ".0" : text;
  }
  if (key.kind == StudyKey::Kind::flag) return std::get<std::string>(input);
  if (const auto* word = std::get_if<std::string>(&input)) return fmt::format("\"{}\"", *word);
  if (const auto* words = std::get_if<std::vector<std::string>>(&input))
    return words->empty() ? "[]" : fmt::format("[\"{}\"]", fmt::join(*words, "\", \""));
  return fmt::format("[{}]", fmt::join(std::get<std::vector<std::uint64_t>>(input), ", "));
}

std::string models_as_comments(const Scene& scene) {
  std::string text = "\n# Models, and why:\n";
  for (const auto& model : decisions_of(scene))
    text += fmt::format("#   {:<18} {:<4} {}\n", model.term, model.on ? "on" : "off", model.reason);
  for (const auto& warning : warnings_of(scene)) text += fmt::format("# warning: {}\n", warning);
  return text;
}

std::string run_table(const RunOptions& run) {
  return fmt::format("\n[run]\ncheckpoint.every = \"{} s\"\ncheckpoint.keep = {}\nstall_limit = \"{} s\"\n",
                     shortest(run.checkpoint_every), run.checkpoint_keep, shortest(run.stall_limit));
}

void publish_if_new(const fs::path& file, const std::string& text) {
  if (fs::exists(file) && read_text(file) == text) return;
  publish(file, text);
}

}   // namespace

std::string case_file_text(const CaseInputs& inputs, const std::string& id, const std::string& label,
                           const RunOptions& run) {
  std::string text =
      fmt::format("# Written by bedload: {} {}, resolved to SI. physics_version {}\nformat = 1\nname = \"{}\"\n",
                  inputs.bed_only ? "bed" : "case", id, physics_version, label);
  if (inputs.bed_only) text += "bed_only = true\n";
  std::string_view table;
  for (const auto& key : study_keys()) {
    const auto found = inputs.values.find(key.path);
    if (found == inputs.values.end()) continue;
    const auto dot = key.path.find('.');
    if (const auto its_table = key.path.substr(0, dot); its_table != table)
      text += fmt::format("\n[{}]\n", table = its_table);
    const Input input = key.path == "bed.file" ? Input(std::string(table_name)) : found->second;
    text += fmt::format("{} = {}\n", key.path.substr(dot + 1), toml_value(key, input));
  }
  text += run_table(run);
  return inputs.bed_only ? text : text + models_as_comments(scene_of(inputs));
}

void write_case_directory(const fs::path& directory, const CaseInputs& inputs, const std::string& label,
                          const RunOptions& run) {
  make_writable_directory(directory);
  if (inputs.has("bed.file")) {
    make_writable_directory(directory / "inputs");
    publish_if_new(directory / table_name, inputs.csv);
  }
  publish_if_new(directory / "case.toml", case_file_text(inputs, case_id(inputs), label, run));
}

CaseDirectory read_case_directory(const fs::path& directory) {
  const auto file = directory / "case.toml";
  const auto read = read_case_file(file);
  Problems problems(file.string());
  auto inputs = resolve(read.settings, directory, problems);
  problems.throw_if_any();
  inputs.bed_only = read.bed_only;
  const auto scene = scene_of(inputs);
  validate(scene);
  const auto name = read.settings.find("name");
  return {name == read.settings.end() ? short_id(case_id(inputs)) : name->second.text, std::move(inputs), scene,
          read.run};
}

}   // namespace bedload

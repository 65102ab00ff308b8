#include "studies/case_identity.hpp"

#include <fmt/format.h>

#include "base/digest.hpp"
#include "solver/grains/bed_packing.hpp"
#include "solver/state.hpp"

namespace bedload {

namespace {

std::string written(double value) { return shortest(value); }
std::string written(const std::string& value) { return value; }
std::string written(const std::vector<std::string>& values) { return fmt::format("{}", fmt::join(values, ",")); }
std::string written(const std::vector<std::uint64_t>& values) { return fmt::format("{}", fmt::join(values, ",")); }

/// A ramp's end and what counts as onset may change without changing a bit of the run so far; the way of a search hangs on
/// them.
bool is_identity(std::string_view key, bool searched) {
  return searched || (key != "onset.criterion" && key != "onset.value" && !key.ends_with(".steps"));
}

using Lines = std::map<std::string, std::string, std::less<>>;   // sorted

Lines lines_of(const CaseInputs& inputs) {
  Lines lines;
  const bool searched = inputs.word("onset.method") == "bisect";
  for (const auto& [key, value] : inputs.values)
    if (is_identity(key, searched)) lines[key] = std::visit([](const auto& v) { return written(v); }, value);
  // The grid is what the cell sizes asked for come to.
  const auto cells = scene_of(inputs).grid.cells;
  lines.erase("box.cell.xy"), lines.erase("box.cell.z");
  lines["box.cells"] = fmt::format("{} {} {}", cells[0], cells[1], cells[2]);
  if (inputs.has("bed.file")) lines["bed.file"] = Digest().add(bytes_of(inputs.csv)).hex();
  lines["physics_version"] = fmt::format("{}", physics_version);
  return lines;
}

std::string joined(const Lines& lines) {
  std::string text;
  for (const auto& [key, value] : lines) text += fmt::format("{} = {}\n", key, value);
  return text;
}

std::string digest_of(const std::string& text) { return Digest().add(bytes_of(text)).hex(); }

}   // namespace

std::string canonical_inputs(const CaseInputs& inputs) {
  auto lines = lines_of(inputs);
  if (!inputs.bed_only) return joined(lines);
  // A bed knows nothing of what its cases do with it.
  std::erase_if(lines, [](const auto& line) {
    const std::string& key = line.first;
    return key == "box.cells" || key == "steps.fluid" || key.starts_with("drive.") || key.starts_with("onset.") ||
           key.starts_with("models.") || key.starts_with("record.");
  });
  return "bed\n" + joined(lines);
}

std::string case_id(const CaseInputs& inputs) { return digest_of(canonical_inputs(inputs)); }

std::string parameter_set_id(const CaseInputs& inputs) {
  auto lines = lines_of(inputs);
  lines.erase("bed.seed");
  return digest_of(joined(lines));
}

std::string bed_id(const CaseInputs& inputs) {
  return needs_settling(scene_of(inputs).bed) ? case_id(bed_inputs(inputs)) : std::string();
}

std::string short_id(const std::string& id) { return id.substr(0, 12); }

}   // namespace bedload

// The inputs of one case, resolved to SI: the list from which its scene, its file and its identity are made.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/durable_file.hpp"
#include "solver/scene.hpp"
#include "studies/setting.hpp"

namespace bedload {

using Input = std::variant<double, std::string, std::vector<std::string>, std::vector<std::uint64_t>>;

/// Nothing relative and nothing automatic is left in `values`: keys as in the study file, numbers in SI.
struct CaseInputs {
  std::map<std::string, Input, std::less<>> values;
  std::string csv;         // the bytes of bed.file
  bool bed_only = false;   // a bed directory: finished once its bed has settled

  bool has(std::string_view key) const { return values.find(key) != values.end(); }
  double number(std::string_view key) const;
  const std::string& word(std::string_view key) const;
  bool operator==(const CaseInputs&) const = default;
};

/// Where the tables that a study file names are read.
using TableReader = std::function<std::string(const std::filesystem::path&)>;

/// Resolves the settings of one case: defaults filled in, grain diameters and grain times turned into SI, "auto" computed,
/// `bed.file` read (relative to `directory`). What is wrong is reported at the place of the setting that it concerns; the
/// inputs returned then are of no use.
CaseInputs resolve(const Settings&, const std::filesystem::path& directory, Problems&, const TableReader& = read_text);

DragLawName drag_law_named(std::string_view);

/// The scene of a case: a pure function of its inputs.
Scene scene_of(const CaseInputs&);

/// The kind of level that a staircase counts: "drive.shields", "drive.speed", "drive.gradient"; empty without a drive.
std::string_view staircase_of(const CaseInputs&);

/// The bed that a case starts on, as a case of its own: everything that the grains do not feel while they settle is left
/// at its default.
CaseInputs bed_inputs(const CaseInputs&);

}   // namespace bedload

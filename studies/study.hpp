// A study: what was asked for, its axes, and the cases they span.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "solver/scene.hpp"
#include "studies/case_inputs.hpp"
#include "studies/setting.hpp"
#include "studies/spare_seeds.hpp"
#include "studies/variation.hpp"

namespace bedload {

/// One key that varies.
struct Axis {
  std::string key;
  std::vector<Setting> values;
};

/// How a study is run; no part of what it is.
struct RunOptions {
  int cores = 0;                   // 0 = all
  double checkpoint_every = 300;   // wall time [s]
  int checkpoint_keep = 2;
  double stall_limit = 600;   // wall time [s]
};

/// A study file, read and checked value by value.
struct Study {
  std::string name;
  std::filesystem::path file;
  std::string text;                   // the file's bytes
  Settings settings;                  // of the keys that do not vary
  std::vector<Axis> axes;             // in order of study_keys()
  std::vector<Settings> exclusions;   // combinations left out
  RunOptions run;
  SeedRule seeds;
  std::vector<std::string> budget;   // pairs of the error budget, for one packing
  std::vector<Variation> trades;     // settings to be measured against those of the study, for every packing
};

/// One point of a study.
struct Case {
  std::string id;      // 64 hex digits; directories carry the first 12
  std::string label;   // "d0.5mm-rho2000-s1"
  std::string set;     // digest without the seed, and the label without it
  std::string set_label;
  std::uint64_t seed = 1;
  std::string variation;   // the name of what it changes of case `base_id`; empty in a case of the axes, as are
  Settings changes;        // the settings changed
  std::string base_id;
  std::string bed_id;   // of the bed it starts on; empty when its grains are not settled first
  CaseInputs inputs;
  Scene scene;
  double pace = 1;   // core seconds measured per core second predicted, where a trade says so
};

/// The cases of a study: product of its axes without the exclusions, the pairs of its error budget and its trades, each resolved, validated and named. Reports all
/// problems of all cases at once (Error study_invalid).
std::vector<Case> unfold(const Study&, const TableReader& = read_text);

/// True if some case has a ramp, which alone gives a threshold.
bool seeks_onset(const Study&);

/// The directory that holds a study's results: named after the study, beside its file; or `out`.
std::filesystem::path result_directory(const Study&, const std::optional<std::filesystem::path>& out);

}   // namespace bedload

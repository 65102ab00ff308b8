// What `bedload validate` prints: for people a table per study, for programs one record per row.
#pragma once

#include <string>
#include <vector>

#include "app/commands.hpp"
#include "studies/extremes.hpp"
#include "studies/validation.hpp"

namespace bedload {

/// A ladder that was climbed, or a part of it.
struct Climbed {
  std::vector<RungResult> rungs;   // those that are done
  std::size_t studies = 0;         // that were to be climbed
  bool quick = false;
  double wall = 0;   // [s]

  bool stopped() const { return rungs.size() < studies; }
  bool passed() const;
};

/// A table for each study, the sources of its references below it.
std::string ladder_for_people(const std::vector<RungResult>&);
/// "180 of 182 rows in band; ...", or after how many studies it was stopped.
std::string ladder_summary(const Climbed&);
/// JSON: what was run, then rungs with a record for each row. CSV: these records. Numbers in both; a bound that is open and
/// a number that is none are null, or an empty field.
std::string ladder_as_json(const Climbed&);
std::string ladder_as_csv(const std::vector<RungResult>&);

/// A table for each of the base studies, then what was said of scenes that were refused or failed.
std::string extremes_for_people(const std::vector<ExtremeRow>&);

}   // namespace bedload

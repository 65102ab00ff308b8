// The report: one self-contained HTML page, plots as inline SVG, nothing fetched.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scheduler/database.hpp"
#include "solver/grains/grains.hpp"
#include "studies/trade.hpp"

namespace bedload {

/// A bed as it stands at one moment of a case.
struct BedView {
  std::string moment;   // what is shown, e.g. "after hold 9, theta = 0.17"
  Grains grains;
  Vec3 length;              // box [m]
  double diameter = 0;      // mean [m]
  double speed_scale = 0;   // sqrt((s-1) g d) [m/s]
};

struct CaseViews {
  std::string label;   // of the case
  std::vector<BedView> views;
};

struct ReportRequest {
  std::string study;             // name
  std::string command;           // that reproduces the figures
  std::string written;           // date and time, as text; empty = not said
  std::vector<CaseViews> beds;   // the pictures of a case stand side by side
  std::optional<Trade> trade;    // of a study with [[trade]]
};

/// The whole page. Reads the result tables (which may be empty) and, where they exist, the tables of the ledger.
std::string report_html(const Database&, const ReportRequest&);

}   // namespace bedload

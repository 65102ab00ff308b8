// Speed against accuracy: what each setting of a trade changes in the results, from the same settled beds, and what it costs.
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "scheduler/database.hpp"
#include "studies/lone_fall.hpp"
#include "studies/paired_difference.hpp"
#include "studies/study.hpp"

namespace bedload {

/// Of trade.json. 2: bounds of the differences, thresholds, grain time of the scene (1 had half widths). 3: physics_version, difference of the
/// lone fall.
constexpr int trade_format = 3;

/// A setting beside the finest one.
struct TradeSetting {
  std::string name;             // "finest", or what is changed
  Settings changes;             // by key
  std::size_t packings = 0;     // with results
  std::size_t thresholds = 0;   // of them with a theta_c that is no bound
  PairedDifference theta;       // of theta_c, relative [-]
  PairedDifference flux;        // of the flux at the highest stair that both have climbed, relative [-]
  PairedDifference height;      // of the bed's surface at the end of the first stair [d]
  PairedDifference porosity;    // of the bed then [-]
  std::array<double, 4> fall_speeds = no_falls;   // of a lone grain in the setting's box, over places in a cell [m/s]
  PairedDifference fall{NAN, NAN, NAN};           // of them, relative [-]
  double core_seconds = 0;                        // of one packing, mean
  double predicted_seconds = 0;                   // what `plan` says of it without a trade, mean
  bool frontier = false;                          // none is as cheap and as good in theta
};

struct Trade {
  std::string study;
  double galileo = 0, density_ratio = 0,
         shields = 0;                    // of the scene: theta_50 of its finest setting, or the bound that there is [-]
  double diameter = 0, grain_time = 0;   // [m], [s]
  Settings finest;                       // values of all keys that are changed anywhere
  std::vector<TradeSetting> settings;    // the finest first, then in the order of the study file
};

/// Throws Error study_invalid for a study without [[trade]].
void refuse_without_trades(const Study&);

/// From the finished cases of the study's database, without lone falls. Throws Error not_found where the finest setting has no result yet, and
/// study_invalid for a study without [[trade]].
Trade measured_trade(const Database&, const Study&, const std::vector<Case>&);

/// Lets a grain fall in the box of every setting that has results.
void add_lone_falls(Trade&, const std::vector<Case>&);

/// Into table trades, in place of what is there.
void store_trade(Database&, const Trade&);

/// The table's heads, then a row per setting, cheapest first, a star before the names of the frontier. Lone falls only where there are any.
std::vector<std::vector<std::string>> trade_cells(const Trade&);
/// For people: a line per setting, cheapest first, the frontier marked.
std::string trade_as_table(const Trade&);
/// For programs, and for `accuracy` in [models] of other studies.
std::string trade_as_json(const Trade&);
/// Error of theta_c against cost, as SVG for a page; empty where nothing is known of any.
std::string trade_figure(const Trade&);

}   // namespace bedload
